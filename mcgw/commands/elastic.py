"""``mcgw elastic``: the mean of elastic surfaces."""

from pathlib import Path
from typing import Annotated

from mcgw.commands.kinds import JUST_ONE, Pixel, SceneOrMap, Unit, file_out
from mcgw.commands.outputs import JSONL
from mcgw.commands.voice import details, news


def elastic(
    source: SceneOrMap,
    *,
    pressure: Annotated[str | None, JUST_ONE] = None,
    separation: Annotated[str | None, JUST_ONE] = None,
    E_star: str | None = None,
    pixel: Pixel = None,
    unit: Unit = None,
    rel_err: float = 0.02,
    solves: int | None = None,
    seed: int = 1,
    output: Annotated[Path | None, file_out(JSONL)] = None,
) -> None:
    """Find mean area, stiffness, conductance and gap of elastic surfaces from few boundary-element solves.

    Parameters
    ----------
    source : SCENE|MAP
        a scene with m0, m2, m4 or from a fit (.toml); or a height map, for its spectrum
    pressure : P
        load per nominal area: kPa, MPa, GPa
    separation : D
        mean gap of the deformed surface: nm, um
    E_star : E
        composite modulus of a map: MPa, GPa
    rel_err : X
        relative half width of the 95 % interval, for the worst quantity
    solves : N
        instead of --rel-err: maximum number of boundary-element solves
    seed : K
        seed of the maps
    output : FILE
        write each solve as a line (.jsonl), to resume from; default: no file

    Examples
    --------
    mcgw elastic spectral.toml --pressure 1MPa --rel-err 0.05 -o solves.jsonl
    """
    from mcgw.elasticity.elastic import elastic as solved
    from mcgw.maps.heights_files import read_map

    if isinstance(source, Path):
        surface = read_map(source, pixel=None if pixel is None else (pixel, pixel), unit=unit)
    elif pixel is not None or unit is not None:
        raise ValueError(f"--{'unit' if pixel is None else 'pixel'}: is for a map, not a scene; leave it out")
    found = solved(
        surface if isinstance(source, Path) else source, pressure=pressure, separation=separation,
        E_star=E_star, rel_err=rel_err, solves=solves, seed=seed, path=output,
    )  # fmt: skip
    print(found)
    details(found.levels)
    if output:
        news(f"{output}: solves; the same command resumes from them")

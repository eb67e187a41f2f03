"""What is printed: ``mcgw show`` of a file, ``mcgw solve`` at a load, ``mcgw elastic`` surfaces."""

from pathlib import Path
from typing import Annotated

from mcgw.commands import kinds
from mcgw.commands.outputs import ALL, details, news, says, tell_cautions


def show(
    file: kinds.SceneOrResults,
    *,
    scene: Annotated[bool, kinds.AT_MOST_ONE] = False,
    digest: Annotated[bool, kinds.AT_MOST_ONE] = False,
    plan: Annotated[bool, kinds.AT_MOST_ONE] = False,
    verify: Annotated[bool, kinds.AT_MOST_ONE] = False,
    csv: kinds.Table = None,
) -> bool | None:
    """Show the contents of an ensemble file, the progress of its run, or the plan of a scene.

    file (FILE): file of an ensemble or of a sweep (HDF5); or a scene (TOML), for its plan
    scene: print the scene as TOML, ready to run again
    digest: print the digest of scene and data
    plan: FILE is a scene: print what would be drawn and how long it takes
    verify: verify every number by its checksum

    example: mcgw show demo.h5
    """
    if csv and (scene or digest or verify or plan):
        raise ValueError(f"--csv {csv}: belongs to the summary; leave out the other option")
    if not isinstance(file, Path):
        from mcgw.reports.plan import plan_text

        return print(plan_text(file))
    if plan:
        raise ValueError(
            f"{file}: --plan is of a scene (.toml); print its scene with mcgw show --scene {file}"
        )
    from mcgw.errors import StoreError
    from mcgw.reports.text import progress_of, summary, table_of
    from mcgw.store.ensembles import open_results, read_attributes, unfinished, verify as verified
    from mcgw.store.place import tidy

    tidy(file)
    if (begun := unfinished(file)) is not None and begun.axes:
        if verify or digest or csv:
            raise StoreError(f"{file}: is an unfinished sweep; finish it with mcgw sweep")
        return print(begun.text if scene else progress_of(begun), end="" if scene else "\n")
    if verify:
        problem, found = verified(file)
        print(f"{file}: {f'DAMAGED, {problem}' if problem else 'intact'} ({found})")
        return not problem
    attributes = read_attributes(file)
    if scene or digest:
        return print(attributes["scene" if scene else "digest"], end="" if scene else "\n")
    result = open_results(file)
    print(summary(result, attributes, says(ALL)))
    if csv:
        table_of(result).write(csv)
        news(f"{csv}: the table")
    tell_cautions(result)
    return None


def solve(
    scene: kinds.Cautioned,
    *,
    pressure: Annotated[list[float] | None, kinds.values("Pa"), kinds.JUST_ONE] = None,
    load: Annotated[list[float] | None, kinds.values("N"), kinds.JUST_ONE] = None,
    area: Annotated[list[float] | None, kinds.values("m^2"), kinds.JUST_ONE] = None,
    area_fraction: Annotated[list[float] | None, kinds.values("1"), kinds.JUST_ONE] = None,
    nominal_separation: Annotated[list[str] | None, kinds.values(""), kinds.JUST_ONE] = None,
    surfaces: int | None = None,
    scatter: Annotated[float | None, kinds.quantity("1")] = None,
    csv: kinds.Table = None,
) -> None:
    """Find separation, area, stiffness, contacts and conductance at given loads.

    pressure (P): load per nominal area: Pa, kPa, MPa, GPa
    load (F): mN, N, kN, MN
    area (A): real area: um^2, mm^2, cm^2
    area_fraction (A): real over nominal area: 0.01 or 1%
    nominal_separation (D): separation of the bodies with an interaction, over sigma
    surfaces (M): number of surfaces to solve; default: that of the scene
    scatter (S): also find the number of asperities for this scatter of specimens: 1%

    example: mcgw solve runs/demo.toml --pressure 100kPa 1MPa --csv solved.csv
    """
    from analytic import quantity_of
    from mcgw.ensemble.solution import solve as solved
    from mcgw.machine.process import told
    from mcgw.reports.text import solutions_table, solutions_text

    if scatter is not None and scatter >= 1:
        raise ValueError(f"--scatter {scatter:g}: give a number between 0 and 1, such as 1%")
    changes = {} if surfaces is None else {"n_surfaces": surfaces}
    with told(None, "surfaces") as tell:
        found = solved(
            scene, pressure=pressure, load=load, area=area, area_fraction=area_fraction,
            nominal_separation=nominal_separation, progress=tell, **changes,
        )  # fmt: skip
        assert isinstance(found, list)
        if says(ALL):  # it shows specimens
            found[0].loaded.draw(tell)
    print(solutions_text(scene, found, scatter, full=says(ALL)))
    h = sorted({each.theory["separation"] for each in found})  # in place of the loads
    loading = [q for q in scene.quantities if not quantity_of(q).unloading] or ["load"]
    tell_cautions(scene.replace(separations=h, unload_from=None, quantities=loading), "add -v")
    if csv:
        solutions_table(scene, found).write(csv)
        news(f"{csv}: the table")


def elastic(
    source: kinds.SceneOrMap,
    *,
    pressure: Annotated[str | None, kinds.JUST_ONE] = None,
    separation: Annotated[str | None, kinds.JUST_ONE] = None,
    E_star: str | None = None,
    pixel: kinds.Pixel = None,
    unit: kinds.Unit = None,
    rel_err: float = 0.02,
    solves: int | None = None,
    seed: int = 1,
    output: Annotated[Path | None, kinds.file_out("solves")] = None,
) -> None:
    """Find mean area, stiffness, conductance and gap of elastic surfaces from few boundary-element solves.

    source (SCENE|MAP): a scene with m0, m2, m4 or from a fit (.toml); or a height map, for its spectrum
    pressure (P): load per nominal area: kPa, MPa, GPa
    separation (D): mean gap of the deformed surface: nm, um
    E_star (E): composite modulus of a map: MPa, GPa
    rel_err (X): relative half width of the 95 % interval, for the worst quantity
    solves (N): instead of --rel-err: maximum number of boundary-element solves
    seed (K): seed of the maps
    output (FILE): write each solve as a line (.jsonl), to resume from; default: no file

    example: mcgw elastic spectral.toml --pressure 1MPa --rel-err 0.05 -o solves.jsonl
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

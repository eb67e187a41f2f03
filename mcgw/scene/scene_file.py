"""Scenes as TOML: read with all mistakes named at once, written so that they read the same."""

import math
import secrets
from collections.abc import Callable
from pathlib import Path
from typing import Any

import tomli_w

from analytic import (
    Body,
    Exponential,
    Grading,
    Homogeneous,
    PiecewiseSeries,
    Surface,
    Table,
    composite_modulus,
)
from mcgw.formats.plain_file import read_bytes, read_text
from mcgw.formats.toml_text import loads
from mcgw.formats.units import quantity
from mcgw.scene.heights_section import heights_law, heights_table
from mcgw.scene.reading import LeftOut, quantities_of, separations_of
from mcgw.scene.samplers import SAMPLERS
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError, Section
from mcgw.scene.series_section import read_series, series_table
from mcgw.scene.storable import storable
from mcgw.scene.surface import SURFACE_UNITS

__all__ = ["files_of", "load_scene", "read_grading", "scene_from", "scene_text"]

_MOST_BYTES = 2**21
_MOST_TABLE = 2**24  # bytes of a grading as CSV


def load_scene(path: str | Path, *, seed: Callable[[], int | None] | None = None) -> Scene:
    """Read a scene.

    Parameters
    ----------
    path : str or Path
        A TOML file; `runs/demo.toml` shows its keys.
    seed : callable, optional
        Asked for a seed if the scene gives none; where it has none either, one is drawn.

    Returns
    -------
    Scene
        Checked, with a seed drawn where none is given.

    Raises
    ------
    SceneError
        With one line for each mistake: the key, the value, and what would do.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with open(f"{folder}/demo.toml", "w") as file:
    ...         _ = file.write(mcgw.scene_text(scene))
    ...     mcgw.load_scene(f"{folder}/demo.toml") == scene
    True
    """
    path = Path(path)
    try:
        text = read_bytes(path, _MOST_BYTES)
    except ValueError as error:
        raise SceneError([str(error)]) from None
    return scene_from(text, folder=path.parent, seed=seed)


def files_of(path: str | Path) -> list[Path]:
    """File of a scene, and the files that it names.

    Parameters
    ----------
    path : str or Path
        A scene that `load_scene` has read.

    Returns
    -------
    list of Path
        Itself first, then every ``file`` of its sections.
    """
    path = Path(path)
    sections = loads(read_bytes(path, _MOST_BYTES).decode()).values()
    named = [section["file"] for section in sections if isinstance(section, dict) and "file" in section]
    return [path, *(path.parent / name for name in named)]


def scene_from(
    text: str | bytes, *, folder: Path | None = None, seed: Callable[[], int | None] | None = None
) -> Scene:
    """Make a scene of its TOML text.

    Parameters
    ----------
    text : str or bytes
        The text, UTF-8.
    folder : Path, optional
        Where the files lie that it names; default: the current one.
    seed : callable, optional
        As for `load_scene`.

    Returns
    -------
    Scene
        As from `load_scene`.

    Raises
    ------
    SceneError
        With one line for each mistake.

    Examples
    --------
    >>> import mcgw
    >>> scene = mcgw.scene_from('''
    ... [surface]
    ... sigma = "1.37 um"
    ... radius = "13 um"
    ... eta = 3.0e8
    ... nominal_area = "1 cm^2"
    ... E_star = "78.6 GPa"
    ... [contact]
    ... separations = [0.0, 2.0]
    ... ''')
    >>> scene.n_asperities
    30000
    """
    try:
        document = loads(text if isinstance(text, str) else text.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        reason = str(error).splitlines()[0] if str(error) else "nested too deeply"
        raise SceneError([f"not a TOML scene: {reason}"]) from None
    top = Section("", document, [])
    parts = {name: top.section(name) for name in ("surface", "grading", "heights", "contact", "ensemble")}
    surface = _surface(parts["surface"])
    values = {
        "title": top.text("title", ""),
        "surface": surface,
        **_grading(parts["grading"], surface, folder or Path()),
        "heights": heights_law(parts["heights"], folder or Path()),
        **_contact(parts["contact"]),
        **_ensemble(parts["ensemble"], surface, seed),
    }
    for section in (top, *parts.values()):
        section.finish()
    if top.problems:
        raise SceneError(top.problems)
    return Scene(**values)


def _surface(section: Section) -> Surface | None:
    values = {
        key: _bodies(section) if key == "E_star" and "bodies" in section else section.number(key, unit=unit)
        for key, unit in SURFACE_UNITS.items()
    }
    if any(math.isnan(value) for value in values.values()):
        return None
    return Surface(**values)


def _bodies(section: Section) -> float:
    given = section.take("bodies")
    if "E_star" in section:
        section.fail("E_star", section.take("E_star"), "give either E_star or bodies, not both")
    try:
        return composite_modulus([_body(**body) for body in given])
    except (TypeError, ValueError) as error:
        reason = str(error) if type(error) is ValueError else "each needs E in Pa and may have nu"
        section.fail("bodies", given, f"give two, as [{{E = 70e9, nu = 0.33}}, {{E = inf}}]; {reason}")
        return math.nan


def _body(E: float | str, **nu: float) -> Body:
    if any(isinstance(value, str | bool) for value in nu.values()) or isinstance(E, bool):
        raise TypeError
    return Body(quantity(E, "Pa", "E"), **nu)


def _grading(section: Section, surface: Surface | None, folder: Path) -> dict[str, Any]:
    laws = ("homogeneous", "exponential", "table", "series")
    law = section.choice("law", "exponential" if "gamma" in section else "homogeneous", laws)
    negative = section.choice("negative", "error", ("error", "clip", "allow"))
    grading: Grading = Homogeneous()
    if law == "exponential":
        gamma = section.number("gamma", positive=False)
        if math.isfinite(gamma):
            grading = Exponential(gamma)
    elif law == "table":
        grading = _table(section, surface, folder) or grading
    elif law == "series":
        grading = read_series(section) or grading
    return {"grading": grading, "negative": negative}


def _table(section: Section, surface: Surface | None, folder: Path) -> Table | None:
    """Points in the scene itself, or in a CSV file beside it."""
    file, s, ratio = section.take("file"), section.take("s"), section.take("ratio")
    try:
        if file is None:
            return Table(s or (), ratio or ())
        return read_grading(folder / file, surface) if surface else None
    except (TypeError, ValueError) as error:
        key, given = ("s", s) if file is None else ("file", file)
        section.fail(key, given, f"give a CSV file, or lists s and ratio; {error}")
        return None


def read_grading(path: Path, surface: Surface) -> Table:
    """A grading from a CSV file of bounded length, as `analytic.Table.from_csv` reads it.

    Raises
    ------
    ValueError
        If it cannot be read, or is no such table.
    """
    lines = read_text(path, _MOST_TABLE).splitlines()
    try:
        return Table.from_lines(lines, sigma=surface.sigma, E_star=surface.E_star)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _contact(section: Section) -> dict[str, Any]:
    return {"quantities": quantities_of(section), "separations": separations_of(section)}


def _ensemble(
    section: Section, surface: Surface | None, seed: Callable[[], int | None] | None
) -> dict[str, Any]:
    other = None if "seed" in section or seed is None else seed()
    values = {
        "n_surfaces": _most_surfaces(section),
        "n_asperities": section.whole("n_asperities", None, least=1),
        "count": section.choice("count", "fixed", ("fixed", "poisson")),
        "seed": section.whole("seed", LeftOut(secrets.randbits(63) if other is None else other)),
        "sampler": section.choice("sampler", "auto", SAMPLERS),
        "keep": section.choice("keep", "sums", ("sums", "moments")),
        "rel_err": section.number("rel_err", unit="1") if "rel_err" in section else None,
        "max_seconds": section.number("max_seconds", unit="s") if "max_seconds" in section else None,
    }
    section.known("rel_err", "max_seconds", "max_surfaces", "n_surfaces")
    for key in _left_out(section, surface, values["n_asperities"]):
        if values[key] is not None:
            values[key] = LeftOut(values[key])
    return {key: value for key, value in values.items() if value is not None}


def _left_out(section: Section, surface: Surface | None, n_asperities: int | None) -> list[str]:
    """Which values, though written here, nobody gave when the scene was asked: see `scene_text`."""
    given = section.take("left_out")
    keys = ["n_asperities", "seed"]
    if given is None:
        return []
    if not (isinstance(given, list) and all(key in keys for key in given)):
        section.fail("left_out", given, f"give a list of {', '.join(keys)}, or leave it out")
        return []
    if "n_asperities" in given and surface and n_asperities not in (None, round(surface.n_asperities)):
        section.fail(
            "n_asperities",
            n_asperities,
            f"left_out says that nobody gave it, but eta * nominal_area is {surface.n_asperities:.10g}; "
            "take it out of left_out, or leave n_asperities out",
        )
        return []
    return given


def _most_surfaces(section: Section) -> int | None:
    """Number of surfaces, or the most that a stop rule may draw."""
    if "rel_err" not in section:
        if "max_surfaces" in section:
            section.fail("max_surfaces", section.take("max_surfaces"), "goes with rel_err; give n_surfaces")
        return section.whole("n_surfaces", None, least=1)  # type: ignore[no-any-return]
    if "n_surfaces" in section:
        advice = "rel_err decides how many; give max_surfaces for the most, or leave rel_err out"
        section.fail("n_surfaces", section.take("n_surfaces"), advice)
    return section.whole("max_surfaces", None, least=1)  # type: ignore[no-any-return]


def scene_text(scene: Scene, *, heights_file: str | None = None, left_out: bool = True) -> str:
    """TOML text of a scene with every value: read again, it gives the same scene.

    Parameters
    ----------
    scene : Scene
        With any grading; a Python function becomes its series.
    heights_file : str, optional
        Name beside the scene of a file that holds its measured heights, in the place of a list.
    left_out : bool, optional
        Whether `left_out` under ``[ensemble]`` lists the numbers that nobody gave, so that
        n_asperities follows when the surface of a scene that was read is replaced.

    Returns
    -------
    str
        The text.

    Raises
    ------
    SceneError
        If the grading cannot be resolved, or the height law is a class of the user.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> mcgw.scene_from(mcgw.scene_text(scene)) == scene
    True
    """
    scene = storable(scene)
    surface = scene.surface
    document = {
        "title": scene.title,
        "surface": {key: float(getattr(surface, key)) for key in SURFACE_UNITS},
        "grading": {**_grading_table(scene.grading), "negative": scene.negative},
        "heights": heights_table(scene.heights, heights_file),
        "contact": {"separations": list(scene.separations), "quantities": list(scene.quantities)},
        "ensemble": {
            "n_surfaces" if scene.rel_err is None else "max_surfaces": scene.n_surfaces,
            **{key: getattr(scene, key) for key in ("n_asperities", "count", "seed", "sampler", "keep")},
            **{
                key: float(value)
                for key in ("rel_err", "max_seconds")
                if (value := getattr(scene, key)) is not None
            },
            **({"left_out": list(scene.left_out)} if left_out and scene.left_out else {}),
        },
    }
    return tomli_w.dumps(document)


def _grading_table(grading: Grading) -> dict[str, Any]:
    match grading:
        case Homogeneous():
            return {"law": "homogeneous"}
        case Exponential():
            return {"law": "exponential", "gamma": float(grading.gamma)}
        case Table():
            return {"law": "table", "s": list(grading.s), "ratio": list(grading.ratio)}
        case PiecewiseSeries():
            return series_table(grading)
    raise AssertionError(grading)  # `storable` leaves no other

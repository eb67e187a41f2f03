"""Scenes as TOML: read with all mistakes named at once, written so that they read the same."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tomli_w

from analytic import MeasuredRadii
from analytic.laws import Hertz
from mcgw.formats.named_files import HDF5, loads, read_bytes
from mcgw.scene.contact_section import contact_values
from mcgw.scene.ensemble_section import ensemble_values
from mcgw.scene.film_section import film_table
from mcgw.scene.grading_section import grading_table, grading_values
from mcgw.scene.heights_section import heights_table
from mcgw.scene.law_section import law_table
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError, Section
from mcgw.scene.storable import storable
from mcgw.scene.summits_section import summits_table
from mcgw.scene.surface import SURFACE_UNITS
from mcgw.scene.surface_and_summits import surface_and_summits
from mcgw.scene.tangential_section import tangential_table

if TYPE_CHECKING:
    from analytic import Interaction
    from mcgw.scene.fitted_section import Fitted

__all__ = ["files_of", "load_scene", "scene_document", "scene_from", "scene_of", "scene_text"]

_MOST_BYTES = 2**21


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
    if text.startswith(HDF5):
        raise SceneError([f"{path}: holds results, not a scene; mcgw show --scene {path} prints theirs"])
    return scene_from(text, folder=path.parent, seed=seed)


def files_of(path: str | Path) -> list[Path]:
    """The file of a scene that was read, then every ``file`` that its sections name."""
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
    except UnicodeDecodeError as error:
        raise SceneError([f"not a TOML scene: no text in UTF-8 (byte {error.start})"]) from None
    except (ValueError, RecursionError) as error:
        reason = str(error).splitlines()[0] if str(error) else "nested too deeply"
        raise SceneError([f"not a TOML scene: {reason}"]) from None
    return scene_of(document, folder=folder, seed=seed)


def scene_of(
    document: dict[str, Any], *, folder: Path | None = None, seed: Callable[[], int | None] | None = None
) -> Scene:
    """Make a scene of the tables that its TOML text holds; arguments and errors as of `scene_from`."""
    top = Section("", document, [])
    sections = {
        name: top.section(name)
        for name in ("surface", "grading", "heights", "summits", "contact", "ensemble")
    }
    interaction, fitted = top.section("interaction"), top.section("fitted")
    folder = folder or Path()
    surface, heights, curvature = surface_and_summits(sections, folder)
    values = {
        "title": top.text("title", ""),
        "surface": surface,
        **grading_values(sections["grading"], surface, folder),
        "heights": heights,
        "curvature": curvature,
        **contact_values(sections["contact"], heights),
        "interaction": _interaction(interaction) if "interaction" in top else None,
        "fitted": _fitted(fitted) if "fitted" in top else None,
        **ensemble_values(sections["ensemble"], surface, seed),
    }
    for section in (top, *sections.values()):
        section.finish()
    if top.problems:
        raise SceneError(top.problems)
    return Scene(**values)


def scene_text(scene: Scene, *, heights_file: str | None = None, left_out: bool = True) -> str:
    """TOML text of a scene with every value: read again, it gives the same scene.

    Parameters
    ----------
    scene : Scene
        With any grading; a Python function becomes its series.
    heights_file : str, optional
        Name beside the scene of a file that holds its measured heights, or heights and radii, in the place
        of lists.
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
    return tomli_w.dumps(scene_document(scene, heights_file=heights_file, left_out=left_out))


def scene_document(scene: Scene, *, heights_file: str | None = None, left_out: bool = True) -> dict[str, Any]:
    """The tables that `scene_text` writes; arguments and errors as there."""
    scene = storable(scene)
    summits = summits_table(scene.curvature, scene.surface, heights_file)
    listed = isinstance(scene.curvature, MeasuredRadii)  # whose heights stand there too
    return {
        "title": scene.title,
        "surface": {key: float(getattr(scene.surface, key)) for key in SURFACE_UNITS},
        "grading": {**grading_table(scene.grading), "negative": scene.negative},
        **({} if listed else {"heights": heights_table(scene.heights, heights_file)}),
        **({"summits": summits} if summits else {}),
        "contact": _contact_table(scene),
        **_interaction_table(scene),
        **_fitted_table(scene),
        "ensemble": _ensemble_table(scene, left_out),
    }


def _interaction(section: Section) -> "Interaction | None":
    from mcgw.scene.interaction_section import interaction_values  # for those scenes alone

    return interaction_values(section)


def _interaction_table(scene: Scene) -> dict[str, Any]:
    if scene.interaction is None:
        return {}
    from mcgw.scene.interaction_section import interaction_table

    return {"interaction": interaction_table(scene.interaction)}


def _fitted(section: Section) -> "Fitted | None":
    from mcgw.scene.fitted_section import fitted_values  # as above

    return fitted_values(section)


def _fitted_table(scene: Scene) -> dict[str, Any]:
    if scene.fitted is None:
        return {}
    from mcgw.scene.fitted_section import fitted_table

    return {"fitted": fitted_table(scene.fitted)}


def _contact_table(scene: Scene) -> dict[str, Any]:
    back = {} if scene.unload_from is None else {"unload_from": scene.unload_from}
    film = {} if scene.film is None else film_table(scene.film)
    asked = {"separations": list(scene.separations), "quantities": list(scene.quantities)}
    law = {} if type(scene.law) is Hertz else law_table(scene.law)
    pushed = {} if scene.tangential is None else {"tangential": tangential_table(scene.tangential)}
    return {**law, **back, **film, **asked, **pushed}


def _ensemble_table(scene: Scene, left_out: bool) -> dict[str, Any]:
    most = "n_surfaces" if scene.rel_err is None else "max_surfaces"
    # What is not asked for is not written: the text of a scene without it stays as it was.
    spent = {"accuracy": None if scene.exact else scene.accuracy, "law_error": scene.law_error or None}
    stops = {**spent, "rel_err": scene.rel_err, "max_seconds": scene.max_seconds}
    given = {key: value for key, value in stops.items() if value is not None}
    return {
        most: scene.n_surfaces,
        **{key: getattr(scene, key) for key in ("n_asperities", "count", "seed", "sampler", "keep")},
        **{key: dict(x) if isinstance(x, Mapping) else float(x) for key, x in given.items()},
        **({"edges": list(scene.edges)} if scene.edges else {}),
        **({"left_out": list(scene.left_out)} if left_out and scene.left_out else {}),
    }

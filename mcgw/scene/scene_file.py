"""Scenes as TOML: read with all mistakes named at once, written so that they read the same."""

import math
import re
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import tomli_w

from analytic import MeasuredRadii
from analytic.laws import Hertz
from mcgw.formats.files import HDF5
from mcgw.formats.named_files import loads, read_bytes
from mcgw.machine.terminal import one_line
from mcgw.scene.fields import LeftOut
from mcgw.scene.kinds import as_toml
from mcgw.scene.measured import MOMENTS, SUMMITS, RoughBody, body_of
from mcgw.scene.reading import Seeds, of_tables, with_changes
from mcgw.scene.scene import Scene, storable
from mcgw.scene.section import SceneError, shortened
from mcgw.scene.writing import contact_law_table, heights_table, law_table, summits_table, written

_MOST_BYTES = 2**21
_FOLLOW = (*SUMMITS, "E_star", *MOMENTS)  # keys of [surface] that two files of bodies determine
# Keys of [joint] and [contact.law] beside which those of the files do not count.
_CONDUCTION = {"resistivity", "conductivities"}
_YIELD = {"hardness", "critical", "yield_strength", "yield_strain"}
_BARE = r"([\w.]+)\s*=\s*([^\s\"'\[{#][^\"'\]},#]*?)\s*(?:#.*)?"  # a value that lacks its quotes


def load_scene(
    path: str | Path, *, seed: Seeds | None = None, changes: Mapping[str, Any] | None = None
) -> Scene:
    """Read a scene.

    Parameters
    ----------
    path : str or Path
        A TOML file; `runs/demo.toml` shows its keys.
    seed : callable, optional
        Asked for a seed if the scene gives none; where it has none either, one is drawn.
    changes : mapping, optional
        Values in place of those of the file, by their keys, as ``{"grading.gamma": 2.0}``.

    Returns
    -------
    Scene
        Checked, with a seed drawn where none is given.

    Raises
    ------
    SceneError
        With one line for each mistake: the key, the value, and what to give instead.

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
        cure = f"print their scene with mcgw show --scene {path}"
        raise SceneError([f"{path}: holds results, not a scene; {cure}"])
    changed = with_changes(_document(text, f"{path}: "), as_toml(changes or {}))
    return scene_of(changed, folder=path.parent, seed=seed)


def files_of(path: str | Path) -> list[Path]:
    """Return the file of a scene that was read, then every ``file`` that its tables name."""
    path = Path(path)
    document = loads(read_bytes(path, _MOST_BYTES).decode())
    named = [table["file"] for table in document.values() if isinstance(table, dict) and "file" in table]
    named += files_of_bodies(document)
    return [path, *(path.parent / name for name in named)]


def scene_from(text: str | bytes, *, folder: Path | None = None, seed: Seeds | None = None) -> Scene:
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
    return scene_of(_document(text), folder=folder or Path(), seed=seed)


def _document(text: str | bytes, path: str = "") -> dict[str, Any]:
    """Its tables; `path` begins a message."""
    try:
        text = text if isinstance(text, str) else text.decode("utf-8")
        return loads(text)
    except UnicodeDecodeError as error:
        raise SceneError([f"{path}this is not TOML: not text in UTF-8 (byte {error.start})"]) from None
    except (ValueError, RecursionError) as error:
        reason = str(error).splitlines()[0] if str(error) else "nested too deeply"
        raise SceneError([f"{path}this is not TOML: {reason}{_cure(str(text), reason)}"]) from None


def _cure(text: str, reason: str) -> str:
    """Return the line that is no TOML, and its remedy: mostly a number with its unit lacks its quotes."""
    at, lines = re.search(r"at line (\d+)", reason), text.splitlines()
    if not at or not 0 < int(at[1]) <= len(lines):
        return ""
    line = shortened(one_line(lines[int(at[1]) - 1].strip()))
    bare = re.fullmatch(_BARE, line)
    if bare:
        what = "a text with its unit" if bare[2][0] in "+-.0123456789" else "a text"
        return f': {line}; quote {what}: {bare[1]} = "{bare[2]}"'
    return f": {line}; write key = value" if "=" not in line and not line.startswith("[") else f": {line}"


def scene_of(document: Mapping[str, Any], *, folder: Path = Path(), seed: Seeds | None = None) -> Scene:
    """Make a scene of the tables that its TOML text holds; arguments and errors as of `scene_from`."""
    return Scene.of(of_tables(with_bodies(document, folder), folder, seed))


def scene_text(scene: Scene, *, heights_file: str | None = None) -> str:
    """Write a scene with every value as TOML text: read again, it gives the same scene.

    Parameters
    ----------
    scene : Scene
        With any grading; a Python function becomes its series. A number of asperities that follows from the
        surface is left out.
    heights_file : str, optional
        Name beside the scene of a file that holds its measured heights, or heights and radii, in place
        of lists.

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
    return tomli_w.dumps(scene_document(scene, heights_file=heights_file))


def scene_document(scene: Scene, *, heights_file: str | None = None) -> dict[str, Any]:
    """Return the tables that `scene_text` writes; arguments and errors as there."""
    scene = storable(scene)
    listed = isinstance(scene.summits, MeasuredRadii)  # whose heights stand there too
    law = {} if type(scene.law) is Hertz else contact_law_table(scene.law)
    law |= {key: value for key in ("hardness", "poisson") if (value := getattr(scene, key)) is not None}
    document: dict[str, Any] = {
        "title": scene.title,
        "surface": written(scene.surface, "surface"),
        "grading": {**law_table(scene.grading, "grading"), "negative": scene.negative},
        "heights": {} if listed else heights_table(scene.heights, heights_file),
        "summits": scene.summits and summits_table(scene.summits, scene.surface, heights_file),
        "contact": {"separations": list(scene.separations), **written(scene.contact, "contact")}
        | ({"law": law} if law else {}),
        **{name: written(getattr(scene, name), name) for name in ("interaction", "joint", "fitted")},
        "ensemble": written(scene.ensemble, "ensemble"),
    }
    if isinstance(scene.n_asperities, LeftOut):
        del document["ensemble"]["n_asperities"]
    return {key: value for key, value in document.items() if value or key == "title"}


def with_bodies(document: Mapping[str, Any], folder: Path) -> Mapping[str, Any]:
    """Put the surface of two bodies into the tables of a scene in place of the files that describe them.

    Their hardness and conductivities go under ``[contact.law]`` and ``[joint]``, where both files give them
    and the scene does not. Raises SceneError if a file cannot be read, does not describe one rough body, or a
    key contradicts the files.
    """
    if not (named := files_of_bodies(document)):
        return document
    surface, bodies = document["surface"], document["surface"]["bodies"]
    if len(named) != 2 or bodies != [{"file": name} for name in named]:
        raise SceneError([f"surface.bodies = {bodies}: give {{file = ...}} of both, or E and nu of both"])
    if beside := [key for key in _FOLLOW if key in surface]:
        raise SceneError([f"surface.{beside[0]}: follows from the files of both bodies; leave it out"])
    a, b = (_body(folder / name) for name in named)
    pair = a.beside(b)
    changes: dict[str, Any] = {"surface.bodies": None, "surface.E_star": pair.E_star}
    changes |= {f"surface.{key}": getattr(pair.moments, key) for key in MOMENTS}
    contact, joint = document.get("contact", {}), document.get("joint", {})
    law = contact.get("law", {}) if isinstance(contact, Mapping) else {}
    own = {key for table in (joint, law) if isinstance(table, Mapping) for key in table}
    if not _CONDUCTION & own and pair.conductivities:
        changes["joint.conductivities"] = list(pair.conductivities)
    if not _YIELD & own and pair.hardness:
        changes["contact.law.hardness"] = pair.hardness
    return with_changes(document, changes)


def files_of_bodies(document: Mapping[str, Any]) -> list[str]:
    """Return the files that `[surface] bodies` of a scene names, as they are written."""
    surface = document.get("surface")
    bodies = surface.get("bodies") if isinstance(surface, Mapping) else None
    tables = [each for each in bodies if isinstance(each, Mapping)] if isinstance(bodies, list) else []
    return [str(body["file"]) for body in tables if "file" in body]


def _body(path: Path) -> RoughBody:
    """Read the scene of one body on a rigid plane."""
    try:
        document = loads(read_bytes(path, _MOST_BYTES).decode())
        if files_of_bodies(document):
            raise ValueError("names the files of two bodies itself; give one body")
        values = of_tables(document, path.parent)
        bodies = document["surface"].get("bodies")
        if bodies and not any(body["E"] == math.inf for body in bodies):
            cure = "a file describes one on a rigid plane, {E = inf}"
            raise ValueError(f"surface.bodies: two elastic bodies; {cure}")
        return body_of(SimpleNamespace(**values))
    except ValueError as error:
        problems = getattr(error, "problems", [str(error).removeprefix(f"{path}: ")])
        raise SceneError([f"surface.bodies: {path}: {line}" for line in problems]) from None

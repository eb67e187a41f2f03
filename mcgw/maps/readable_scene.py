"""Scenes of fits as files that a person reads: four digits, natural units, nothing that is a default."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from analytic import Nayak
from mcgw.formats.files import together, whole_file
from mcgw.formats.units import parse
from mcgw.maps.fit import Fit
from mcgw.scene.fields import LeftOut
from mcgw.scene.keys import KEYS
from mcgw.scene.measured import SUMMITS
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_document
from mcgw.validity.lookup import moments_of_nayak

_ONE_LINE = 110  # characters of a list in a scene
_NATURAL = {  # units of a scene that a person reads, and the numbers for which one is chosen
    "m": (" um", " nm", " mm"),
    "m^2": (" mm^2", " um^2", " cm^2"),
    "1/m^2": ("/mm^2", "/um^2"),
    "Pa": (" GPa", " MPa"),
}
_LEAST, _MOST = 0.01, 1e4


def heights_beside(path: Path) -> Path:
    """Path of the file of summit heights."""
    return path.with_name(f"{path.stem}.heights.npy")


def write_scene(scene: Scene, path: Path, measured: Fit | None, comments: list[str]) -> list[Path]:
    """Write a scene from `fitted_scene` with comments above it; returns the files that were written.

    The summit heights of a fit that is `measured` go to a file beside the scene, which names it in place
    of a list. Numbers that nobody gave are left out: N follows when somebody writes another area.
    """
    text = "".join(f"# {line}\n" for line in comments) + "\n"
    beside = heights_beside(path)
    document = scene_document(scene, heights_file=None if measured is None else beside.name)
    if isinstance(scene.seed, LeftOut):
        del document["ensemble"]["seed"]
    document = _readable(_by_moments(document, scene))
    text += _in_few_lines(tomli_w.dumps(document), scene.separations)
    if measured is None:
        with whole_file(path) as unfinished:
            unfinished.write_text(text, encoding="utf-8")
        return [path]
    with together(), whole_file(path) as unfinished, whole_file(beside) as numbers:
        with open(numbers, "wb") as file:
            np.save(file, measured.summits)
        unfinished.write_text(text, encoding="utf-8")
    return [path, beside]


def _readable(document: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of a scene as a person writes them: four digits, natural units, no defaults."""
    tables = {name: keys for name, keys in document.items() if isinstance(keys, dict)}
    found = {
        name: {
            key: _shortened(value, getattr(KEYS[name][key].kind, "unit", "") if key in KEYS[name] else "")
            for key, value in keys.items()
            if key not in KEYS[name] or value != KEYS[name][key].default
        }
        for name, keys in tables.items()
    }
    return {name: value for name, value in (document | found).items() if value or name == "title"}


def _shortened(value: Any, unit: str) -> Any:
    """Return a number with four digits, and with a unit in which it has few; of a table, each."""
    if isinstance(value, dict):
        return {key: _shortened(each, "") for key, each in value.items()}
    if not isinstance(value, float):
        return value
    for name in _NATURAL.get(unit, ()):
        if _LEAST <= (size := value / parse(f"1{name}", unit)) < _MOST:
            return f"{size:.4g}{name}"
    return float(f"{value:.4g}")


def _by_moments(document: dict[str, Any], scene: Scene) -> dict[str, Any]:
    """Return the tables with m0, m2 and m4 in place of the summits that follow from them."""
    if not isinstance(scene.heights, Nayak) or document.get("summits") != {"curvature": "random"}:
        return document
    m = moments_of_nayak(scene.surface, scene.heights.alpha)
    surface = {key: value for key, value in document["surface"].items() if key not in SUMMITS}
    moments = {"m0": m.m0, "m2": m.m2, "m4": m.m4}
    return document | {"surface": {**moments, **surface}, "heights": {}, "summits": {}}


def _in_few_lines(text: str, separations: Sequence[float]) -> str:
    """TOML text with its short lists on one line each, and even separations as a range."""

    def short(found: re.Match[str]) -> str:
        line = re.sub(r",? *\n *(?=\])|(?<=\[)\n *", "", found[0])
        line = re.sub(r" *\n *", " ", line)
        return line if len(line) <= _ONE_LINE else found[0]

    start, stop, num = separations[0], separations[-1], len(separations)
    even = [float(f"{h:.15g}") for h in np.linspace(start, stop, num)]  # as a range is read
    if num > 1 and even == list(separations):
        of_range = f"separations = {{start = {start!r}, stop = {stop!r}, num = {num}}}"
        text = re.sub(r"^separations = \[[^\]]*\]", of_range, text, flags=re.MULTILINE)
    return re.sub(r"^\w+ = \[\n(?: .*\n)*\]", short, text, flags=re.MULTILINE)

"""Which runs may be one: those whose surfaces are the same, whatever their number.

Besides its scene, the numbers of a run depend on the versions of what draws. In their last digits they depend
on the kind of processor as well, which a run may change on its way, as the nodes of a cluster do: to 1e-12
they are the same.

What is needed to repeat a run, besides its scene: versions, commit, processor, date.
"""

import hashlib
import json
import platform
import re
import subprocess
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import tomli_w

from mcgw.errors import StoreError
from mcgw.formats.named_files import loads
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_document, scene_from
from mcgw.scene.section import shortened
from mcgw.store.h5_writing import MOST_TEXT

Question = tuple[str, str, str]  # text of a scene, axes of a sweep or none, versions that draw
_PACKAGES = ("mcgw", "numpy", "scipy", "numba", "h5py")
_DRAW = ("mcgw", "numpy", "numba", "scipy")


def written(scene: Scene) -> tuple[str, str]:
    """Return a scene as TOML, and SHA-256 of all its values but the number of surfaces."""
    document = scene_document(scene)
    text = tomli_w.dumps(document)
    if len(text.encode()) > MOST_TEXT:
        raise StoreError(
            f"scene: its lists need {len(text)} characters, but a file of results holds at most "
            f"{MOST_TEXT}; list fewer summits, or simulate in memory"
        )
    document["ensemble"] |= {"n_asperities": scene.n_asperities}  # whoever gave it
    del document["ensemble"]["n_surfaces"]
    return text, hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()


def another(where: Path, kind: str, there: Question, here: Question) -> StoreError:
    """Return the error that a place holds something else."""
    what = difference(there, here)
    return StoreError(f"{where}: holds a different {kind}: {what}; choose another -o, or remove it")


def difference(there: Question, here: Question) -> str:
    """Tell what keeps two runs, or two sweeps, from being one: scene, axes and what draws, of each."""
    before, now = _said(*there[:2]), _said(*here[:2])
    for key in (*now, *before):
        if before.get(key) != now.get(key):
            given = f"{shortened(repr(now[key]))} here" if key in now else "not given here"
            return f"{key} is {shortened(repr(before.get(key)))} there and {given}"
    return f"it was drawn with {there[2]}, but this is {here[2]}"


def _said(scene: str, axes: str) -> dict[str, Any]:
    """Keys and values that decide the numbers: of a scene alone but for the number of surfaces."""
    found = {"sweep": axes or None, **dict(_flat(loads(scene)))}
    if not axes:
        found.pop("ensemble.n_surfaces", None)
        found["ensemble.n_asperities"] = scene_from(scene).n_asperities
    return found


def _flat(table: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


@cache
def versions(*, of_draws: bool = False) -> str:
    """Versions of Python and of the packages; or only of those on which the numbers drawn depend."""
    known = [] if of_draws else [f"python {platform.python_version()}"]
    for name in _DRAW if of_draws else _PACKAGES:
        try:
            known.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            known.append(f"{name} unknown")
    return ", ".join(known)


@cache
def commit() -> str:
    """Commit of a source checkout, "unknown" for an installed package."""
    here = Path(__file__).resolve().parents[2]
    if not (here / ".git").exists():
        return "unknown"
    call = ["git", "-C", str(here), "rev-parse", "HEAD"]
    try:
        return subprocess.run(call, capture_output=True, text=True, timeout=5, check=True).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return "unknown"


@cache
def processor() -> str:
    """Name of the processor and number of its cores."""
    with suppress(OSError):
        names = re.findall(r"^model name\s*: (.*)", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
        if names:
            return f"{names[0].strip()} ({len(names)} cores)"
    return platform.processor() or platform.machine()

"""Which runs may be one: those whose surfaces are the same, whatever their number.

On what the numbers of a scene depend besides the scene: versions, and for some the kind of processor.

Sums, products, quotients and roots are rounded alike by every processor, and the samplers, height laws and
gradings of this package are made of them. A distribution of scipy.stats, a function of the user, the powers
of contact laws and the generators behind ``direct`` call exponentials and logarithms of NumPy and of the C
library, whose last digits differ from one kind of processor to another. Then the kind is known by what these
give here.

What is needed to repeat a run, besides its scene: versions, commit, processor, date.
"""

import hashlib
import math
import platform
import subprocess
import sys
from collections.abc import Iterator
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np
from scipy import special

import analytic
from mcgw.formats.named_files import loads
from mcgw.scene.promises import promise_of
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_from, scene_text
from mcgw.scene.section import shortened

Question = tuple[str, str, str]  # text of a scene, axes of a sweep or none, versions that draw
KIND = ", processor "  # stands between the versions and the kind
_HEIGHTS = (analytic.Gaussian, analytic.ExponentialHeights, analytic.HeightTable, analytic.MeasuredHeights)
_GRADINGS = (analytic.Homogeneous, analytic.Exponential, analytic.Table, analytic.PiecewiseSeries)
_POINTS = 4096  # one value in a thousand differs between kinds
_PACKAGES = ("mcgw", "numpy", "scipy", "numba", "h5py")
_DRAW = ("mcgw", "numpy", "numba", "scipy")


def identity_of(scene: Scene, sampler: str) -> str:
    """SHA-256 of all that the numbers of a surface depend on: frozen scene, sampler, what draws."""
    frozen = scene_text(scene.with_surfaces(1), left_out=False)  # its values, whoever gave them
    parts = (frozen, sampler, drawn_with(scene, sampler))
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


def difference(there: Question, here: Question) -> str:
    """What keeps two runs, or two sweeps, from being one, in words: scene, axes and what draws, of each."""
    before, now = _said(*there[:2]), _said(*here[:2])
    for key, value in now.items():
        if before.get(key) != value:
            return f"{key} is {shortened(repr(before.get(key)))} there and {shortened(repr(value))} here"
    for key, value in before.items():
        if key not in now:
            return f"{key} is {shortened(repr(value))} there and not given here"
    made_with, this = there[2], here[2]
    if made_with.partition(KIND)[0] == this.partition(KIND)[0] and made_with != this:
        return "it was drawn on another kind of processor, which rounds exponentials differently"
    return f"it was drawn with {made_with}, but this is {this}"


def _said(scene: str, axes: str) -> dict[str, Any]:
    """Keys and values that decide the numbers: of a scene alone but for the number of surfaces."""
    if not axes:
        return dict(_flat(loads(scene_text(scene_from(scene).with_surfaces(1), left_out=False))))
    return {**dict(_flat(loads(scene))), "sweep": axes}


def _flat(table: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def depends_on_processor(scene: Scene, sampler: str) -> bool:
    """Whether the last digits of what a sampler draws may differ from one kind of processor to another."""
    modulus = scene.modulus
    if isinstance(modulus, analytic.Clipped) and isinstance(
        modulus.grading, analytic.Exponential | analytic.PiecewiseSeries
    ):
        modulus = modulus.grading
    own = isinstance(scene.heights, _HEIGHTS) and isinstance(modulus, _GRADINGS)
    drawn_alike = promise_of(sampler).same_on_all_processors or (scene.as_measured and not scene.located)
    return not (own and drawn_alike and scene.hertzian)


@cache
def kind_of_processor() -> str:
    """Eight digits that are the same where NumPy, SciPy and the C library round alike."""
    x = (np.arange(_POINTS) + 0.5) / 64
    matrix = 1 / (1 + np.arange(20) + np.arange(20)[:, None])
    values = [
        *(f(x) for f in (np.exp, np.expm1, np.log, np.log1p, np.sin, np.tanh, special.ndtr, special.gammaln)),
        x**1.7,
        special.gammainc(2.5, x),
        matrix @ matrix,
        np.array([(math.exp(v), math.log(v), math.log1p(v), math.pow(v, 1.7)) for v in x.tolist()]),
    ]
    return hashlib.sha256(b"".join(np.ascontiguousarray(v).tobytes() for v in values)).hexdigest()[:8]


def drawn_with(scene: Scene, sampler: str) -> str:
    """Versions of the packages that draw and, where the numbers depend on it, the kind of processor."""
    known = versions(of_draws=True)
    return f"{known}{KIND}{kind_of_processor()}" if depends_on_processor(scene, sampler) else known


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


def now() -> str:
    """UTC date and time, ISO 8601."""
    return datetime.now(UTC).isoformat(timespec="seconds")


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
    info = Path("/proc/cpuinfo")
    if sys.platform == "linux" and info.exists():
        names = [
            line.split(":", 1)[1].strip() for line in info.read_text().splitlines() if "model name" in line
        ]
        if names:
            return f"{names[0]} ({len(names)} cores)"
    return platform.processor() or platform.machine()

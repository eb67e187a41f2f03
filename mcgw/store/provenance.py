"""What is needed to repeat a run, besides its scene: versions, commit, processor, date."""

import platform
import subprocess
import sys
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

__all__ = ["now", "processor", "provenance", "versions"]

_PACKAGES = ("mcgw", "numpy", "scipy", "numba", "h5py")
_DRAW = ("mcgw", "numpy", "numba", "scipy")


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


def provenance() -> dict[str, str]:
    """Versions, commit and processor, as far as they are known."""
    return {"versions": versions(), "commit": _commit(), "cpu": processor()}


@cache
def _commit() -> str:
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

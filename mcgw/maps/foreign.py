"""Maps in the many formats that SurfaceTopography reads, where it is installed.

Its readers believe what a file declares, so they work in a process of their own, with as much memory and time
as a file of that size may take: ``python -m mcgw.maps.foreign FILE HEIGHTS WHAT MEMORY`` writes heights to a
``.npy`` file and tells the rest as JSON.
"""

import json
import sys
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.formats.named_files import open_npy
from mcgw.machine.child_process import ChildError, limit_memory, run_child
from mcgw.maps.topography import Topography, checked_shape, height_unit

_HEIGHTS = "heights.npy"
_MOST_TEXT = 2**28  # bytes
_MEMORY, _A_BYTE = 2**30, 64  # bytes of address space of the child; and for each byte of the file
_SECONDS, _BYTES_A_SECOND = 60.0, 1e6


class ForeignError(ValueError):
    """A file that is not in one of our formats, but may be in another."""


class UnreadableError(ValueError):
    """A file that SurfaceTopography refuses, or cannot read because it is missing."""


def read_foreign(path: Path, pixel: tuple[float, float] | None = None, unit: str | None = None) -> Topography:
    """Read a map by SurfaceTopography; text with decimal commas too.

    Parameters
    ----------
    path : Path
        Of any format that it knows.
    pixel : (float, float), optional
        Size of a pixel, m, where the file does not tell it.
    unit : str, optional
        Of all lengths, where the file tells none; m if left out.

    Raises
    ------
    ValueError
        If it is not installed or cannot read the file, or the file holds a profile, or tells another unit
        or the size of a pixel that was given, or none that was not.
    """
    with TemporaryDirectory() as folder:
        found = _read(path, Path(folder))
        if found["dim"] != 2:
            raise ValueError(f"{path}: is a profile along a line; a map has rows and columns")
        metre, assumed = height_unit(path, found["unit"], unit)  # the unit also of x and y
        told = found["pixel"]
        if told and pixel is not None:
            raise ValueError(f"{path}: gives the size of a pixel; leave --pixel out")
        if not told and pixel is None:
            raise ValueError(f"{path}: does not give the size of a pixel; give --pixel")
        dx, dy = pixel or (p * metre for p in told)
        z = np.array(open_npy(Path(folder) / _HEIGHTS), dtype=np.float64, order="C")
    z *= metre
    return Topography(z, (dx, dy), found["periodic"], assumed)


def read_foreign_line(path: Path, unit: str | None = None) -> tuple[Array, Array, str]:
    """Places and heights along a line, m, and the unit that was assumed; arguments as of `read_foreign`.

    Raises
    ------
    ValueError
        If SurfaceTopography is not installed or cannot read the file, or the file holds a map.
    """
    with TemporaryDirectory() as folder:
        found = _read(path, Path(folder))
        if found["dim"] != 1:
            raise ValueError(f"{path}: is a map, not a profile; leave --profile out")
        metre, assumed = height_unit(path, found["unit"], unit)
        places, heights = np.array(open_npy(Path(folder) / _HEIGHTS), dtype=np.float64) * metre
    return places, heights, assumed


def is_foreign_line(path: Path) -> bool:
    """Whether SurfaceTopography finds heights along a line in a file."""
    with TemporaryDirectory() as folder:
        return bool(_read(path, Path(folder), "kind")["dim"] == 1)


def _read(path: Path, folder: Path, what: str = "all") -> dict[str, Any]:
    """Facts about a file, whose heights are written to a folder unless only its kind is wanted."""
    if find_spec("SurfaceTopography") is None:
        raise UnreadableError(
            f"{path}: {path.suffix or 'no ending'} is not a known format; install SurfaceTopography (the "
            "extra mcgw[maps]), or save it as SDF, X3P, .npy or text"
        )
    try:
        return _from_child(path, folder, what)
    except UnreadableError as error:
        points = _with_points(path, folder)
        if points is not None:
            with suppress(UnreadableError):
                return _from_child(points, folder, what)
        raise UnreadableError(f"{path}: SurfaceTopography cannot read it: {error}") from None


def _from_child(path: Path, folder: Path, what: str) -> dict[str, Any]:
    """Run the child process on a file and return its facts."""
    size = path.stat().st_size
    memory, seconds = _MEMORY + _A_BYTE * size, _SECONDS + size / _BYTES_A_SECOND
    words = str(path), str(folder / _HEIGHTS), what, str(memory)
    try:
        said = run_child("mcgw.maps.foreign", *words, seconds=seconds)
    except ChildError as error:
        raise UnreadableError(f"reading it {error.how}") from None
    found: dict[str, Any] = json.loads(said.splitlines()[-1])
    if "refused" in found:
        raise UnreadableError(found["refused"])
    return found


def _with_points(path: Path, folder: Path) -> Path | None:
    """A copy of a text with points for decimal commas; None if it has none, or they mean something else."""
    if path.stat().st_size > _MOST_TEXT:
        return None
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return None
    if "," not in text or "." in text or "\0" in text:
        return None
    copy = folder / path.name
    copy.write_text(text.replace(",", ".").replace(";", "\t"), encoding="utf-8")
    return copy


def _read_here(path: Path, heights: Path, what: str) -> dict[str, Any]:
    """Facts about a file whose heights are written: rows of y from below; of a profile places and heights."""
    from SurfaceTopography import open_topography  # type: ignore[import-not-found, import-untyped, unused-ignore]

    channel, size = open_topography(str(path)).default_channel, path.stat().st_size
    if what == "kind":
        return {"dim": channel.dim}
    if channel.dim == 1:
        found = channel.topography()
        x, z = found.positions_and_heights()
        checked_shape(1, x.size, held=size)
        np.save(heights, np.array([x, np.ma.filled(z, np.nan)], dtype=np.float64))
        return {"dim": 1, "unit": None if found.unit is None else str(found.unit)}
    columns, rows = (int(n) for n in channel.nb_grid_pts)
    checked_shape(rows, columns, held=size)
    told = channel.physical_sizes is not None
    found = channel.topography(**({} if told else {"physical_sizes": (columns, rows)}))
    checked_shape(*found.nb_grid_pts[::-1])
    np.save(heights, np.ma.filled(np.ma.masked_invalid(found.heights()), np.nan).T)
    return {
        "dim": 2,
        "unit": None if found.unit is None else str(found.unit),
        "pixel": [float(p) for p in found.pixel_size] if told else None,
        "periodic": bool(found.is_periodic),
    }


def _main(path: str, heights: str, what: str, memory: int) -> None:
    memory = limit_memory(memory)
    try:
        answer = _read_here(Path(path), Path(heights), what)
    except MemoryError:
        answer = {"refused": f"it may take {memory >> 20} MiB of memory, and it asks for more"}
    except Exception as error:  # its readers raise many kinds of errors
        answer = {"refused": " ".join(str(error).split())[:160] or type(error).__name__}
    sys.stdout.write("\n" + json.dumps(answer) + "\n")


if __name__ == "__main__":
    _path, _heights, _what, _memory = sys.argv[1:]
    _main(_path, _heights, _what, int(_memory))

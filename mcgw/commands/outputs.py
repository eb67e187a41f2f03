"""What a command puts out: what it prints, more or less with -v or -q; and files, checked beforehand."""

import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from contextvars import ContextVar
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from mcgw.errors import StoreError
from mcgw.machine.process import watched

QUIET, NEWS, ALL = range(3)  # only errors; what was made and found; everything
_AMOUNT = ContextVar("_AMOUNT", default=NEWS)
_inputs: ContextVar[tuple[Path, ...]] = ContextVar("_inputs", default=())
_PICTURES = (  # that matplotlib writes
    ".eps", ".gif", ".jpg", ".jpeg", ".pdf", ".pgf", ".png", ".ps", ".raw", ".rgba", ".svg", ".svgz", ".tif",
    ".tiff", ".webp", ".avif",
)  # fmt: skip
ENDINGS: dict[str, tuple[str, ...]] = {  # of what is written, in lower case
    "a table": (".csv", ".txt"), "an ensemble": (".h5", ".hdf5"), "a web page": (".html", ".htm"),
    "the size of a pixel": (".json",), "solves": (".jsonl",), "heights": (".npy",), "a scene": (".toml",),
    "a figure": _PICTURES, "a figure or its table": (*_PICTURES, ".csv"),
}  # fmt: skip


@dataclass(frozen=True)
class Output:
    """A file that a command is about to write."""

    path: Path
    what: str  # a key of `ENDINGS`, or anything with endings of its own
    option: str = "-o"  # that gave its name
    grows: bool = False  # the rules of ensembles say which may be replaced
    endings: tuple[str, ...] = ()  # where they are not those of `ENDINGS`


def check_outputs(outputs: Iterable[Output], inputs: Iterable[Path] | None = None) -> None:
    """Refuse outputs that would destroy something or cannot be written; make missing folders and say so.

    No later output of this command replaces the inputs either.
    """
    from mcgw.formats.files import check_output, refuse_read_only

    if inputs is not None:
        _inputs.set(tuple(inputs))
    outputs = list(outputs)
    for i, output in enumerate(outputs):
        for why in _faults(output, outputs[:i]):
            raise StoreError(f"{output.option} {output.path}: {why}; choose another {output.option}")
        if not output.grows:
            refuse_read_only(output.path)
    for output in outputs:
        folder = output.path.parent
        new = not folder.exists()
        check_output(output.path)
        if new:
            notes(f"{folder} is a new folder")


def _same_file(one: Path, other: Path) -> bool:
    """Whether two names are one file: same spelling, symbolic link or hard link."""
    try:
        return os.path.samefile(one, other)
    except OSError:  # one of them does not exist
        return os.path.realpath(one) == os.path.realpath(other)


def _faults(output: Output, others: Iterable[Output]) -> Iterator[str]:
    """Why a file may not be written: what is read, a run, another output, what it would replace."""
    from mcgw.formats.files import HDF5, LOCK_FILES, parts_of

    path, place = output.path, Path(os.path.realpath(output.path))
    for read in _inputs.get():
        if _same_file(path, read):
            yield f"is an input ({read})"
        if place.is_relative_to(os.path.realpath(parts_of(read))):
            yield f"{parts_of(read)} is the folder of the run that makes {read}"
    for folder in (place, *place.parents):
        if folder.suffix == ".parts" and any((folder / name).exists() for name in LOCK_FILES):
            yield f"{folder} is the folder of a run"
    yield from (f"is also the output of {other.option}" for other in others if _same_file(path, other.path))
    endings = output.endings or ENDINGS[output.what]
    if not path.name.lower().endswith(endings):
        yield f"{output.what} is written there, whose name ends in {', '.join(endings)}"
    if output.grows:
        return
    if parts_of(path).exists():
        yield f"a run that makes this file is not finished ({parts_of(path)})"
    if not path.is_file():
        return
    with open(path, "rb") as file:
        if file.read(len(HDF5)) != HDF5:
            return
    if _holds_results(path):
        yield "is an ensemble of mcgw, which this would replace"
    if not {*ENDINGS["an ensemble"]} & {*endings}:
        yield "is an HDF5 file, which this would replace"


def _holds_results(path: Path) -> bool:
    """Whether an HDF5 file says that it holds results, or is too damaged to say what it holds."""
    from mcgw.formats.gate import opened

    with suppress(Exception), opened(path) as file:  # HDF5 reports damage as any of a dozen exceptions
        said = file.attrs.get("filetype", "")
        return (said.decode() if isinstance(said, bytes) else str(said)).startswith("mcgw-results")
    return True


@contextmanager
def speaking(amount: int) -> Iterator[None]:
    """Print this much; when quiet, no progress bars and no warnings either."""
    before = _AMOUNT.set(amount)
    try:
        with nullcontext() if amount == QUIET else watched():
            yield
    finally:
        _AMOUNT.reset(before)


def says(amount: int = NEWS) -> bool:
    """Whether this much is printed."""
    return _AMOUNT.get() >= amount


def news(*lines: object, amount: int = NEWS) -> None:
    """Print what was made, the result, and what to type next."""
    if says(amount) and lines:
        print(*lines, sep="\n")


details = partial(news, amount=ALL)  # with -v only


def notes(*lines: str) -> None:
    """Print notes on standard error."""
    for line in lines if says() else ():
        print(f"mcgw: note: {line}", file=sys.stderr)


def tell_cautions(source: Any, instead: str = "") -> None:
    """Print the cautions of a scene, an ensemble or all points of a sweep.

    With `instead`, which says how to see them in full, only their number is printed, and doubts about units.
    """
    if not says():
        return
    from mcgw.scene.scene import Scene

    scene = getattr(source, "scene", source)
    if isinstance(scene, Scene):
        from mcgw.scene.cautions import cautions
        from mcgw.scene.surface import perhaps_other_units

        lines, doubts = cautions(scene), perhaps_other_units(scene)
    else:
        from mcgw.sweeps.points import sweep_cautions

        lines, doubts = sweep_cautions(source), []
    if instead and not says(ALL):
        number = len(lines) - len(doubts)
        lines = [*doubts, *([f"{number} caution{'s' * (number > 1)}: {instead}"] if number else [])]
    notes(*lines)

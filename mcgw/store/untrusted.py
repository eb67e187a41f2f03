"""Contents of an HDF5 file that is not trusted.

A file whose trailer holds is as `mcgw` wrote it, and is looked at in this process. Any other may come from
a stranger, or from a failing disk, and HDF5 may crash on it: a child process looks at it. What is looked at
is the same in both cases (`mcgw.store.structure`). A trailer is not a signature: whoever makes one for a
hostile file gets that file read here, where links to other places and a greed for memory are refused all the
same.
"""

import json
import os
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from mcgw.errors import StoreError
from mcgw.formats.named_files import open_regular
from mcgw.machine.child_process import ChildError, memory_limit, run_child
from mcgw.store.disk import check_trailer, read_trailer

_MEMORY = 2**31  # bytes of address space of the child; HDF5 and NumPy take a tenth
_SECONDS, _BYTES_A_SECOND = 20.0, 50e6  # a busy machine takes seconds to start a process
_SMALL = 2**24  # bytes up to which all of a file is checked: a hundredth of a second


def examine(path: Path) -> dict[str, Any]:
    """What `mcgw.store.structure.describe` tells of an HDF5 file that is safe to open.

    Raises
    ------
    StoreError
        If it is not there, no plain file of numbers, damaged, or takes too long or too much memory; or if
        this process may have too little memory for looking.
    """
    fd = open_regular(path)
    try:
        status, head = os.fstat(fd), os.read(fd, 512)
    finally:
        os.close(fd)
    if path.suffix == ".toml" and b"\0" not in head:
        raise StoreError(f"{path}: is not a file of results; make one from a scene with mcgw run {path}")
    return _examined(path.resolve(), path, (status.st_ino, status.st_size, status.st_mtime_ns))


@lru_cache(maxsize=32)
def _examined(path: Path, shown: Path, state: tuple[int, int, int]) -> dict[str, Any]:
    """The same file is examined once: `state` changes when it does."""
    with suppress(StoreError):
        # Whether the trailer holds; of a large file the head alone is compared with it, when it is opened.
        (check_trailer if state[1] <= _SMALL else read_trailer)(path)
        with suppress(Exception):  # HDF5 reports damage as any of a dozen: the child tells which it is
            from mcgw.store import structure

            return structure.describe(str(path), read=False)
    return _examined_by_child(path, shown, state[1])


def _examined_by_child(path: Path, shown: Path, size: int) -> dict[str, Any]:
    seconds = _SECONDS + size / _BYTES_A_SECOND
    try:
        said = run_child("mcgw.store.structure", str(path), "--memory", str(_MEMORY), seconds=seconds)
        answer: dict[str, Any] = json.loads(said)
    except ChildError as error:
        _blame_memory(path, shown)
        raise StoreError(f"{shown}: damaged or hostile; reading it {error.how}") from None
    except ValueError:
        raise StoreError(f"{shown}: not an HDF5 file, or a damaged one") from None
    if "refused" in answer:
        if "sure" not in answer:
            _blame_memory(path, shown)
        raise StoreError(f"{shown}: refused: {answer['refused']}")
    return answer


def _blame_memory(path: Path, shown: Path) -> None:
    """Raise if the child may have less memory than it is meant to have, and the file is as it was written."""
    limit = memory_limit()
    if limit is None or limit >= _MEMORY:
        return
    try:
        check_trailer(path)
    except StoreError:
        return
    raise StoreError(
        f"{shown}: cannot be checked within the memory limit of this process (ulimit -v {limit // 1024}); "
        f"{_MEMORY // 1024} is always enough"
    )

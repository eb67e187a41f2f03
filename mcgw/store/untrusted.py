"""Reading an HDF5 file that may come from a stranger: a child process looks at it first."""

import json
import os
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from mcgw.errors import StoreError
from mcgw.formats.plain_file import open_regular
from mcgw.machine.child_process import ChildError, memory_limit, run_child
from mcgw.store.trailer import check_seal

__all__ = ["examine", "examine_all"]

_MEMORY = 2**31  # address space of the child; HDF5 and NumPy take a tenth of it
_AT_ONCE = 500
_SECONDS, _BYTES_A_SECOND = 20.0, 50e6  # a busy machine takes seconds to start a process


def examine(path: Path) -> dict[str, Any]:
    """Attributes and datasets of an HDF5 file that is safe to open.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    dict
        ``{"attributes": {...}, "datasets": {name: [type, shape]}, "head": digest}``.

    Raises
    ------
    StoreError
        If it is not there, no plain file of numbers, damaged, or takes too long or too much memory; or if
        this process may have too little memory for looking.
    """
    fd = open_regular(path)
    try:
        status = os.fstat(fd)
    finally:
        os.close(fd)
    return _examined(path.resolve(), path, (status.st_ino, status.st_size, status.st_mtime_ns))


def examine_all(paths: Sequence[Path]) -> None:
    """As `examine`, for many small files at once.

    Raises
    ------
    StoreError
        That names the first one that is not safe to open, or the folder.
    """
    for start in range(0, len(paths), _AT_ONCE):
        some = paths[start : start + _AT_ONCE]
        size = sum(path.stat().st_size for path in some)
        words = [*map(str, some), "--memory", str(_MEMORY)]
        try:
            said = run_child("mcgw.store.structure", *words, seconds=_SECONDS + size / _BYTES_A_SECOND)
        except ChildError as error:
            for path in some:
                _blame_memory(path, path)
            raise StoreError(f"{some[0].parent}: damaged or hostile; reading it {error.how}") from None
        for path, line in zip(some, said.splitlines(), strict=True):
            if "refused" in (answer := json.loads(line)):
                if "sure" not in answer:
                    _blame_memory(path, path)
                raise StoreError(f"{path}: refused: {answer['refused']}")


@lru_cache(maxsize=32)
def _examined(path: Path, shown: Path, state: tuple[int, int, int]) -> dict[str, Any]:
    """The same file is examined once: `state` changes when it does."""
    seconds = _SECONDS + state[1] / _BYTES_A_SECOND
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
        check_seal(path)
    except StoreError:
        return
    raise StoreError(
        f"{shown}: cannot be looked at with the memory this process may have (ulimit -v {limit // 1024}); "
        f"allow more, {_MEMORY // 1024} is always enough"
    )

"""A file appears whole or not at all."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

__all__ = ["whole_file"]


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Name to write under; at the end the file takes the place of `path`, on an error it goes.

    Parameters
    ----------
    path : Path
        Where the file shall be.

    Raises
    ------
    OSError
        If the folder is not there or cannot be written.
    """
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.part{path.suffix}")
    try:
        yield unfinished
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)

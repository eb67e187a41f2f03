"""Files that somebody names: regular ones of bounded size, opened once, read as they are."""

import os
import stat
from pathlib import Path

from mcgw.errors import StoreError

__all__ = ["HDF5", "open_regular", "read_bytes", "read_text"]

HDF5 = b"\x89HDF\r\n"  # how such a file begins


def open_regular(path: Path) -> int:
    """Descriptor of a regular file, for reading; a pipe or device is refused without waiting for it.

    Raises
    ------
    StoreError
        If there is none, or it is not a regular file.
    """
    try:
        fd = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0))
    except (OSError, ValueError) as error:
        raise StoreError(f"{path}: {getattr(error, 'strerror', None) or error}") from None
    if not stat.S_ISREG(os.fstat(fd).st_mode):
        os.close(fd)
        raise StoreError(f"{path}: is not a regular file")
    return fd


def read_bytes(path: Path, most: int) -> bytes:
    """The contents of a regular file of at most so many bytes; a link is followed.

    Raises
    ------
    StoreError
        If it cannot be read, is not a regular file, or is longer.
    """
    with os.fdopen(open_regular(path), "rb") as file:
        try:
            data = file.read(most + 1)
        except OSError as error:
            raise StoreError(f"{path}: {error.strerror}") from None
    if len(data) > most:
        raise StoreError(f"{path}: longer than {most} bytes")
    return data


def read_text(path: Path, most: int) -> str:
    """As `read_bytes`, UTF-8 with or without a mark at its beginning.

    Raises
    ------
    StoreError
        Also if it is not such text.
    """
    try:
        return read_bytes(path, most).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise StoreError(f"{path}: is not text in UTF-8 (byte {error.start})") from None

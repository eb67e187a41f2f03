"""Files that somebody names, read without trust: regular ones of bounded size, arrays, TOML."""

import os
import re
import stat
import tomllib
import warnings
from pathlib import Path
from tokenize import TokenError
from typing import TYPE_CHECKING, Any, Literal

from mcgw.errors import StoreError

if TYPE_CHECKING:
    import h5py
    from numpy.typing import NDArray

HDF5 = b"\x89HDF\r\n"  # how such a file begins
_UNSOUND = (EOFError, KeyError, MemoryError, OverflowError, SyntaxError, TokenError, TypeError, ValueError)
_MOST_PARTS = 100  # of a dotted key: the parser's time grows as their square
_DEEPEST = 100  # brackets within brackets: the parser calls itself for each
_ASIDE = re.compile(
    r'"""(?:[^"\\]|\\.|"(?!""))*+(?:"""|\Z)'  # texts, to their ends or to where they break off
    r"|'''(?:[^']|'(?!''))*+(?:'''|\Z)"
    r'|"(?:[^"\\\n]|\\.)*+(?:"|$)'
    r"|'[^'\n]*+(?:'|$)"
    r"|\#[^\n]*+",
    re.DOTALL | re.MULTILINE,
)
_LONG_KEY = re.compile(rf"(?<![\w-])(?:[\w-]++[ \t]*+\.[ \t]*+){{{_MOST_PARTS}}}")


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


def open_h5(path: Path | str) -> "h5py.File":
    """Open for reading, without a lock where a disk keeps none: files are whole when they get names."""
    import h5py

    try:
        return h5py.File(path, "r")
    except OSError as error:
        if "unable to lock" not in str(error):
            raise
        return h5py.File(path, "r", locking=False)


def open_npy(path: Path) -> "NDArray[Any]":
    """Map integers or floats of any shape into memory, read-only; nothing is allocated or unpickled.

    Raises
    ------
    ValueError
        If the file cannot be read, is damaged, or holds anything else.
    """
    import numpy as np  # the child that looks at files with little memory does without

    headers = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
    try:
        with os.fdopen(open_regular(path), "rb") as file, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a header in the style of Python 2 is as good
            version = np.lib.format.read_magic(file)
            shape, by_columns, dtype = headers[version](file)
            if dtype.kind not in "fiu":
                raise ValueError("its values are not real numbers")
            order: Literal["F", "C"] = "F" if by_columns else "C"
            return np.memmap(file, dtype, "r", file.tell(), shape, order)
    except StoreError:
        raise
    except _UNSOUND as error:
        reason = (str(error).splitlines() or ["damaged"])[0]
        raise ValueError(f"{path}: is not a valid .npy file: {reason}") from None


def loads(text: str) -> dict[str, Any]:
    """Read a TOML document as `tomllib.loads`, in a time that grows no faster than its length.

    Raises
    ------
    ValueError
        If it is not TOML, a key has a hundred parts, or brackets are nested a hundred deep.
    """
    plain = _ASIDE.sub(lambda found: "" if found[0].startswith("#") else "t", text)
    if _LONG_KEY.search(plain):
        raise ValueError(f"a dotted key has more than {_MOST_PARTS} parts")
    depth = 0
    for bracket in re.findall(r"[\[\]{}]", plain):
        depth = depth + 1 if bracket in "[{" else max(depth - 1, 0)
        if depth > _DEEPEST:
            raise ValueError("nested too deeply")
    return tomllib.loads(text)

"""Files that somebody names, read without trust: regular ones of bounded size, arrays, TOML, JSON."""

import json
import os
import re
import stat
import tomllib
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tokenize import TokenError
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mcgw.errors import StoreError

HDF5 = b"\x89HDF\r\n"  # how such a file begins
_UNSOUND = (EOFError, KeyError, MemoryError, OverflowError, SyntaxError, TokenError, TypeError, ValueError)
_MOST_PARTS = 100  # of a dotted key: the parser's time grows as their square
_LONG_KEY = re.compile(rf"(?<![\w\"'-])(?:[\w\"'-]++[ \t]*+\.[ \t]*+){{{_MOST_PARTS}}}")
# Texts and comments, which may be full of dots.
_ASIDE = re.compile(r'"(?:[^"\\\n]|\\.)*+"|\'[^\'\n]*+\'|#[^\n]*+')


def open_regular(path: Path) -> int:
    """Descriptor of a regular file, for reading; a StoreError of none, or of a pipe, without waiting."""
    try:
        fd = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0))
    except (OSError, ValueError) as error:
        raise StoreError(f"{path}: {getattr(error, 'strerror', None) or error}") from None
    if not stat.S_ISREG(os.fstat(fd).st_mode):
        os.close(fd)
        raise StoreError(f"{path}: is not a regular file")
    return fd


def read_bytes(path: Path, most: int) -> bytes:
    """Return the contents of a regular file; a StoreError if it cannot be read, or has more bytes."""
    with os.fdopen(open_regular(path), "rb") as file:
        try:
            data = file.read(most + 1)
        except OSError as error:
            raise StoreError(f"{path}: {error.strerror}") from None
    if len(data) > most:
        raise StoreError(f"{path}: longer than {most} bytes")
    return data


def read_text(path: Path, most: int) -> str:
    """As `read_bytes`, UTF-8 with or without a mark at its beginning; a StoreError of what is not."""
    try:
        return read_bytes(path, most).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise StoreError(f"{path}: is not text in UTF-8 (byte {error.start})") from None


def open_npy(path: Path) -> NDArray[Any]:
    """Map integers or floats of any shape into memory, read-only; nothing is allocated or unpickled.

    A file that is damaged or holds anything else is a ValueError.
    """
    os.close(open_regular(path))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a header in the style of Python 2 is as good
            array = np.lib.format.open_memmap(path, mode="r")
        if array.dtype.kind not in "fiu":
            raise ValueError("its values are not real numbers")
    except _UNSOUND as error:
        reason = (str(error).splitlines() or ["damaged"])[0]
        raise ValueError(f"{path}: is not a valid .npy file: {reason}") from None
    return array


def loads(text: str) -> dict[str, Any]:
    """Read a TOML document as `tomllib.loads`, in a time that grows no faster than its length.

    Numbers of more than 4000 digits, dotted keys of a hundred parts and deep nesting are a ValueError, too.
    """
    if _LONG_KEY.search(text) and _LONG_KEY.search(_ASIDE.sub("t", text)):
        raise ValueError(f"a dotted key has more than {_MOST_PARTS} parts")
    return dict(_parsed(tomllib.loads, text, 4000))  # digits of a number: Python reads no more


def loads_json(text: str | bytes) -> Any:
    """Read a JSON document as `json.loads`, UTF-8; a ValueError of what only Python takes, such as NaN, too.

    And of numbers of more than 300 digits and of deep nesting.
    """
    text = text if isinstance(text, str) else text.decode("utf-8-sig")
    return _parsed(partial(json.loads, parse_constant=_refuse_constant), text, 300)  # no float has more


def _refuse_constant(word: str) -> float:
    raise ValueError(f"{word} is not a number of JSON")


def _parsed(parse: Callable[[str], Any], text: str, most: int) -> Any:
    """Parse a text whose numbers have at most so many digits."""
    if found := re.search(rf"(?:\d_?){{{most + 1}}}|0x(?:[\da-fA-F]_?){{{most + 1}}}", text):
        line = text.count("\n", 0, found.start()) + 1
        raise ValueError(f"line {line}: a number has more than {most} digits")
    try:
        return parse(text)
    except RecursionError:
        raise ValueError("nested too deeply") from None

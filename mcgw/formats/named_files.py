"""Files that somebody names, read without trust: regular ones of bounded size, numbers, TOML, JSON."""

import csv
import json
import math
import os
import re
import stat
import tomllib
import warnings
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from tokenize import TokenError
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mcgw.errors import StoreError
from mcgw.formats.units import signed

_UNSOUND = (EOFError, KeyError, MemoryError, OverflowError, SyntaxError, TokenError, TypeError, ValueError)
_MOST_PARTS = 100  # of a dotted key: the parser's time grows as their square
_LONG_KEY = re.compile(rf"(?<![\w\"'-])(?:[\w\"'-]++[ \t]*+\.[ \t]*+){{{_MOST_PARTS}}}")
# Texts and comments, which may be full of dots.
_ASIDE = re.compile(r'"(?:[^"\\\n]|\\.)*+"|\'[^\'\n]*+\'|#[^\n]*+')
_NAMED = re.compile(r"\s*(\w+)\s*(?:[(\[/ ]\s*([^()\[\]]*?)\s*[)\]]?)?\s*")  # z, z (um), z [um], z / um, z um


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


def columns_of(path: Path, most: int, *axes: Mapping[str, tuple[str, float]]) -> list[NDArray[np.float64]]:
    """Return a column of a CSV file for each axis, by one of its names, over a size in the SI unit of it.

    Units may follow the names, ``z (um), E_star (GPa)``, or the numbers, ``61.2 GPa``; # begins a comment.
    Raises ValueError, as all here, if it cannot be read or is not such a table; no text of it is quoted.
    """
    lines = [line for line in read_text(path, most).splitlines() if line.strip() and line[0] != "#"]
    try:
        header, *rows = list(csv.reader(lines)) or [[]]
    except csv.Error as error:
        raise ValueError(f"{path}: is not a table: {error}") from None
    names, found = " and ".join(" or ".join(axis) for axis in axes), list[NDArray[np.float64]]()
    heads = [(k, match) for k, text in enumerate(header) if (match := _NAMED.fullmatch(text))]
    for axis in axes:
        own = [(k, match[2] or "", *axis[match[1]]) for k, match in heads if match[1] in axis]
        own = [each for each in own if not math.isnan(signed(f"1{each[1]}", each[2]))]
        if len(own) != 1:
            raise ValueError(
                f"{path}: the first line must name {names}, with commas, such as z (um),E_star (GPa)"
            )
        ((k, unit, si, size),) = own
        cells = [row[k] if len(row) == len(header) else "" for row in rows]
        in_unit, own_unit = (np.array([signed(cell + each, si) for cell in cells]) for each in (unit, ""))
        found.append(np.where(np.isfinite(in_unit), in_unit, own_unit) / size)
    for k in np.flatnonzero(~np.isfinite(found).all(axis=0))[:1]:
        raise ValueError(f"{path}: row {k + 1} below the header has no number as {names}")
    return found


def numbers_of(path: Path, most: int) -> NDArray[np.float64]:
    """Return the heights in a ``.npy`` file, or in a text with one a line (# begins a comment)."""
    if path.suffix == ".npy":
        array = open_npy(path)
        if array.nbytes > most:
            raise ValueError(f"{path}: longer than {most} bytes; give fewer heights")
        return np.asarray(array, dtype=np.float64).ravel()
    lines = read_text(path, most).splitlines()
    try:
        return np.loadtxt(lines, dtype=np.float64, delimiter=",", ndmin=1).ravel()
    except ValueError:
        raise ValueError(
            f"{path}: give one height per line, or the same number on each line, separated by commas"
        ) from None


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

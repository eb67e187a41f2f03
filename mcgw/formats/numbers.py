"""Numbers as people write them: 1.234×10⁻⁵, and columns with the same decimals."""

import re
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_POWER, _MINUS = re.compile(r"(?<=\d)e([+-]\d+)\b"), re.compile(r"(?<![\w⁻])-(?=[\d.])")
_PRINTED = {"d/sigma": "d/σ", "gap/sigma": "gap/σ", "^2": "²", "+-": "±", " ... ": " … "}
_PLAIN = 30.0  # largest over smallest number of a table that is written without powers of ten
_SMALLEST, _LARGEST = 1e-3, 1e5  # of such a table
_BLANK = "\u2004"  # a third of an em, about as wide as a raised digit


def number(x: float, digits: int = 4) -> str:
    """Format a number to some digits, without trailing zeros; with a power of ten below 1e-4 and from 1e4."""
    text = f"{x:.{digits}g}"
    if "e" not in text:
        return text.replace("-", "−")
    mantissa, power = text.split("e")
    return f"{mantissa}×10{str(int(power)).translate(RAISED)}".replace("-", "−")


def typeset(text: str) -> str:
    """Typeset plain text of a terminal: 1e-05, d/sigma, m^2, +-, ... and minus signs.

    Examples
    --------
    >>> typeset("d/sigma = -1.5 +- 2e-05 m^2")
    'd/σ = −1.5 ± 2×10⁻⁵ m²'
    """
    text = _POWER.sub(lambda found: f"×10{str(int(found[1])).translate(RAISED)}", text)
    for plain, printed in _PRINTED.items():
        text = text.replace(plain, printed)
    return _MINUS.sub("−", text)


def columns(values: Iterable[tuple[ArrayLike, int]]) -> list[list[str]]:
    """Format the columns of a table: all with the same decimals, or all with powers of ten.

    Parameters
    ----------
    values : iterable of (array_like, int)
        Of each column, and the digits of its numbers; nan is an empty cell. The first column chooses the
        format: where its numbers lie near each other, the smallest has so many digits, and all of the table
        its decimals.

    Returns
    -------
    list of list of str
        To be aligned to the right: blanks follow exponents that are shorter than others.

    Examples
    --------
    >>> columns([([12.5, 3.25, 0.5], 3), ([0.25, 0.125, 0.0], 2)])
    [['12.500', '3.250', '0.500'], ['0.250', '0.125', '0.000']]
    >>> columns([([1.5, 2.5e-7], 3)])[0] == ["1.50×10⁰\u2004", "2.50×10⁻⁷"]
    True
    """
    arrays = [(np.asarray(x, dtype=np.float64), digits) for x, digits in values]
    decimals = _decimals(*arrays[0])
    if decimals is not None:
        return [[_shown(v, f"{v:.{decimals}f}") for v in x.tolist()] for x, _ in arrays]
    return [_powers(x, digits) for x, digits in arrays]


def _decimals(x: Array, digits: int) -> int | None:
    """Decimals for numbers of similar size; otherwise None."""
    sizes = np.abs(x[np.isfinite(x) & (x != 0)])
    if not sizes.size or sizes.max() > _PLAIN * sizes.min():
        return None
    if sizes.min() < _SMALLEST or sizes.max() >= _LARGEST:
        return None
    return max(digits - 1 - int(np.floor(np.log10(sizes.min()))), 0)


def _powers(x: Array, digits: int) -> list[str]:
    parts = [f"{v:.{digits - 1}e}".split("e") if np.isfinite(v) and v else None for v in x.tolist()]
    powers = [str(int(part[1])).translate(RAISED) if part else "" for part in parts]
    longest = max(map(len, powers), default=0)
    return [
        _shown(v, f"{part[0]}×10{power}{_BLANK * (longest - len(power))}" if part else "0")
        for v, part, power in zip(x.tolist(), parts, powers, strict=True)
    ]


def _shown(x: float, text: str) -> str:
    return text.replace("-", "−") if np.isfinite(x) else ""

"""Numbers as people write them, 1.234×10⁻⁵, and numbers with units.

As ``1.37 um``, ``300/mm^2``, ``1MPa``, ``2%``: this module alone knows units.
"""

import math
import re
import unicodedata
from collections.abc import Iterable
from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array

# Powers of ten as text: a product of fractions rounds once, so that "1.37 um" is 1.37e-6 to the last bit.
_PREFIXES = {
    "": "1", "f": "1e-15", "p": "1e-12", "n": "1e-9", "u": "1e-6", "\N{GREEK SMALL LETTER MU}": "1e-6",
    "m": "1e-3", "k": "1e3", "M": "1e6", "G": "1e9", "T": "1e12",
}  # fmt: skip


def _prefixed(name: str, prefixes: str) -> dict[str, Fraction]:
    return {prefix + name: Fraction(_PREFIXES[prefix]) for prefix in ("", *prefixes)}


_METRIC = _prefixed("m", "fpnu\N{GREEK SMALL LETTER MU}mk") | {"cm": Fraction("1e-2")}
_LENGTHS = _METRIC | {
    "micron": Fraction("1e-6"),
    "Angstrom": Fraction("1e-10"),
    "\N{LATIN CAPITAL LETTER A WITH RING ABOVE}": Fraction("1e-10"),
}
_FACTORS = {
    "m": _LENGTHS,
    "m^2": {f"{name}2": factor**2 for name, factor in _METRIC.items()},
    "1/m^2": {f"1/{name}2": factor**-2 for name, factor in _METRIC.items()},
    "Pa": _prefixed("Pa", "nu\N{GREEK SMALL LETTER MU}mkMGT")
    | {
        "N/m2": Fraction(1),
        "N/mm2": Fraction("1e6"),
        "bar": Fraction("1e5"),
        "psi": Fraction("6894.757293168361"),
    },
    "N": _prefixed("N", "nu\N{GREEK SMALL LETTER MU}mkMG"),
    "s": _prefixed("s", "m") | {"min": Fraction(60), "h": Fraction(3600)},
    "J/m^2": {"J/m2": Fraction(1), "mJ/m2": Fraction("1e-3"), "N/m": Fraction(1), "mN/m": Fraction("1e-3")},
    "1": {"%": Fraction("1e-2")},
}
EXAMPLES = {
    "m": "1.37um, 0.2 mm or 5e-6 (m)",
    "m^2": "1 cm^2, 4 mm^2 or 1e-4 (m^2)",
    "1/m^2": "300/mm^2, 300 mm^-2 or 3e8 (1/m^2)",
    "Pa": "1MPa, 78.6 GPa or 1e6 (Pa)",
    "N": "5N, 2kN or 0.3 (N)",
    "s": "90 s, 30 min or 2 h",
    "J/m^2": "50 mJ/m^2 or 0.05 (J/m^2)",
    "1": "1% or 0.01",
}
_NUMBER = re.compile(r"\s*([-+]?(?:\d{1,99}\.?\d{0,99}|\.\d{1,99})(?:[eE][-+]?\d{1,3})?)\s*(\S.*?)?\s*")

# Names of units of length in files of maps, m.
METRES = {name: float(factor) for name, factor in _LENGTHS.items()} | {"\N{MICRO SIGN}m": 1e-6}


def parse(text: str, unit: str, name: str = "") -> float:
    """Read a positive number with a unit.

    Parameters
    ----------
    text : str
        A number, then its unit, or nothing for the SI unit itself. Squares and reciprocals as ``mm^2``,
        ``mm²``, ``1/mm^2`` or ``mm^-2``.
    unit : {"m", "m^2", "1/m^2", "Pa", "N", "s", "1"}
        SI unit of the result; "1" is a share, which may be in %.
    name : str, optional
        Name of the option or key, for the message.

    Returns
    -------
    float
        In the SI unit, rounded once.

    Raises
    ------
    ValueError
        If it is not a positive finite number with such a unit.

    Examples
    --------
    >>> parse("1.37 um", "m"), parse("300/mm^2", "1/m^2"), parse("2 %", "1")
    (1.37e-06, 300000000.0, 0.02)
    """
    value = signed(text, unit)
    if not (math.isfinite(value) and value > 0):
        said = f"{name} = " if name else ""
        shown = repr(text if len(text) <= 60 else text[:57] + "...")
        raise ValueError(f"{said}{shown}: give a number > 0 with its unit, such as {EXAMPLES[unit]}")
    return value


def signed(text: str, unit: str) -> float:
    """Read a number of any sign, otherwise as `parse`."""
    match = _NUMBER.fullmatch(text) if len(text) < 1000 else None
    factor = _factor(match.group(2) or "", unit) if match else None
    try:
        return float(Fraction(match.group(1)) * factor) if match and factor is not None else math.nan
    except OverflowError:
        return math.inf


def _factor(written: str, unit: str) -> Fraction | None:
    """Factor of a unit in any spelling: ``mm²`` is ``mm^2``, ``mm^-2`` and ``/mm^2`` are ``1/mm^2``."""
    plain = unicodedata.normalize("NFKC", written).replace("\N{MINUS SIGN}", "-")
    plain = re.sub(r"\^|\*\*|\s", "", plain)
    plain = re.sub(r"^(?:/(\w+)|(\w+)-2)$", lambda m: f"1/{m[1] or m[2] + '2'}", plain)
    return Fraction(1) if not plain else _FACTORS[unit].get(plain)


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

"""Numbers with units, as people write them: ``1.37 um``, ``300/mm^2``, ``1MPa``, ``2%``. The one place."""

import math
import re
import unicodedata
from fractions import Fraction

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
        What is measured; "1" is a share, which may be in %.
    name : str, optional
        Of the option or key that it belongs to, for the message.

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
    """As `parse`, of a number of any sign: nan or infinite where it is none of that kind."""
    match = _NUMBER.fullmatch(text) if len(text) < 1000 else None
    factor = _factor(match.group(2) or "", unit) if match else None
    try:
        return float(Fraction(match.group(1)) * factor) if match and factor is not None else math.nan
    except OverflowError:
        return math.inf


def _factor(written: str, unit: str) -> Fraction | None:
    """Of a unit in any spelling: ``mm²`` is ``mm^2``, ``mm^-2`` and ``/mm^2`` are ``1/mm^2``."""
    plain = unicodedata.normalize("NFKC", written).replace("\N{MINUS SIGN}", "-")
    plain = re.sub(r"\^|\*\*|\s", "", plain)
    plain = re.sub(r"^(?:/(\w+)|(\w+)-2)$", lambda m: f"1/{m[1] or m[2] + '2'}", plain)
    return Fraction(1) if not plain else _FACTORS[unit].get(plain)

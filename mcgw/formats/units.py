"""Numbers with units, as the field writes them: ``1.37 um``, ``300/mm^2``, ``20 kgf/cm^2``, ``150 W/(m K)``.

This module alone knows units: of keys of scenes, options of commands and headers of files.
"""

import math
import re
import unicodedata
from fractions import Fraction

# Powers of ten as text: a product of fractions rounds once, so that "1.37 um" is 1.37e-6 to the last bit.
_PREFIXES = {
    "": "1", "f": "1e-15", "p": "1e-12", "n": "1e-9", "u": "1e-6", "\N{GREEK SMALL LETTER MU}": "1e-6",
    "m": "1e-3", "k": "1e3", "M": "1e6", "G": "1e9", "T": "1e12",
}  # fmt: skip


def _prefixed(name: str, prefixes: str, size: str = "1") -> dict[str, Fraction]:
    return {prefix + name: Fraction(_PREFIXES[prefix]) * Fraction(size) for prefix in ("", *prefixes)}


_SMALL = "nu\N{GREEK SMALL LETTER MU}m"
_INCH, _POUND, _KILOGRAM = Fraction("0.0254"), Fraction("4.4482216152605"), Fraction("9.80665")
_METRIC = _prefixed("m", f"fp{_SMALL}k") | {"cm": Fraction("1e-2")}
_SQUARED = _METRIC | {"in": _INCH}
_NAMED = {
    "micron": Fraction("1e-6"), "Angstrom": Fraction("1e-10"),
    "\N{LATIN CAPITAL LETTER A WITH RING ABOVE}": Fraction("1e-10"),
    "uin": _INCH / 10**6, "\N{GREEK SMALL LETTER MU}in": _INCH / 10**6, "mil": _INCH / 1000, "inch": _INCH,
}  # fmt: skip
_FACTORS = {
    "m": _METRIC | _NAMED | {"in": _INCH},
    "m^2": {f"{name}2": factor**2 for name, factor in _SQUARED.items()},
    "1/m^2": {f"1/{name}2": factor**-2 for name, factor in _SQUARED.items()},
    "1/m": {f"1/{name}": 1 / factor for name, factor in _SQUARED.items()},
    "Pa": _prefixed("Pa", f"{_SMALL}kMGT")
    | {f"N/{name}2": _METRIC[name] ** -2 for name in ("m", "cm", "mm")}
    | {f"kgf/{name}2": _KILOGRAM * _METRIC[name] ** -2 for name in ("m", "cm", "mm")}
    | _prefixed("bar", "mk", "1e5")
    | {"psi": _POUND / _INCH**2, "ksi": 1000 * _POUND / _INCH**2, "atm": Fraction(101325)}
    | {"Torr": Fraction(101325, 760), "mTorr": Fraction(101325, 760_000), "mmHg": Fraction("133.322387415")},
    "N": _prefixed("N", f"{_SMALL}kMG") | {"kgf": _KILOGRAM, "gf": _KILOGRAM / 1000, "lbf": _POUND},
    "s": _prefixed("s", "m") | {"min": Fraction(60), "h": Fraction(3600)},
    "J/m^2": {"J/m2": Fraction(1), "mJ/m2": Fraction("1e-3"), "N/m": Fraction(1), "mN/m": Fraction("1e-3")},
    "W/(m K)": {"W/(mK)": Fraction(1), "W/mK": Fraction(1), "W/m/K": Fraction(1)}
    | {"mW/(mK)": Fraction("1e-3"), "mW/mK": Fraction("1e-3"), "W/(cmK)": Fraction(100)},
    "ohm m": _prefixed("ohmm", _SMALL) | _prefixed("ohmcm", _SMALL, "1e-2"),
    "K": {"K": Fraction(1), "degC": Fraction(1), "\N{DEGREE SIGN}C": Fraction(1)},
    "1": {"%": Fraction("1e-2")},
}
_ZEROS = {"degC": Fraction("273.15"), "\N{DEGREE SIGN}C": Fraction("273.15")}  # of a scale, in SI
EXAMPLES = {
    "m": "1.37um, 0.2 mm or 5e-6 (m)",
    "m^2": "1 cm^2, 4 mm^2 or 1e-4 (m^2)",
    "1/m^2": "300/mm^2, 300 mm^-2 or 3e8 (1/m^2)",
    "1/m": "0.043/um, 43 mm^-1 or 4.3e4 (1/m)",
    "Pa": "1MPa, 78.6 GPa or 1e6 (Pa)",
    "N": "5N, 2kN or 0.3 (N)",
    "s": "90 s, 30 min or 2 h",
    "J/m^2": "50 mJ/m^2 or 0.05 (J/m^2)",
    "W/(m K)": "150 W/(m K) or 150.0",
    "ohm m": "17 nohm m, 1.7 uohm cm or 1.7e-8 (ohm m)",
    "K": "20 degC, 293.15 K or 293.15",
    "1": "1% or 0.01",
}
_NUMBER = re.compile(r"\s*([-+]?(?:\d{1,99}\.?\d{0,99}|\.\d{1,99})(?:[eE][-+]?\d{1,3})?)\s*(\S.*?)?\s*")

# Names of units of length in files of maps, m; not "in", which is a word of their headers.
METRES = {name: float(factor) for name, factor in (_METRIC | _NAMED).items()} | {"\N{MICRO SIGN}m": 1e-6}


def parse(text: str, unit: str, name: str = "") -> float:
    """Read a positive number with its unit, or without one in the SI unit, a key of `EXAMPLES`; rounded once.

    Squares and reciprocals are ``mm^2``, ``mm²``, ``1/mm^2`` or ``mm^-2``; "1" is a fraction, which may be in
    %. Anything else is a ValueError, which begins with the name of the option or key.

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
    """Read a number of any sign, otherwise as `parse`; nan if it is none."""
    match = _NUMBER.fullmatch(text) if len(text) < 1000 else None
    if match is None:
        return math.nan
    written = _plain(match.group(2) or "")
    factor = _FACTORS[unit].get(written) if written else Fraction(1)
    if factor is None:
        return math.nan
    try:
        return float(Fraction(match.group(1)) * factor + _ZEROS.get(written, 0))
    except OverflowError:
        return math.inf


def _plain(written: str) -> str:
    """Return a unit in one spelling: ``mm²`` is ``mm2``, ``mm^-2`` and ``/mm^2`` are ``1/mm2``."""
    plain = unicodedata.normalize("NFKC", written).replace("\N{MINUS SIGN}", "-")
    plain = plain.replace("\N{GREEK CAPITAL LETTER OMEGA}", "ohm")
    plain = re.sub(r"\^|\*|\N{MIDDLE DOT}|\s", "", plain)
    return re.sub(r"^(?:/(\w+)|(\w+)-([12]))$", lambda m: f"1/{m[1] or m[2] + m[3].strip('1')}", plain)

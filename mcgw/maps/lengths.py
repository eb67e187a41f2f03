"""Lengths as people write them: ``5um``, ``1.5 mm``, ``2e-6``."""

import math
import re

__all__ = ["METRES", "metres"]

METRES = {
    "m": 1.0,
    "cm": 1e-2,
    "mm": 1e-3,
    "um": 1e-6,
    "\N{MICRO SIGN}m": 1e-6,
    "\N{GREEK SMALL LETTER MU}m": 1e-6,
    "nm": 1e-9,
    "pm": 1e-12,
    "\N{LATIN CAPITAL LETTER A WITH RING ABOVE}": 1e-10,
}


def metres(text: str) -> float:
    """Length in m of a number with or without a unit (m).

    Raises
    ------
    ValueError
        If it is no positive length.

    Examples
    --------
    >>> metres("5um")
    5e-06
    """
    found = re.fullmatch(r"\s*([-+.\deE]+?)\s*([^\W\d_]*)\s*", text)
    try:
        number, unit = (float(found[1]), METRES[found[2] or "m"]) if found else (math.nan, 1.0)
    except (KeyError, ValueError):
        number, unit = math.nan, 1.0
    if not (math.isfinite(number) and number > 0):
        raise ValueError(f"{text!r} is no length: write 5um, 0.2 mm, or 5e-6 (m)")
    return float(f"{number!r}e{round(math.log10(unit))}") if "e" not in repr(number) else number * unit

"""Numbers with units, as people write them: ``1MPa``, ``0.5 kN``, ``2%``."""

import math
import re

__all__ = ["parse"]

_PREFIXES = {"": 1.0, "k": 1e3, "M": 1e6, "G": 1e9, "m": 1e-3, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "n": 1e-9}
_FACTORS = {
    "Pa": {"": 1.0} | {f"{prefix}Pa": factor for prefix, factor in _PREFIXES.items()},
    "N": {"": 1.0} | {f"{prefix}N": factor for prefix, factor in _PREFIXES.items()},
    "1": {"": 1.0, "%": 0.01},
}
_EXAMPLES = {"Pa": "1MPa, 250kPa or 1e6 (Pa)", "N": "5N, 2kN or 0.3 (N)", "1": "1% or 0.01"}
_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S*)\s*")


def parse(text: str, unit: str) -> float:
    """Read a positive number with a unit.

    Parameters
    ----------
    text : str
        A number, then the unit with a prefix from n to G, or nothing for the SI unit itself.
    unit : {"Pa", "N", "1"}
        What is measured; "1" is a share, which may be in %.

    Returns
    -------
    float
        In the SI unit.

    Raises
    ------
    ValueError
        If it is no positive finite number with such a unit.

    Examples
    --------
    >>> parse("1.5MPa", "Pa"), parse("2 %", "1")
    (1500000.0, 0.02)
    """
    match = _NUMBER.fullmatch(text)
    factor = _FACTORS[unit].get(match.group(2)) if match else None
    value = float(match.group(1)) * factor if match and factor is not None else math.nan
    if not (math.isfinite(value) and value > 0):
        raise ValueError(f"{text!r}: give a number > 0 with its unit, such as {_EXAMPLES[unit]}")
    return value

"""What one asperity in contact contributes to each quantity: a power law of its approach.

An asperity of reduced height s under a plane at the reduced separation h carries ::

    scale * (s - h)**exponent * (E*(s)/E*)**modulus        for s > h

(Hertz; Eqs. 1a, 1b of the paper), so the mean over a surface is ``N * scale * F*_exponent(h)``. Pressure
and area fraction are load and area per nominal area.
"""

import math
from dataclasses import dataclass, replace

from analytic.surface import Surface


@dataclass(frozen=True, slots=True)
class Quantity:
    """A quantity of a surface: a sum over its asperities.

    Parameters
    ----------
    name, long_name, unit : str
        Name in code, name for people, SI unit; "S or W/K" where current or heat is conducted.
    exponent : float
        Power n of the approach (s - h).
    modulus : int
        Power of the grading E*(s)/E*: 1 where the modulus counts, else 0.
    radius : float
        Power of the asperity's radius.
    factor : float
        Number in `scale`.
    of : str, optional
        The quantity that this one is per nominal area.
    unloading : str, optional
        The quantity of which this one is the unloading branch, from the lowest separation.
    counts : bool, optional
        Whether it is a number of asperities.
    words, symbol : str, optional
        Few words for people, and its letter; default: the name, and none.
    """

    name: str
    long_name: str
    unit: str
    exponent: float
    modulus: int
    radius: float
    factor: float
    of: str = ""
    unloading: str = ""
    counts: bool = False
    words: str = ""
    symbol: str = ""

    @property
    def title(self) -> str:
        """Words, symbol and unit, as over a panel: "Real area A (m²)"."""
        words = (self.words or (self.unloading or self.name).replace("_", " ")).capitalize()
        unit = "" if self.unit == "1" else f"({self.unit.replace('^2', '²')})"
        way = ", unloading" if self.unloading else ""
        return " ".join(filter(None, (words, self.symbol, unit))) + way

    @property
    def base(self) -> str:
        """What one contact adds to it, on whatever way: `analytic.laws.Branch` has the formulas."""
        base = self.unloading or self.of or self.name
        return {"spot_conductance": "conductance", "nominal_separation": "load"}.get(base, base)

    def scale(self, x: Surface) -> float:
        """Return the factor of one asperity: ``factor E*^modulus R^radius sigma^exponent``, or per area."""
        if self.name in SEPARATIONS:
            return 1.0
        both = x.radius * x.sigma
        lengths = {0.5: (math.sqrt(both),), 1.0: (x.radius, x.sigma)}.get(self.radius, (both**self.radius,))
        factors = self.factor, x.E_star**self.modulus, *lengths, x.sigma ** (self.exponent - self.radius)
        return float(math.prod(factors)) / (x.nominal_area if self.of else 1.0)


def _by_name(*quantities: Quantity) -> dict[str, Quantity]:
    return {q.name: q for q in quantities}


# Powers of the approach, of the modulus and of the radius, and the number in the scale.
_LOAD, _SLOPE, _SPOT = (1.5, 1, 0.5, 4 / 3), (0.5, 1, 0.5, 2), (0.5, 0, 0.5, 4)
_AREA, _ONE, _RESISTANCE = (1.0, 0, 1.0, math.pi), (0.0, 0, 0.0, 1), (-0.5, 0, -0.5, 0.25)

QUANTITIES = _by_name(
    Quantity("load", "normal load", "N", *_LOAD, symbol="P"),
    Quantity("area", "real contact area", "m^2", *_AREA, words="real area", symbol="A"),
    Quantity("stiffness", "normal stiffness", "N/m", *_SLOPE, symbol="K"),
    Quantity("contacts", "number of contacts", "1", *_ONE, counts=True),
    Quantity("conductance", "contact conductance, times the resistivity rho", "m", *_SPOT, symbol="Cρ"),
)

PER_AREA = _by_name(
    Quantity("pressure", "normal load per nominal area", "Pa", *_LOAD, of="load"),
    Quantity("area_fraction", "real contact area per nominal area", "1", *_AREA, of="area"),
    Quantity(
        "contact_conductance", "contact conductance per nominal area", "S/m^2 or W/(m^2 K)", *_SPOT,
        of="conductance_si",
    ),
)  # fmt: skip

# What only other laws of contact than Hertz's tell apart.
LAW_QUANTITIES = _by_name(
    Quantity(
        "load_slope", "slope -dP/dd of the loads of the spots", "N/m", *_SLOPE, words="slope of the loads"
    ),
    Quantity("conductance_si", "contact conductance", "S or W/K", *_SPOT, words="conductance", symbol="C"),
    Quantity(
        "yielded", "number of contacts that have yielded", "1", *_ONE, counts=True, words="yielded contacts"
    ),
    Quantity(
        "spot_conductance", "contact conductance of the spots alone, times the resistivity rho", "m", *_SPOT
    ),
)


def _unloading(q: Quantity) -> Quantity:
    """Return the same on the way back from the lowest separation."""
    name, of = f"{q.name}_unloading", q.of and f"{q.of}_unloading"
    return replace(q, name=name, long_name=f"{q.long_name}, unloading", of=of, unloading=q.name)


UNLOADING = _by_name(
    *(_unloading(q) for q in (*QUANTITIES.values(), *LAW_QUANTITIES.values()) if q.name != "yielded")
)

# The separation of the bodies, where asperities press each other down.
_NOMINAL = Quantity("nominal_separation", "nominal separation d/sigma", "1", *_LOAD)
SEPARATIONS = _by_name(_NOMINAL, _unloading(_NOMINAL))

# Of a joint with gas in its gap, per nominal area: what the gas conducts, and spots and gas together.
_GAP, _ALL = (
    Quantity(
        f"{name}_conductance", f"conductance of the {what}, per nominal area", "W/(m^2 K)", *_SPOT,
        of="conductance_si", words=f"{name} conductance", symbol=f"h_{name[0]}",
    )
    for name, what in (("gap", "gas in the gap"), ("joint", "joint (spots beside gas)"))
)  # fmt: skip
JOINT = _by_name(_GAP, _unloading(_GAP), _ALL, _unloading(_ALL))

# What follows of conductances at a given load.
RESISTANCES = _by_name(
    Quantity("thermal_resistance", "thermal resistance of the joint", "K/W", *_RESISTANCE),
    Quantity("contact_resistance", "contact resistance", "ohm", *_RESISTANCE),
    Quantity(
        "specific_contact_resistance", "contact resistance of a unit area", "ohm m^2 or K m^2/W", *_RESISTANCE
    ),
)

# All that an ensemble can hold.
ALL_QUANTITIES = {**QUANTITIES, **LAW_QUANTITIES, **UNLOADING, **SEPARATIONS, **JOINT}

NOT_SUMS = (*JOINT, *RESISTANCES)  # over asperities
_KNOWN = {**ALL_QUANTITIES, **PER_AREA, **RESISTANCES}


def quantity_of(name: str) -> Quantity:
    """Return a quantity by its name.

    Raises
    ------
    KeyError
        If there is none of this name; the message lists them.
    """
    if name not in _KNOWN:
        raise KeyError(f"{name!r} is not a quantity; give one of {', '.join(_KNOWN)}")
    return _KNOWN[name]

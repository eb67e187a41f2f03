"""Every prefix and unit against a literal factor, in every spelling; and what is not a unit."""

import re
from dataclasses import replace

import pytest
from oracles.inside import (
    _FACTORS,
    EXAMPLES,
    RANGES,
    SURFACE_UNITS,
    parse,
    perhaps_other_units,
    surface_in_other_units,
)

import analytic
import mcgw

# One of each, in SI. Written out: a table that was computed would repeat the mistakes of the other.
LENGTHS = {
    "m": 1, "fm": 1e-15, "pm": 1e-12, "nm": 1e-9, "um": 1e-6, "µm": 1e-6, "mm": 1e-3, "cm": 1e-2, "km": 1e3,
    "in": 0.0254,
}  # fmt: skip
LITERAL = {
    "m": LENGTHS | {
        "micron": 1e-6, "Angstrom": 1e-10, "\u00c5": 1e-10, "\u212b": 1e-10, "inch": 0.0254, "mil": 2.54e-5,
        "uin": 2.54e-8, "µin": 2.54e-8,
    },
    "m^2": {f"{name}^2": factor**2 for name, factor in LENGTHS.items()},
    "1/m^2": {f"1/{name}^2": factor**-2 for name, factor in LENGTHS.items()},
    "1/m": {f"1/{name}": 1 / factor for name, factor in LENGTHS.items()},
    "Pa": {
        "Pa": 1, "nPa": 1e-9, "uPa": 1e-6, "µPa": 1e-6, "mPa": 1e-3, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9,
        "TPa": 1e12, "bar": 1e5, "mbar": 100, "kbar": 1e8, "psi": 6894.7572931683613, "atm": 101325,
        "ksi": 6894757.2931683613, "N/m^2": 1, "N/cm^2": 1e4, "N/mm^2": 1e6, "kgf/m^2": 9.80665,
        "kgf/cm^2": 98066.5, "kgf/mm^2": 9806650, "Torr": 133.32236842105263, "mTorr": 0.13332236842105263,
        "mmHg": 133.322387415,
    },
    "N": {
        "N": 1, "nN": 1e-9, "uN": 1e-6, "µN": 1e-6, "mN": 1e-3, "kN": 1e3, "MN": 1e6, "GN": 1e9,
        "kgf": 9.80665, "gf": 9.80665e-3, "lbf": 4.4482216152605,
    },
    "s": {"s": 1, "ms": 1e-3, "min": 60, "h": 3600},
    "J/m^2": {"J/m^2": 1, "mJ/m^2": 1e-3, "N/m": 1, "mN/m": 1e-3},
    "W/(m K)": {"W/(m K)": 1, "W/mK": 1, "W/m/K": 1, "mW/(m K)": 1e-3, "mW/mK": 1e-3, "W/(cm K)": 100},
    "ohm m": {
        "ohm m": 1, "nohmm": 1e-9, "uohmm": 1e-6, "µohmm": 1e-6, "mohmm": 1e-3, "ohm cm": 1e-2,
        "nohmcm": 1e-11, "uohmcm": 1e-8, "µohmcm": 1e-8, "mohmcm": 1e-5,
    },
    "K": {"K": 1},
    "1": {"%": 1e-2},
}  # fmt: skip


@pytest.mark.parametrize("kind", LITERAL)
def test_every_unit_is_its_literal_factor(kind):
    """And none is left out of the table, so that a new unit cannot come without its factor."""
    assert parse("2.5", kind) == 2.5
    for unit, factor in LITERAL[kind].items():
        assert parse(f"2.5e1 {unit}", kind) == pytest.approx(25 * factor, rel=5e-16), unit
        assert parse(f"1{unit.removeprefix('1')} ", kind) == pytest.approx(factor, rel=5e-16), unit
    there = {re.sub(r"[\^ ]", "", unit).replace("µ", "\N{GREEK SMALL LETTER MU}") for unit in LITERAL[kind]}
    assert _FACTORS[kind].keys() <= there | {"degC", "°C"}
    assert LITERAL.keys() == _FACTORS.keys() == EXAMPLES.keys()
    for example in EXAMPLES[kind].replace(" or ", ", ").split(", "):
        assert parse(example.partition(" (")[0], kind) > 0


def test_units_are_spelt_as_people_spell_them():
    one = {
        "m^2": ("m2", "m²", "m**2"), "1/m^2": ("/m^2", "m^-2", "m⁻²", "m**-2", "/m²"), "1/m": ("/m", "m^-1"),
        "W/(m K)": ("W/(m·K)", "W/(m*K)", "W/(mK)"), "ohm m": ("ohmm", "Ω m", "Ωm"), "J/m^2": ("J/m2",),
    }  # fmt: skip
    for kind, spelt in one.items():
        assert {unit: parse(f"1 {unit}", kind) for unit in spelt} == dict.fromkeys(spelt, 1.0)


def test_temperatures_begin_where_their_scale_does():
    known = {"20 degC": 293.15, "-40 °C": 233.15, "-40\u2103": 233.15, "293.15 K": 293.15, "0 degC": 273.15}
    assert {text: parse(text, "K") for text in known} == known
    with pytest.raises(ValueError, match="such as 20 degC, "):
        parse("-274 degC", "K")


@pytest.mark.parametrize("number", ["1.37", "0.1", "78.6", "9.9999999999999"])
def test_a_number_with_a_prefix_is_the_literal_one(number):
    """Rounded once: text with a unit and a float in SI give the same bits of the ensemble."""
    for unit, kind, power in ((" um", "m", -6), (" GPa", "Pa", 9), ("/mm^2", "1/m^2", 6), (" %", "1", -2)):
        assert parse(f"{number}{unit}", kind) == float(f"{number}e{power}")


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("1 foo", "m"), ("1 mm^3", "m^2"), ("1 mm^2", "1/m^2"), ("1 N", "Pa"), ("1 pa", "Pa"), ("1 KN", "N"),
        ("-1 um", "m"), ("0 um", "m"), ("nan", "m"), ("inf m", "m"), ("", "m"), ("um", "m"), ("1,5 um", "m"),
        ("1 2 um", "m"), ("1e400 m", "m"), ("1e-400 m", "m"), ("1e9999999 m", "m"), ("1/0", "1"),
        ("9" * 5000, "m"), ("1" + " " * 5000 + "x", "m"), ("1" + " " * 5000 + "m", "m"), ("1 %", "m"),
    ],
)  # fmt: skip
def test_what_is_no_quantity_is_refused_in_one_line(text, kind):
    with pytest.raises(ValueError, match="give a number > 0 with its unit, such as") as caught:
        parse(text, kind, "--width")
    line = str(caught.value)
    assert "\n" not in line
    assert len(line) < 250
    assert line.startswith(f"--width = '{text[:3]}")
    assert EXAMPLES[kind] in line


SI = {"sigma": 1.37e-6, "radius": 13e-6, "eta": 3e8, "nominal_area": 1e-4, "E_star": 78.6e9}


def test_a_surface_of_texts_is_that_of_floats():
    texts = ("1.37 um", "13 µm", "300/mm^2", "1 cm²", "78.6 GPa")
    assert mcgw.Surface(*texts) == mcgw.Surface(**SI) == analytic.Surface(**SI)


# --- units that are doubted ---------------------------------------------------------------------------

SURFACE = analytic.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e11)


ENDS = {  # from atoms to faults in rock, from gels to diamond
    "sigma": (1e-10, 1e-3), "radius": (1e-10, 0.1), "eta": (1e4, 1e19), "nominal_area": (1e-17, 10.0),
    "E_star": (1e3, 2e12),
}  # fmt: skip


@pytest.mark.parametrize("key", ENDS)
def test_values_are_asked_about_from_the_end_of_their_range_on(key):
    assert ENDS.keys() == RANGES.keys() == SURFACE_UNITS.keys()
    low, high = ENDS[key]
    for value, doubts in ((low, 0), (0.995 * low, 1), (high, 0), (1.005 * high, 1)):
        told = surface_in_other_units(replace(SURFACE, **{key: value}))
        assert len(told) == doubts, value
        assert all(("is less" in line or "is softer" in line) == (value < low) for line in told)


def test_separations_in_metres_are_asked_about():
    scene = mcgw.Scene(surface=SURFACE, separations=(0.0, 1e-6, 2e-6))
    (line,) = perhaps_other_units(scene)
    assert "did you mean 2e-06 m = 2 sigma?" in line
    for h, doubts in (((0.0,), 0), ((1e-6, 1.0), 0), ((0.0, 1.005e-3), 0), ((0.0, 0.995e-3), 1)):
        assert len(perhaps_other_units(scene.replace(separations=h))) == doubts, h


@pytest.mark.parametrize(
    ("key", "given", "meant"),
    [
        ("sigma", "1.37 mm", "1.37 um = 1.37e-06"),
        ("radius", 1300.0, "1300 um = 0.0013"),
        ("E_star", 78.6, "78.6 GPa = 7.86e+10"),
        ("eta", 300.0, "300/mm^2 = 3e+08"),
        ("nominal_area", 100.0, "100 mm^2 = 0.0001"),
    ],
)
def test_what_was_perhaps_meant_has_the_digits_as_people_write_them(key, given, meant):
    with pytest.warns(UserWarning, match=rf"surface\.{key} = .* did you mean {re.escape(meant)}\?"):
        surface = mcgw.Surface(**(SI | {key: given}))
    with pytest.warns(UserWarning, match=rf"surface\.{key} = "):
        mcgw.Scene(surface, separations=1.0, ensemble=mcgw.Sampling(n_asperities=10))

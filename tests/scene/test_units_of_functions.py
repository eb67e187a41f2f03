"""Gradings and laws in other units: worked in where a file names them, refused or doubted where not."""

import warnings

import numpy as np
import pytest
from oracles.inside import perhaps_other_units
from oracles.scenes import scene_by
from scipy.stats import norm

import analytic
import mcgw
from mcgw.cli import main

SURFACE = mcgw.Surface("2 um", "10 um", "1000/mm^2", "1 mm^2", "72 GPa")
NO_RATIO = (
    r"^grading: E\*\(s\)/E\* is \S+( to \S+)? at all heights that touch; give a ratio near 1: moduli over "
    r"E_star = 7\.2e\+10 Pa, of s = z/sigma, sigma = 2e-06 m"
)
LIMITS = {"limits": (1.0,), "critical": 0.05}
AREA = (lambda u: u**2, lambda u: 0.93 * u**2.272)
LOAD = (lambda u: u**3, lambda u: 1.03 * u**2.85)
NEWTON = 4 / 3 * 72e9 * 1e-5**0.5 * 1e-7**1.5
METRES = np.pi * 1e-5 * 1e-7


def scene(**given):
    return scene_by(SURFACE, separations=[0.0, 1.0], n_surfaces=3, seed=1, **given)


def refused(match, **given):
    with pytest.raises(mcgw.SceneError, match=match) as error:
        scene(**given)
    assert len(error.value.problems) == 1


GRADINGS = [
    lambda s: 80e9 * (1 + 0.1 * s),  # Pa
    lambda s: 80e3 * (1 + 0.1 * s),
    lambda s: 80 * (1 + 0.1 * s),
    lambda z: 1 + 0.1 * z / 1e-6,  # of metres
    lambda s: 1 / (80e9 * (1 + 0.1 * s)),
    lambda s: 0 * s,
    lambda s: 1e30 + s,
]


@pytest.mark.parametrize("function", GRADINGS)
def test_a_function_is_no_ratio(function):
    for negative in ("error", "clip"):
        for grading in (function, mcgw.Custom(function, (0.5,))):
            refused(f"{NO_RATIO}; if it is meant so, give mcgw.Custom\\(function, checked=False\\)$",
                    grading=grading, negative=negative)  # fmt: skip


@pytest.mark.parametrize("factor", [1e9, 1.0, 1e-20])
def test_series_and_tables_are_no_ratios(factor):
    """A table of pascals or gigapascals, and series of a file; with a way out that the file can say."""
    refused(f"{NO_RATIO}; a file names", grading=mcgw.Table([-1.0, 6.0], [80 * factor, 90 * factor]))
    series = {"edges": [-50.0, 50.0], "coefficients": [[80 * factor]]}
    refused(f"{NO_RATIO}; .* give checked = false$", grading=analytic.PiecewiseSeries(**series))
    refused(NO_RATIO, grading={"law": "series", **series})
    assert not scene(grading={"law": "series", **series, "checked": False}).grading.checked


@pytest.mark.parametrize(
    "function",
    [
        lambda s: np.exp(3 * s),
        lambda s: 900.0 + 0 * s,  # far, but not what another unit gives
        lambda s: 0.002 + 0 * s,
        lambda s: np.where(s > 1, 1e6, 1.0),
        lambda s: s - 0.9,
        lambda s: 72.0 * np.exp(-s),
    ],
)
def test_ratios_are_taken(function):
    assert scene(grading=function, negative="clip").grading.function is function


@pytest.mark.parametrize(
    ("load", "area", "line"),
    [
        ((lambda u: NEWTON * u**3, lambda u: NEWTON * 1.03 * u**2.85), AREA,
         r"its load is \S+ to \S+ of Hertz's at all penetrations that occur; divide it by \(4/3\) E\*\(s\) "
         r"sqrt\(R\) delta_c\^1\.5 = 0\.0096 N at E\*"),
        ((lambda u: 1e6 * u**3, lambda u: 1e6 * u**2.85), AREA, r"its load is \S+ to \S+ of Hertz's"),
        (LOAD, (lambda u: METRES * u**2, lambda u: METRES * 0.93 * u**2.272),
         r"its area is \S+ to \S+ of Hertz's .* divide it by pi R delta_c = 3\.142e-12 m\^2 at E\*"),
    ],
    ids=["newtons", "far", "square metres"],
)  # fmt: skip
def test_a_law_in_other_units(load, area, line):
    way_out = "; if it is meant so, give checked=False$"
    refused(rf"contact\.law = CustomLaw: {line}.*{way_out}", law=mcgw.CustomLaw(load, area, **LIMITS))
    meant = scene(law=mcgw.CustomLaw(load, area, **LIMITS, checked=False))
    again = mcgw.scene_from(mcgw.scene_text(meant))
    assert not again.law.checked
    text = mcgw.scene_text(meant).replace("checked = false\n", "")
    with pytest.raises(mcgw.SceneError, match="of Hertz's at all penetrations"):
        mcgw.scene_from(text)


def test_a_law_that_is_right_on_a_graded_surface():
    """The critical penetration of a stiff asperity is smaller, its ratio to Hertz's the same or less."""
    law = mcgw.CustomLaw(LOAD, AREA, **LIMITS)
    for grading in (analytic.Exponential(2.0), lambda s: 1 + 0.3 * np.tanh(s)):
        assert scene(law=law, grading=grading).law.checked
    line = r"contact\.law = CustomLaw: E\*\(s\)/E\* reaches \S+ at s = \S+, where no series of the law is"
    for steep in (2.0, 12.0):
        refused(line, law=law, grading=mcgw.Custom(lambda s, k=steep: np.exp(k * s), checked=False))


def test_nothing_that_touches_is_looked_at():
    heights = analytic.HeightTable.of(np.linspace(0.0, 1.0, 50))
    mcgw.Scene(SURFACE, separations=[9.0], heights=heights, grading=GRADINGS[0])


# --- tables ---

SIGMA, E_STAR = 1.37e-6, 78.6e9
Z, E = (-3.0, 0.5, 2.5, 7.0), (61.2, 70.0, 99.5, 138.25)  # um, GPa
OF_TABLE = {"sigma": SIGMA, "radius": 13e-6, "eta": 3e8, "nominal_area": 1e-6, "E_star": E_STAR}


def scene_of(folder, header, cells):
    (folder / "moduli.csv").write_text("\n".join([header, *(",".join(row) for row in cells)]) + "\n")
    surface = "\n".join(f"{key} = {value!r}" for key, value in OF_TABLE.items())
    path = folder / "graded.toml"
    path.write_text(
        f'[surface]\n{surface}\n[grading]\nlaw = "table"\nfile = "moduli.csv"\n'
        "[contact]\nseparations = [0.0, 2.0]\n[ensemble]\nn_surfaces = 2\nseed = 1\n"
    )
    return path


BARE = [(f"{z:g}", f"{e:g}") for z, e in zip(Z, E, strict=True)]
SPELT = {
    "z (um),E_star (GPa)": BARE,
    "z [µm], E_star [GPa]": BARE,
    "z/um,E_star / GPa": BARE,
    "z um,E_star GPa": BARE,
    "z,E_star": [(f"{z:g} um", f"{e:g} GPa") for z, e in zip(Z, E, strict=True)],
    "z (um),E_star (MPa)": [(a, f"{b} GPa") for a, b in BARE],  # a cell's own unit counts
    "\ufeffz (um) , E_star (GPa)\r\n\r": BARE[::-1],  # spaces, empty lines, another order
    "E_star (GPa),z (um)": [cells[::-1] for cells in BARE],
    "z (um),ratio (%)": [(a, repr(float(b) / 78.6 * 100)) for a, b in BARE],
}


@pytest.mark.parametrize("header", SPELT)
def test_units_in_header_or_cells_are_worked_in(tmp_path, header):
    table = mcgw.load_scene(scene_of(tmp_path, header, SPELT[header])).grading
    assert np.allclose(table.s, np.array(Z) * 1e-6 / SIGMA, rtol=1e-14, atol=0)
    assert np.allclose(table.ratio, np.array(E) * 1e9 / E_STAR, rtol=1e-14, atol=0)


@pytest.mark.parametrize(
    ("header", "cells", "match"),
    [
        ("z (GPa),E_star (um)", BARE, "first line"),
        *(
            (header, BARE, "first line")
            for header in ("s (um),ratio", "height,ratio", "s,z", "s", "0,0.5", "", "s,ratio,note")
        ),
        *(
            ("s,ratio", [("0", "0.5"), row], "every line")
            for row in (("1",), ("1", "2", "3"), ("1", "stiff"), ("1", "nan"), ("1,0", "2"))
        ),
        ("z,E_star", [("1 um", "2 um"), ("2 um", "3 um")], "every line"),
        ("z (um),E_star (GPa)", [("1", "2 m"), ("2", "3")], "every line"),
        *((header, BARE, "E_star = 7.86e") for header in ("z,E_star", "s,ratio")),  # no um, no GPa
    ],
)
def test_another_unit_is_refused_in_one_line(tmp_path, capsys, header, cells, match):
    path = scene_of(tmp_path, header, cells)
    with pytest.raises(mcgw.SceneError, match=f"^grading.* {match}") as error:
        mcgw.load_scene(path)
    assert main(["show", "--plan", str(path)]) == 2
    assert capsys.readouterr().err.count(error.value.problems[0]) == len(error.value.problems) == 1


def test_heights_in_other_units_are_doubted_by_every_door(tmp_path, capsys):
    path = scene_of(tmp_path, "z,ratio", [(a, repr(float(b) / 78.6)) for a, b in BARE])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = mcgw.load_scene(path)
        mcgw.Scene(found.surface, separations=[0.0, 2.0], grading=found.grading)
    assert sum("s = 5.11e+06 sigma" in str(each.message) for each in caught) == 2
    assert main(["show", "--plan", str(path)]) == 0
    assert capsys.readouterr().err.count("s = 5.11e+06 sigma") == 1


def doubts_of(s, ratio, separations=0.0):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        grading = mcgw.Table(s, ratio)
        return perhaps_other_units(
            mcgw.Scene(mcgw.Surface(**OF_TABLE), separations=separations, grading=grading)
        )


@pytest.mark.parametrize(
    ("ends", "separations", "doubt"),
    [
        ((-1.0, 3.9), [0.0, 4.0], "all contacts at d/sigma = 4 are outside the table"),
        ((-1.0, 1.0), [0.0, 1.0], "32% of the contacts at d/sigma = 0 are outside"),  # erfc(1/sqrt 2)
        ((0.5, 4.0), [0.0], "38% of the contacts at d/sigma = 0 are outside"),  # erf(0.5/sqrt 2)
    ],
)
def test_a_table_that_ends_short_of_the_contacts_is_doubted(ends, separations, doubt):
    (found,) = doubts_of(ends, [1.0, 2.0], separations)
    assert doubt in found


@pytest.mark.parametrize(
    ("s", "ratio"),
    [
        (lambda f: (-4.0, 50 * f), lambda f: (1.0, 2.0)),
        (lambda f: (-50 * f, 9.0), lambda f: (1.0, 2.0)),
        (lambda f: (-4.0, norm.isf(0.05 * f)), lambda f: (1.0, 2.0)),  # 10 % of the contacts at d = 0
    ],
)
def test_tables_are_doubted_from_a_limit_on(s, ratio):
    for f, doubts in ((0.995, 0), (1.005, 1)):
        assert len(doubts_of(s(f), ratio(f))) == doubts

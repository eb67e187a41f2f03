"""Gradings and laws in other units: worked in where a file names them, refused or doubted where not."""

import numpy as np
import pytest
from oracles.inside import perhaps_other_units
from oracles.scenes import scene_by
from scipy.stats import norm

import analytic
import mcgw
from mcgw.cli import main

SIGMA, E_STAR = 1.37e-6, 78.6e9
SURFACE = mcgw.Surface(SIGMA, 13e-6, 3e8, 1e-6, E_STAR)
NO_RATIO = (
    r"^grading: E\*\(s\)/E\* is \S+( to \S+)? at all heights that touch; give a ratio near 1: moduli over "
    r"E_star = 7\.86e\+10 Pa, of s = z/sigma, sigma = 1\.37e-06 m"
)
LIMITS = {"limits": (1.0,), "critical": 0.05}
AREA = (lambda u: u**2, lambda u: 0.93 * u**2.272)
LOAD = (lambda u: u**3, lambda u: 1.03 * u**2.85)
NEWTON = 4 / 3 * E_STAR * 13e-6**0.5 * (0.05 * SIGMA) ** 1.5  # load and area at first yield
METRES = np.pi * 13e-6 * 0.05 * SIGMA


def scene(**given):
    return scene_by(SURFACE, **{"separations": [0.0, 1.0], "n_surfaces": 3, "seed": 1} | given)


def refused(match, **given):
    with pytest.raises(mcgw.SceneError, match=match) as error:
        scene(**given)
    assert len(error.value.problems) == 1


GRADINGS = [
    lambda s: 80e9 * (1 + 0.1 * s),  # Pa
    lambda s: 80 * (1 + 0.1 * s),
    lambda z: 1 + 0.1 * z / 1e-6,  # of metres
    lambda s: 1 / (80e9 * (1 + 0.1 * s)),
    lambda s: 0 * s,
]


@pytest.mark.parametrize("function", GRADINGS)
def test_a_function_is_no_ratio(function):
    way_out = r"; if it is meant so, give mcgw.Custom\(function, checked=False\)$"
    for grading, negative in ((function, "error"), (mcgw.Custom(function, (0.5,)), "clip")):
        refused(f"{NO_RATIO}{way_out}", grading=grading, negative=negative)


def test_series_and_tables_are_no_ratios():
    """With a way out that a file can say; where nothing touches nothing is looked at."""
    refused(f"{NO_RATIO}; a file names", grading=mcgw.Table([-1.0, 6.0], [80e9, 90e9]))
    series = {"law": "series", "edges": [-50.0, 50.0], "coefficients": [[80.0]]}
    refused(f"{NO_RATIO}; .* give checked = false$", grading=series)
    assert not scene(grading=series | {"checked": False}).grading.checked
    heights = analytic.HeightTable.of(np.linspace(0.0, 1.0, 50))
    scene(separations=[9.0], heights=heights, grading=GRADINGS[0])


RATIOS = [
    lambda s: 900.0 + 0 * s,  # far, but not what another unit gives
    lambda s: 0.002 + 0 * s,
    lambda s: np.where(s > 1, 1e6, 1.0),
    lambda s: 72.0 * np.exp(-s),
]


@pytest.mark.parametrize("function", RATIOS)
def test_ratios_are_taken(function):
    assert scene(grading=function, negative="clip").grading.function is function


@pytest.mark.parametrize("what", ["load", "area"])
def test_a_law_in_other_units(what):
    """In newtons and square metres, to be divided by what Hertz has at first yield."""
    load = (lambda u: NEWTON * u**3, lambda u: NEWTON * 1.03 * u**2.85), AREA
    area = LOAD, (lambda u: METRES * u**2, lambda u: METRES * 0.93 * u**2.272)
    given, number = {"load": (load, NEWTON), "area": (area, METRES)}[what]
    refused(
        rf"contact\.law = CustomLaw: its {what} is \S+ to \S+ of Hertz's at all penetrations that occur; .*"
        rf" = {number:.4g} .* at E\*.*; if it is meant so, give checked=False$",
        law=mcgw.CustomLaw(*given, **LIMITS),
    )
    meant = scene(law=mcgw.CustomLaw(*given, **LIMITS, checked=False))
    assert not mcgw.scene_from(mcgw.scene_text(meant)).law.checked


def test_a_law_that_is_right_on_a_graded_surface():
    """The critical penetration of a stiff asperity is smaller, its ratio to Hertz's the same or less."""
    law = mcgw.CustomLaw(LOAD, AREA, **LIMITS)
    for grading in (analytic.Exponential(2.0), lambda s: 1 + 0.3 * np.tanh(s)):
        assert scene(law=law, grading=grading).law.checked
    line = r"contact\.law = CustomLaw: E\*\(s\)/E\* reaches \S+ at s = \S+, where no series of the law is"
    refused(line, law=law, grading=mcgw.Custom(lambda s: np.exp(40 * s), checked=False))


# --- tables ---

Z, E = (-3.0, 0.5, 2.5, 7.0), (61.2, 70.0, 99.5, 138.25)  # um, GPa


def scene_of(folder, header, cells):
    (folder / "moduli.csv").write_text("\n".join([header, *(",".join(row) for row in cells)]) + "\n")
    path = folder / "graded.toml"
    written = mcgw.scene_text(scene(separations=[0.0, 2.0]))
    path.write_text(written.replace('"homogeneous"', '"table"\nfile = "moduli.csv"'))
    return path


BARE = [(f"{z:g}", f"{e:g}") for z, e in zip(Z, E, strict=True)]
SPELT = {
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


HEADERS = ("z (GPa),E_star (um)", "s (um),ratio", "s,z", "s", "0,0.5", "")
ROWS = (("1",), ("1", "2", "3"), ("1", "stiff"), ("1", "nan"))
WRONG = [
    *((header, BARE, "first line") for header in HEADERS),
    ("s,ratio,note", BARE, "row 1 below"),
    *(("s,ratio", [("0", "0.5"), row], "row [12] below") for row in ROWS),
    ("z (um),E_star (GPa)", [("1", "2 m"), ("2", "3")], "row [12] below"),
    *((header, BARE, r"E_star = 7\.86e") for header in ("z,E_star", "s,ratio")),  # no um, no GPa
]


@pytest.mark.parametrize(("header", "cells", "match"), WRONG)
def test_another_unit_is_refused_in_one_line(tmp_path, header, cells, match):
    with pytest.raises(mcgw.SceneError, match=f"^grading.* {match}") as error:
        mcgw.load_scene(scene_of(tmp_path, header, cells))
    assert len(error.value.problems) == 1


def test_heights_in_other_units_are_doubted_by_every_door(tmp_path, capsys):
    path = scene_of(tmp_path, "z,ratio", [(a, repr(float(b) / 78.6)) for a, b in BARE])
    doubt = r"s = 5\.11e\+06 sigma"
    with pytest.warns(UserWarning, match=doubt):
        found = mcgw.load_scene(path)
    with pytest.warns(UserWarning, match=doubt):
        mcgw.Scene(found.surface, separations=[0.0, 2.0], grading=found.grading)
    assert main(["show", "--plan", str(path)]) == 0
    assert capsys.readouterr().err.count("s = 5.11e+06 sigma") == 1


SHORT = [  # ends of a table, separations, and what is doubted
    ((-1.0, 3.9), [0.0, 4.0], "all contacts at d/sigma = 4 are outside the table"),
    ((-1.0, 1.0), [0.0, 1.0], "32% of the contacts at d/sigma = 0 are outside"),  # erfc(1/sqrt 2)
    ((0.5, 4.0), [0.0], "38% of the contacts at d/sigma = 0 are outside"),  # erf(0.5/sqrt 2)
    ((-4.0, norm.isf(0.05 * 1.005)), 0.0, "10% of the contacts"),
    ((-4.0, norm.isf(0.05 * 0.995)), 0.0, None),
    *(((-4.0, end), 0.0, doubt) for end, doubt in ((50.25, "s = 50.2 sigma"), (49.75, None))),
    *(((end, 9.0), 0.0, doubt) for end, doubt in ((-50.25, "s = -50.2 sigma"), (-49.75, None))),
]


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize(("ends", "separations", "doubt"), SHORT)
def test_a_table_that_ends_short_of_the_contacts_or_far_beyond_is_doubted(ends, separations, doubt):
    found = perhaps_other_units(scene(separations=separations, grading=mcgw.Table(ends, (1.0, 2.0))))
    assert len(found) == (doubt is not None)
    assert all(doubt in line for line in found)

"""Moduli and heights of a grading in other units: worked in where a file names them, doubted where not."""

import warnings

import numpy as np
import pytest
from oracles.inside import perhaps_other_units
from scipy.stats import norm

import mcgw
from mcgw.cli import main

SIGMA, E_STAR = 1.37e-6, 78.6e9
Z, E = (-3.0, 0.5, 2.5, 7.0), (61.2, 70.0, 99.5, 138.25)  # um, GPa
SURFACE = {"sigma": SIGMA, "radius": 13e-6, "eta": 3e8, "nominal_area": 1e-6, "E_star": E_STAR}


def scene_of(folder, header, cells, more=""):
    (folder / "moduli.csv").write_text("\n".join([header, *(",".join(row) for row in cells)]) + "\n")
    surface = "\n".join(f"{key} = {value!r}" for key, value in SURFACE.items())
    path = folder / "graded.toml"
    path.write_text(
        f'[surface]\n{surface}\n[grading]\nlaw = "table"\nfile = "moduli.csv"\n'
        f"[contact]\nseparations = [0.0, 2.0]\n[ensemble]\nn_surfaces = 2\nseed = 1\n{more}"
    )
    return path


BARE = [(f"{z:g}", f"{e:g}") for z, e in zip(Z, E, strict=True)]
SPELT = {
    "z (um),E_star (GPa)": BARE,
    "z [µm], E_star [GPa]": BARE,
    "z/um,E_star / GPa": BARE,
    "z um,E_star GPa": BARE,
    "z (mm),E_star (MPa)": [(repr(z * 1e-3), repr(e * 1e3)) for z, e in zip(Z, E, strict=True)],
    "z,E_star": [(f"{z:g} um", f"{e:g} GPa") for z, e in zip(Z, E, strict=True)],
    "z (um),E_star (MPa)": [(a, f"{b} GPa") for a, b in BARE],  # a cell's own unit counts
    "z (um),ratio (%)": [(a, repr(float(b) / 78.6 * 100)) for a, b in BARE],
}


@pytest.mark.parametrize("header", SPELT)
def test_units_in_header_or_cells_are_worked_in(tmp_path, header):
    table = mcgw.load_scene(scene_of(tmp_path, header, SPELT[header])).grading
    assert np.allclose(table.s, np.array(Z) * 1e-6 / SIGMA, rtol=1e-14, atol=0)
    assert np.allclose(table.ratio, np.array(E) * 1e9 / E_STAR, rtol=1e-14, atol=0)


@pytest.mark.parametrize(
    ("header", "cells"),
    [
        ("z (GPa),E_star (um)", BARE),
        ("s (um),ratio", BARE),
        ("z (um),E_star (GPx)", BARE),
        ("z,E_star", [("1 um", "2 um"), ("2 um", "3 um")]),
        ("z (um),E_star (GPa)", [("1", "2 m"), ("2", "3")]),
    ],
)
def test_a_unit_of_another_kind_is_refused(tmp_path, header, cells):
    with pytest.raises(mcgw.SceneError, match=r"grading\.file .*(first line|every line)") as error:
        mcgw.load_scene(scene_of(tmp_path, header, cells))
    assert len(error.value.problems) == 1


REFUSED = {  # as the header says nothing of um and GPa
    "z,E_star": "moduli are perhaps in GPa: say so in the header of the file, E_star (GPa)",
    "s,E_star": "moduli are perhaps in GPa: say so in the header of the file, E_star (GPa)",
    "z,ratio": "divide by E_star = 78.6 GPa",
    "s,ratio": "divide by E_star = 78.6 GPa",
}


@pytest.mark.parametrize("header", REFUSED)
def test_moduli_in_other_units_are_refused_by_every_door(tmp_path, capsys, header):
    path = scene_of(tmp_path, header, BARE)
    with pytest.raises(mcgw.SceneError) as error:
        mcgw.load_scene(path)
    (line,) = error.value.problems
    assert line.startswith("grading: E*(s)/E* is ")
    assert line.endswith(f" at all heights that touch; {REFUSED[header]}")
    assert main(["show", "--plan", str(path)]) == 2
    assert capsys.readouterr().err.count(REFUSED[header]) == 1


def test_heights_in_other_units_are_doubted_by_every_door(tmp_path, capsys):
    path = scene_of(tmp_path, "z,ratio", [(a, repr(float(b) / 78.6)) for a, b in BARE])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        scene = mcgw.load_scene(path)
        mcgw.Scene(scene.surface, separations=[0.0, 2.0], grading=scene.grading)
    assert sum("s = 5.11e+06 sigma" in str(each.message) for each in caught) == 2
    assert main(["show", "--plan", str(path)]) == 0
    assert capsys.readouterr().err.count("s = 5.11e+06 sigma") == 1


@pytest.mark.parametrize(
    ("ends", "separations", "doubt"),
    [
        ((-1.0, 3.9), [0.0, 4.0], "all contacts at d/sigma = 4 are outside the table"),
        ((-1.0, 1.0), [0.0, 1.0], "32% of the contacts at d/sigma = 0 are outside"),  # erfc(1/sqrt 2)
        ((0.5, 4.0), [0.0], "38% of the contacts at d/sigma = 0 are outside"),  # erf(0.5/sqrt 2)
    ],
)
def test_a_table_that_ends_short_of_the_contacts_is_doubted(ends, separations, doubt):
    surface = mcgw.Surface(**SURFACE)
    scene = mcgw.Scene(surface, separations=separations, grading=mcgw.Table(ends, [1.0, 2.0]))
    (found,) = perhaps_other_units(scene)
    assert doubt in found


@pytest.mark.parametrize(
    ("s", "ratio"),
    [
        (lambda f: (-4.0, 50 * f), lambda f: (1.0, 2.0)),
        (lambda f: (-50 * f, 9.0), lambda f: (1.0, 2.0)),
        (lambda f: (-4.0, 9.0), lambda f: (1.0, 50 * f)),
        (lambda f: (-4.0, 9.0), lambda f: (1e-3 / f, 1.0)),
        (lambda f: (-4.0, norm.isf(0.05 * f)), lambda f: (1.0, 2.0)),  # 10 % of the contacts at d = 0
    ],
)
def test_tables_are_doubted_from_a_limit_on(s, ratio):
    for f, doubts in ((0.995, 0), (1.005, 1)):
        grading = mcgw.Table(s(f), ratio(f))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            scene = mcgw.Scene(mcgw.Surface(**SURFACE), separations=0.0, grading=grading)
        assert len(perhaps_other_units(scene)) == doubts


def test_a_surface_in_another_unit_is_asked_about_in_python():
    with pytest.warns(UserWarning, match=r"surface\.sigma = 1\.37: .* did you mean 1\.37 um"):
        surface = mcgw.Surface(**(SURFACE | {"sigma": 1.37}))
    with pytest.warns(UserWarning, match=r"surface\.sigma = 1\.37: "):
        mcgw.Scene(surface, separations=1.0, ensemble=mcgw.Sampling(n_asperities=10))


@pytest.mark.parametrize(
    ("key", "given", "meant"),
    [
        ("sigma", "1.37 mm", "1.37 um = 1.37e-06"),
        ("sigma", 1.37, "1.37 um = 1.37e-06"),
        ("radius", "13000 m", "13 um = 1.3e-05"),
        ("E_star", "78600 GPa", "78.6 GPa = 7.86e+10"),
        ("E_star", 78.6, "78.6 GPa = 7.86e+10"),
        ("eta", 300.0, "300/mm^2 = 3e+08"),
        ("nominal_area", 100.0, "100 mm^2 = 0.0001"),
    ],
)
def test_what_was_perhaps_meant_has_the_digits_as_people_write_them(key, given, meant):
    with pytest.warns(UserWarning, match=rf"surface\.{key} = ") as caught:
        mcgw.Surface(**(SURFACE | {key: given}))
    assert f"did you mean {meant}?" in str(caught[0].message)

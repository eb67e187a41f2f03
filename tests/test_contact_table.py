"""A table of contact as JSON: by its schema, against theory, there and back, and refused where it is none."""

import json

import jsonschema
import numpy as np
import pytest

import mcgw
from mcgw.cli import main
from mcgw.exports.contact_table import SCHEMA

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
SURFACES = 400
SCENE = mcgw.Scene(
    SURFACE, separations=[0.0, 1.5], n_surfaces=SURFACES, seed=4, film=mcgw.Film(conductivities=(150.0, 16.0))
)


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    (found,) = mcgw.export(SCENE, tmp_path_factory.mktemp("table") / "a.json", to="json", points=11)
    return found


def test_it_keeps_its_schema_and_comes_back(path, tmp_path):
    whole = json.loads(path.read_text())
    jsonschema.validate(whole, json.loads(SCHEMA.read_text()))
    assert mcgw.scene_from(whole["provenance"]["scene"]).surface == SURFACE
    table = mcgw.ContactTable.read(path)
    table.write(tmp_path / "b.json")
    assert (tmp_path / "b.json").read_bytes() == path.read_bytes()


def test_its_law_is_that_of_theory(path):
    """At its rows and between them, within five standard errors and what interpolation leaves."""
    table = mcgw.ContactTable.read(path)
    error = np.sqrt(np.diag(table.covariance) / SURFACES) / table.pressure
    for gap in (table.gap, (table.gap[1:] + table.gap[:-1]) / 2):
        h, within = gap / SURFACE.sigma, 5 * error.max() + 1e-3
        for name, exact, area in (
            ("pressure", "pressure", 1.0), ("area", "area_fraction", 1.0),
            ("conductance", "conductance_si", SURFACE.nominal_area),
        ):  # fmt: skip
            wanted = SCENE.theory.mean(exact, h) / area
            assert np.abs(table(name, gap) / wanted - 1).max() < within, name
    assert within < 0.1
    assert table("pressure", table.gap_at(2e7)) == pytest.approx(2e7, rel=1e-9)


def test_gas_in_the_gap_conducts_too(path, tmp_path):
    """What it adds is Yovanovich's integral at each row's own gap."""
    gas = {"conductivity": 0.026, "jump": 3e-7}
    scene = SCENE.replace(joint=mcgw.Joint(gas, rms=1.5e-6))
    (file,) = mcgw.export(scene, tmp_path / "a.json", to="json", points=11)
    joint, spots = mcgw.ContactTable.read(file), mcgw.ContactTable.read(path)
    added = scene.joint.gap(SURFACE, scene.heights)(joint.gap / SURFACE.sigma)
    np.testing.assert_allclose(joint.conductance - spots.conductance, added, rtol=1e-9)


def test_its_covariance_is_that_of_theory(path):
    """Of a variance from 400 surfaces the standard error is 7 %, of light loads more."""
    table = mcgw.ContactTable.read(path)
    exact = SCENE.theory.covariance(["load"], table.gap / SURFACE.sigma)[0, :, 0, :]
    found = table.covariance * SURFACE.nominal_area**2
    heavy = slice(0, 5)
    assert np.abs(found / exact - 1)[heavy, heavy].max() < 0.4


def test_one_surface_without_a_film_has_neither_covariance_nor_conductance(tmp_path):
    scene = mcgw.Scene(SURFACE, separations=[0.0, 1.0], n_surfaces=1, seed=1)
    (file,) = mcgw.export(scene, tmp_path / "a.json", to="json", points=3)
    table = mcgw.ContactTable.read(file)
    assert table.covariance is None
    with pytest.raises(ValueError, match="no such column"):
        table("conductance", 1e-6)
    with pytest.raises(ValueError, match="the table has"):
        table("pressure", 1.0)
    low, high = table.gap[[0, -1]]
    for outside in (low - 1e-6 * high, 1.000001 * high):
        with pytest.raises(ValueError, match="the table has"):
            table("pressure", [low, outside])
    ends = low - 1e-13 * high, high * (1 + 1e-13)  # but not for rounding
    np.testing.assert_allclose(table("pressure", ends), table.pressure[[0, -1]], rtol=1e-9)
    assert table.gap_at(table.pressure[0]) == pytest.approx(low, abs=1e-9 * high)
    assert table.gap_at(table.pressure[-1]) == pytest.approx(high, rel=1e-9)
    with pytest.raises(ValueError, match="the table has"):
        table.gap_at(1e12)


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("format", "other", "format 'other'"), ("gap", [1.0], "two numbers"), ("gap", None, "not a contact"),
        ("pressure", [1.0] * 11, "decreasing pressures"), ("area", [-1.0] * 11, "> 0"),
        ("covariance", [[1.0]], "square"), ("validity", ..., "it has no 'validity'"),
    ],
)  # fmt: skip
def test_another_file_is_refused(path, tmp_path, key, value, said):
    whole = json.loads(path.read_text())
    if value is ...:
        del whole[key]
    else:
        whole[key] = value
    wrong = tmp_path / "wrong.json"
    wrong.write_text(json.dumps(whole))
    with pytest.raises(mcgw.StoreError, match=said):
        mcgw.ContactTable.read(wrong)


@pytest.mark.parametrize("name", ["gap", "pressure", "area", "conductance"])
def test_every_number_is_finite_and_but_for_gaps_positive(path, tmp_path, name):
    whole = json.loads(path.read_text())
    for wrong in (np.nan, np.inf, -np.inf, *([0.0] if name != "gap" else [])):
        for row in (0, -1):
            values = [*whole[name]]
            values[row] = wrong
            (tmp_path / "wrong.json").write_text(json.dumps(whole | {name: values}))
            with pytest.raises(mcgw.StoreError, match=f"{name}: give finite numbers > 0"):
                mcgw.ContactTable.read(tmp_path / "wrong.json")


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"gap": [1.0]}, "gap: give two numbers or more"),
        ({"area": [0.2, np.nan]}, "area: give finite numbers"),
        ({"pressure": [1.0, 2.0]}, "decreasing pressures"),
        ({"covariance": np.ones(2)}, "covariance: give"),
    ],
)
def test_a_table_that_no_one_could_read_is_not_made(wrong, said, tmp_path):
    given = {"gap": [1.0, 2.0], "pressure": [2.0, 1.0], "area": [0.2, 0.1]}
    mcgw.ContactTable(**given).write(tmp_path / "a.json")
    assert mcgw.ContactTable.read(tmp_path / "a.json").gap_at(2.0) == pytest.approx(1.0)
    with pytest.raises(ValueError, match=said):
        mcgw.ContactTable(**given | wrong)


def test_an_ensemble_at_one_separation_has_no_table(tmp_path):
    ensemble = mcgw.simulate(SCENE, n_surfaces=2, separations=1.0)
    with pytest.raises(ValueError, match="two numbers or more"):
        mcgw.export(ensemble, tmp_path / "a.json", to="json")
    assert not (tmp_path / "a.json").exists()


def test_on_the_command_line_from_a_file(tmp_path, capsys):
    mcgw.run(SCENE.replace(n_surfaces=5, separations=[0.0, 1.0, 2.0]), tmp_path / "e.h5")
    words = ["export", str(tmp_path / "e.h5"), "--to", "json", "-o", str(tmp_path / "e.json")]
    assert main(words) == 0
    assert "e.json" in capsys.readouterr().out
    assert len(mcgw.ContactTable.read(tmp_path / "e.json").gap) == 3
    assert main([*words, "--units", "mm-N-s"]) == 2
    assert "leave out" in capsys.readouterr().err

"""A table of contact as JSON: by its schema, and its columns those of theory."""

import json

import jsonschema
import numpy as np
import pytest

import mcgw
from mcgw.exports.contact_table import SCHEMA

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
SURFACES, JOINT = 400, mcgw.Joint(conductivities=(150.0, 16.0))
SCENE = mcgw.Scene(SURFACE, separations=[0.0, 1.5], n_surfaces=SURFACES, seed=4, joint=JOINT)


def exported(what, path, **options):
    """The table, after its file kept its schema; columns as arrays."""
    (found,) = mcgw.export(what, path, to="json", **options)
    table = json.loads(found.read_text())
    jsonschema.validate(table, json.loads(SCHEMA.read_text()))
    columns = {key: np.array(value) for key, value in table.items() if isinstance(value, list)}
    return table | columns


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    return exported(SCENE, tmp_path_factory.mktemp("table") / "a.json", points=11)


def test_its_columns_are_those_of_theory(table):
    """At its rows, within five standard errors."""
    assert mcgw.scene_from(table["provenance"]["scene"]).surface == SURFACE
    assert len(table["gap"]) == 11
    h = table["gap"] / SURFACE.sigma
    error = np.sqrt(np.diag(table["covariance"]) / SURFACES) / table["pressure"]
    for name, exact, area in (
        ("pressure", "pressure", 1.0), ("area", "area_fraction", 1.0),
        ("conductance", "conductance_si", SURFACE.nominal_area),
    ):  # fmt: skip
        off = np.abs(table[name] / SCENE.theory.mean(exact, h) * area - 1)
        assert np.all(off < 5 * error), name
    assert error.max() < 0.02


def test_gas_in_the_gap_conducts_too(table, tmp_path):
    """What it adds is Yovanovich's integral at each row's own gap."""
    gas = {"conductivity": 0.026, "jump": 3e-7}
    scene = SCENE.replace(gas=gas, rms=1.5e-6)
    joint = exported(scene, tmp_path / "a.json", points=11)
    added = scene.gas.gap(SURFACE, scene.heights)(joint["gap"] / SURFACE.sigma)
    np.testing.assert_allclose(joint["conductance"] - table["conductance"], added, rtol=1e-9)


def test_its_covariance_is_that_of_theory(table):
    """Of a variance from 400 surfaces the standard error is 7 %, of light loads more."""
    exact = SCENE.theory.covariance(["load"], table["gap"] / SURFACE.sigma)[0, :, 0, :]
    found = table["covariance"] * SURFACE.nominal_area**2
    heavy = slice(0, 5)
    assert np.abs(found / exact - 1)[heavy, heavy].max() < 0.4


def test_one_surface_without_a_film_has_neither_covariance_nor_conductance(tmp_path):
    scene = mcgw.Scene(SURFACE, separations=[0.0, 1.0], n_surfaces=1, seed=1)
    table = exported(scene, tmp_path / "a.json", points=3)
    assert table["covariance"] is table["conductance"] is None


@pytest.mark.parametrize("separations", [1.0, [0.0, 40.0]])
def test_what_makes_no_table_is_refused(separations, tmp_path):
    ensemble = mcgw.simulate(SCENE, n_surfaces=2, separations=separations)
    with pytest.raises(ValueError, match="two separations or more"):
        mcgw.export(ensemble, tmp_path / "a.json", to="json")
    assert not (tmp_path / "a.json").exists()

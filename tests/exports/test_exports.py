"""Tables for finite-element programs: read by each program's rule, against theory and literal sums."""

import csv
import json
import re

import jsonschema
import numpy as np
import pytest
from oracles.inside import pressures_of

import mcgw
from analytic.at_load import Moments
from mcgw.cli import main
from mcgw.exports.programs import KINDS, PROGRAMS, UNITS, Sheet
from mcgw.exports.writing import SCHEMA, quantile_name, surfaces_for

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "10 mm^2", "78.6 GPa")


@pytest.fixture(scope="module")
def scene():
    return mcgw.Scene(
        SURFACE,
        separations=np.linspace(0, 3, 13),
        grading=mcgw.Exponential(1.5),
        joint=mcgw.Joint(resistivity=1 / 150 + 1 / 16),
        contact=mcgw.Contact(quantities=["load", "stiffness", "conductance_si"]),
        n_surfaces=60,
        seed=4,
    )


@pytest.fixture(scope="module")
def ensemble(scene):
    return mcgw.simulate(scene)


# --- small readers, each written from its program's rule ------------------------------------------------


def read_inp(path):
    """Keyword and data lines of an input deck: `**` comments, `*` keywords, fields between commas."""
    keyword, rows = "", []
    for line in path.read_text().splitlines():
        assert len(line) <= 132  # CalculiX cuts there
        if line.startswith("*"):
            if not line.startswith("**"):
                assert not keyword
                keyword = line.replace(" ", "").upper()
            continue
        fields = [field.strip() for field in line.split(",")]
        assert len(fields) == 2
        assert all(len(field) <= 20 for field in fields)  # CalculiX reads 20 characters of each
        rows.append([float(field) for field in fields])
    return keyword, np.array(rows)


def read_columns(path, comment, separator):
    """MOOSE: comments from #, values between commas. COMSOL: comments from %, columns between blanks."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith(comment)]
    return np.array([line.split(separator) for line in lines], dtype=float)


def table_of(path, program):
    """Argument and value, whatever stands first."""
    if program in ("moose", "comsol"):
        return read_columns(path, *{"moose": ("#", ","), "comsol": ("%", None)}[program]).T
    return read_inp(path)[1].T[::-1]


def d0_of(path):
    return float(re.search(r"d0 = (\S+) ", path.read_text())[1])


KEYWORDS = {
    ("calculix", "pressure-gap"): "*SURFACEBEHAVIOR,PRESSURE-OVERCLOSURE=TABULAR",
    ("calculix", "conductance-pressure"): "*GAPCONDUCTANCE",
    ("abaqus", "pressure-gap"): "*SURFACEBEHAVIOR,PRESSURE-OVERCLOSURE=TABULAR",
    ("abaqus", "conductance-pressure"): "*GAPCONDUCTANCE,PRESSURE",
    ("abaqus", "conductance-gap"): "*GAPCONDUCTANCE",
}


# Per table: argument and value in mm, N and s over SI. 1 W/(m^2 K) is 1e3 mW / (1e6 mm^2 K).
FACTORS = {
    "pressure-gap": (1e3, 1e-6), "conductance-gap": (1e3, 1e-3),
    "conductance-pressure": (1e-6, 1e-3), "stiffness-pressure": (1e-6, 1e-9),
}  # fmt: skip
LIVE = "x\n*STEP\r*INCLUDE, INPUT=evil.inp\u2028%\x85#\n1.0, 2.0"
NUMBER = r"[-+]?\d\.\d{9}e[-+]\d\d"
# A comment, or a row of two numbers; each by its program's own manual.
LINES = {
    "calculix": rf"\*\*[ -~]{{0,130}}|{NUMBER}, {NUMBER}",
    "abaqus": rf"\*\*[ -~]{{0,254}}|{NUMBER}, {NUMBER}",
    "moose": rf"#[ -~]*|{NUMBER},{NUMBER}",
    "comsol": rf"%[ -~]*|{NUMBER} {NUMBER}",
}


@pytest.mark.parametrize("units", UNITS)
@pytest.mark.parametrize(("program", "table"), [(p, t) for p in PROGRAMS for t in PROGRAMS[p].tables])
def test_a_curve_is_written_as_the_program_reads_it(scene, program, table, units, tmp_path):
    """Order, signs, the row where nothing is carried, units and keyword.

    Whatever a stranger wrote into a title or name stays a comment.
    """
    kind, path = KINDS[table], tmp_path / "t"
    x, y = np.array([1.0, 2.0, 4.0]), np.array([1.0, 2.0, 5.0])
    x, y, foot = (1e-6 * x, 1e6 * y[::-1], 6e-6) if kind.against == "gap" else (1e6 * x, y, 0.0)
    sheet = Sheet(scene, 60, kind, PROGRAMS[program], units, "data 0a")
    factors = FACTORS[table] if units == "mm-N-s" else (1, 1)
    columns = factors[0] * x, factors[1] * y
    text = sheet._replace(origin=LIVE).text("q05", *columns, LIVE)
    for line in re.split(r"[\r\n]", text.encode("ascii", "replace").decode()):
        assert line in ("", PROGRAMS[program].tables[table][0]) or re.fullmatch(LINES[program], line)
    path.write_text(sheet.text("q05", *columns, "f.x"))
    text = path.read_text()
    overclosure = table == "pressure-gap" and program in ("calculix", "abaqus")
    if overclosure:
        x, y = np.array([0, 2e-6, 4e-6, 5e-6]), 1e6 * np.array([0, 1, 2, 5])
    elif kind.against == "gap":
        x, y = np.append(x, foot), np.append(y, 0)
    else:
        x, y = np.append(0, x), np.append(0, y)
    np.testing.assert_allclose(table_of(path, program), [factors[0] * x, factors[1] * y], rtol=1e-9)
    assert not foot or d0_of(path) == pytest.approx(factors[0] * foot)
    heat = sheet._replace(scene=scene.replace(joint=mcgw.Joint([150.0, 16.0])))  # as a current, mW for mA
    for one in (sheet, heat):
        found = one.unit(kind.against)[0], one.unit(kind.quantity)[0]
        assert found == pytest.approx(factors, rel=1e-15)
    if program in ("calculix", "abaqus"):
        assert read_inp(path)[0] == KEYWORDS[program, table]
    assert ("INPUT=f.x" in text) == (program in ("calculix", "abaqus"))
    assert ("MPa" in re.search("units: (.+)", text)[1]) == (units == "mm-N-s" and "pressure" in table)


def test_quantiles_have_names_of_their_own():
    shares = (0.05, 0.5, 0.025, 0.975, 0.9999)
    assert [quantile_name(q) for q in shares] == ["q05", "q50", "q2.5", "q97.5", "q99.99"]


def test_an_ensemble_gives_its_own_numbers(ensemble, tmp_path):
    """Mean and quantiles of what it holds, the overclosure from where the line of two points ends."""
    path, low, high, every = mcgw.export(ensemble, tmp_path / "t.inp", to="abaqus", units="mm-N-s")
    overclosure, pressure = table_of(path, "abaqus")
    mean = 1e-6 * ensemble.mean("pressure")
    np.testing.assert_allclose(pressure[:0:-1], mean, rtol=1e-9)
    bounds = [1e6 * mean[6], 1e6 * mean[2]]
    inner, *_ = mcgw.export(ensemble, tmp_path / "i.txt", to="comsol", pressures=bounds)
    np.testing.assert_allclose(table_of(inner, "comsol")[1, :-1], 1e6 * mean[2:7], rtol=1e-9)
    gap = 1e3 * SURFACE.sigma * ensemble.separations
    d0 = d0_of(path)
    np.testing.assert_allclose(overclosure[:0:-1], d0 - gap, atol=1e-11)
    assert d0 == pytest.approx(gap[-1] + mean[-1] * (gap[-1] - gap[-2]) / (mean[-2] - mean[-1]), rel=1e-9)
    for q, file in ((0.05, low), (0.95, high)):
        expected = np.quantile(1e-6 * ensemble.values("pressure"), q, axis=0)
        np.testing.assert_allclose(table_of(file, "abaqus")[1][:0:-1], expected[expected > 0], rtol=1e-9)
    rows = list(csv.reader(every.read_text().splitlines()[1:]))
    assert rows[0] == ["gap (mm)", *(f"pressure {name} (MPa)" for name in ("mean", "q05", "q95"))]
    np.testing.assert_allclose([float(row[1]) for row in rows[1:]], mean, rtol=1e-12)


def test_points_that_carry_nothing_are_left_out(scene, tmp_path):
    """A quantile of specimens that do not touch any more."""
    far = mcgw.simulate(scene.replace(separations=[0, 1, 2, 4], n_surfaces=20))
    path, low, *_ = mcgw.export(far, tmp_path / "t.csv", to="moose")
    assert [len(table_of(file, "moose")[0]) for file in (path, low)] == [4 + 1, 3 + 1]
    alone = mcgw.simulate(far.scene, n_surfaces=1)  # which has no quantiles
    assert mcgw.export(alone, tmp_path / "o.csv", to="moose") == [
        tmp_path / x for x in ("o.csv", "o.all.csv")
    ]


def test_pressures_of_a_scene_are_those_of_its_rows_against_the_gap(scene, tmp_path):
    """Drawn there with the load alone, whatever the scene keeps, and pressed once."""
    wanted = np.geomspace(1e6, 2e7, 5)
    back = scene.replace(
        law=mcgw.KogutEtsion(critical=0.05), unload_from="loop", quantities=["load"], joint=None
    )
    drawn = surfaces_for(back.replace(keep="statistics"), ("load",), None, 4)
    assert (drawn.scene.quantities, drawn.scene.keep, drawn.scene.unload_from) == (("load",), "sums", None)
    path, *_ = mcgw.export(scene.replace(n_surfaces=9), tmp_path / "t.csv", to="moose", pressures=wanted)
    h = [float(scene.theory.separation_at("pressure", p)) for p in wanted[::-1]]
    np.testing.assert_allclose(table_of(path, "moose")[0, :-1], SURFACE.sigma * np.array(h), rtol=1e-8)


def test_pressures_are_those_of_the_mean_surface_where_a_specimen_touches(scene):
    found = pressures_of(scene.replace(separations=[8.0, 2.0, 0.0, 0.5]), 5)
    assert found[[0, -1]] == pytest.approx(scene.theory.mean("pressure", [2.0, 0.0]), rel=1e-9)
    assert np.ptp(np.diff(np.log(found))) < 1e-9


def test_rows_against_pressure_are_the_values_and_specimens_of_solve(scene, tmp_path, monkeypatch):
    """Means of the surfaces drawn: exact ones take half a second each."""
    monkeypatch.setattr("mcgw.ensemble.solved.Solution._exact", Moments({}, {}))
    scene, wanted, area = scene.replace(n_surfaces=20), [1e6, 1e7], SURFACE.nominal_area
    solved = mcgw.solve(scene, pressure=wanted)
    for name in ("conductance", "stiffness"):
        paths = mcgw.export(scene, tmp_path / "t.csv", to="moose", table=f"{name}-pressure", pressures=wanted)
        x, mean = table_of(paths[0], "moose")[:, -2:]
        np.testing.assert_allclose(x, wanted, rtol=1e-9)
        sum_of = {"conductance": "conductance_si"}.get(name, name)
        np.testing.assert_allclose(mean, [each.value[sum_of] / area for each in solved], rtol=1e-9)
        low = [np.quantile(each.surfaces[sum_of], 0.05) / area for each in solved]
        np.testing.assert_allclose(table_of(paths[1], "moose")[1, -2:], low, rtol=1e-9)


# --- what has no table ----------------------------------------------------------------------------------


def test_what_has_no_table_is_told(scene, ensemble, tmp_path):
    mean, stiffness = ensemble.mean("pressure"), {"table": "stiffness-pressure", "points": 5}
    conductance = {"table": "conductance-pressure", "pressures": [1e6, 1e12]}
    bare = scene.replace(joint=None, quantities=["load"], n_surfaces=3)
    areas = mcgw.simulate(bare, quantities=["area"])
    pulls = bare.replace(law=mcgw.DerjaguinMullerToporov(pull_off=0.3))
    fine = bare.replace(surface=mcgw.Surface("2 nm", "13 um", "300/mm^2", "10 mm^2", "78.6 GPa"))
    steps = {"to": "calculix", "points": 80}
    alone, apart = (mcgw.simulate(JOINED, n_surfaces=2, separations=h) for h in (1.0, [0.0, 40.0]))
    for what, given, told in (
        (pulls, {}, r"^contact\.law: surfaces attract each other .* negative pressures"),
        (bare, conductance, r"^joint\.conductivities: missing for a table of conductance"),
        (areas, {}, r"^contact\.quantities: the ensemble has no load; give its scene"),
        (fine, steps, r'closer than 1e-10, .*units = "mm-N-s"'),
        (ensemble, {"pressures": [0.9 * mean[3], 1.1 * mean[3]]}, r"mean: 1 point\(s\) with load"),
        (scene.replace(separations=[8, 9]), stiffness, r"^contact\.separations: give two or more at which a"),
        (scene.replace(n_surfaces=1), stiffness, r"^n_surfaces = 1: an interval needs at least 2 surfaces$"),
        (3.0, {}, "^float: give a scene, an ensemble, or the file of an ensemble$"),
        (alone, {"to": "json"}, r"mean: 1 point\(s\) with load"),
        (apart, {"to": "json"}, r"mean: 1 point\(s\) with load"),
        (
            scene,
            {"table": "gap-pressure"},
            r"^table = 'gap-pressure': did you mean pressure-gap\? choose",
        ),
        (scene, {"to": "calculix", "table": "conductance-gap"}, "calculix does not support it; choose"),
        (scene, {"to": "ansys"}, r"^to = 'ansys': choose one of calculix, abaqus, moose, comsol, json$"),
        (scene, {"to": "calculix", "points": 300}, "^points = 300: calculix reads at most 200 lines; give"),
        (
            scene,
            {"pressures": [1.0, 3.0, 2.0]},
            r"^pressures = \[1\.0, 3\.0, 2\.0\]: give two or more increasing numb",
        ),
        (scene, {"pressures": ["1 N", "2 N"]}, r"^pressures = \['1 N', '2 N'\]: give two .* Pa; value 1"),
    ):
        with pytest.raises(ValueError, match=told) as caught:
            mcgw.export(what, tmp_path / "t.txt", **({"to": "comsol"} | given))
        assert "\n" not in str(caught.value)
    assert not list(tmp_path.iterdir())
    mcgw.export(fine, tmp_path / "t.inp", **steps, units="mm-N-s")


# --- what a stranger wrote ------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["a\n*STEP", "*STEP", "a,b", "a'b", "\u00e9", "a" * 70])
def test_names_that_a_program_cannot_be_told_are_refused(make_scene, name, tmp_path, capsys):
    scene, path = make_scene(n_surfaces=8), tmp_path / f"{name}.inp"
    with pytest.raises(ValueError, match=r"^path = .*: \w+ includes it by name; give a name of"):
        mcgw.export(scene, path, to="abaqus")
    assert main(["export", "none.toml", "--to", "abaqus", "-o", str(path)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert not list(tmp_path.iterdir())


JOINT = mcgw.Joint(conductivities=(150.0, 16.0))
JOINED = mcgw.Scene(SURFACE, separations=[0.0, 1.5], n_surfaces=400, seed=4, joint=JOINT)


def as_json(what, path, points):
    """The table, after its file kept its schema; columns as arrays."""
    (found,) = mcgw.export(what, path, to="json", points=points)
    table = json.loads(found.read_text())
    jsonschema.validate(table, json.loads(SCHEMA.read_text()))
    columns = {key: np.array(value) for key, value in table.items() if isinstance(value, list)}
    return table | columns


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    return as_json(JOINED, tmp_path_factory.mktemp("table") / "a.json", points=11)


def test_its_columns_are_those_of_theory(table):
    """At its rows, within five standard errors."""
    assert mcgw.scene_from(table["provenance"]["scene"]).surface == SURFACE
    assert len(table["gap"]) == 11
    h = table["gap"] / SURFACE.sigma
    error = np.sqrt(np.diag(table["covariance"]) / 400) / table["pressure"]
    for name, exact, area in (
        ("pressure", "pressure", 1.0), ("area", "area_fraction", 1.0),
        ("conductance", "conductance_si", SURFACE.nominal_area),
    ):  # fmt: skip
        off = np.abs(table[name] / JOINED.theory.mean(exact, h) * area - 1)
        assert np.all(off < 5 * error), name
    assert error.max() < 0.02


def test_one_surface_without_a_film_has_neither_covariance_nor_conductance(tmp_path):
    scene = mcgw.Scene(SURFACE, separations=[0.0, 1.0], n_surfaces=1, seed=1)
    table = as_json(scene, tmp_path / "a.json", points=3)
    assert table["covariance"] is table["conductance"] is None

"""What a notebook is given: quantities by name, tables, pictures, short looks, progress, files."""

import math

import matplotlib as mpl
import numpy as np
import pytest
from oracles.inside import Column, MemoryResults, Table, brief, joined, stacked
from oracles.told import drawn

import analytic
import mcgw
from mcgw import Ensemble
from mcgw.figures.plotting import draw
from mcgw.statistics import tradeoff

mpl.use("agg")
import matplotlib.pyplot as plt

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
H = (2.0, 0.0, 1.0)  # in no order
LAWS = {
    "gaussian": mcgw.Gaussian(),
    "weibull": mcgw.Weibull(2.0),
    "exponential": mcgw.ExponentialHeights(),
    "table": mcgw.HeightTable.of([0.0, 1.0, 1.5, 2.5, 4.0]),
}


@pytest.fixture(scope="module")
def scene():
    quantities = tuple(analytic.QUANTITIES)
    return mcgw.Scene(
        SURFACE,
        separations=H,
        grading=mcgw.Exponential(2.0),
        contact=mcgw.Contact(quantities=quantities),
        n_surfaces=60,
        seed=1,
    )


@pytest.fixture(scope="module")
def ensemble(scene):
    return mcgw.simulate(scene)


def few_methods(scene, **options):
    """A study with one sampler."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tradeoff, "sampled_ways", lambda scene: ["tail"])
        return mcgw.tradeoff(scene, **options)


@pytest.fixture(scope="module")
def results(scene, ensemble, tmp_path_factory):
    """One of everything that is shown and drawn."""
    folder = tmp_path_factory.mktemp("map")
    z = np.random.default_rng(1).normal(size=(128, 128)) * 1e-6
    np.save(folder / "map.npy", z)
    other = mcgw.simulate(ensemble.scene, grading=mcgw.Exponential(1.2))
    return {
        "ensemble": ensemble,
        "one surface": mcgw.simulate(scene, n_surfaces=1),
        "comparison": mcgw.compare(ensemble),
        "other grading": other,
        "ratio": mcgw.paired_ratio(other, ensemble, "load"),
        "solution": mcgw.solve(scene, pressure="1 MPa"),
        "convergence": mcgw.converge(scene, n_surfaces=64, seeds=4, quantities=["load"]),
        "study": few_methods(scene, seconds=0.1),
        "fit": mcgw.fit(folder / "map.npy", cutoff="10 um", pixel="1 um"),
    }


COLUMNS = {  # as files have them
    "ratio": [(lambda x: x.table(), "separation ratio stderr variance_gain")],
    "solution": [
        (lambda x: x.table(), "quantity unit value low_95 high_95 std infinite best best_95"),
        (
            lambda x: x.table(specimens=True),
            "quantity unit value low_95 high_95 std specimen_05 specimen_95 infinite best best_95",
        ),
        (lambda x: x.budget().table(), "95_% area stiffness conductance gap_to_summits"),
        (lambda x: x.budget().sheet(), "95_% area stiffness conductance gap_to_summits"),
    ],
    "sweep": [
        (
            lambda x: x.table(),
            "grading.gamma separation load_mean load_std load_ratio load_ratio_low load_ratio_high "
            "area_mean area_std",
        ),
        (lambda x: x.sheet(), "point load stderr area stderr"),
        (
            lambda x: mcgw.compare(x).table(),
            "grading.gamma quantity unit separation mean theory residual p_of_point",
        ),
        (
            lambda x: mcgw.compare(x).sheet(),
            "point quantity unit separation mean theory residual p_of_point",
        ),
    ],
}


@pytest.mark.parametrize("name", COLUMNS)
def test_columns_have_names_that_programs_may_rely_on(name, results, scene):
    short = scene.replace(quantities=("load", "area"))
    result = mcgw.sweep(short, {"grading.gamma": [0.5, 2.0]}) if name == "sweep" else results[name]
    for table, names in COLUMNS[name]:
        assert [column.name.replace(" ", "_") for column in table(result).flat] == names.split()


# --- quantities --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "of"), [("pressure", "load"), ("area_fraction", "area")])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_pressure_and_area_fraction_are_load_and_area_per_nominal_area(scene, law, name, of):
    e = mcgw.simulate(scene, heights=law)
    area = SURFACE.nominal_area
    np.testing.assert_array_equal(e[name], e[of] / area)
    np.testing.assert_array_equal(e.values(name), getattr(e, name))
    for statistic in (e.mean, e.std, e.stderr):
        np.testing.assert_allclose(statistic(name), statistic(of) / area, rtol=1e-15)
    for end, other in zip(e.interval(name), e.interval(of), strict=True):
        np.testing.assert_allclose(end, other / area, rtol=1e-15)
    theory = e.scene.theory
    for statistic in ("mean", "std"):
        found, exact = (getattr(theory, statistic)(x, H) for x in (name, of))
        np.testing.assert_allclose(found, exact / area, rtol=1e-14)
    np.testing.assert_allclose(theory.separation_at(name, theory.mean(name, H)), H, rtol=1e-10, atol=1e-10)
    matrix = theory.covariance([name, of], H)
    np.testing.assert_allclose(matrix[0, :, 1], matrix[1, :, 1] / area, rtol=1e-12)
    np.testing.assert_allclose(theory.slope(name, 1.0), theory.slope(of, 1.0) / area, rtol=1e-14)


def test_a_quantity_that_is_not_there_is_told_with_those_that_are(scene, ensemble):
    with pytest.raises(KeyError, match="'torque' is not in this ensemble; it has load, area"):
        ensemble["torque"]
    with pytest.raises(KeyError, match=r"'torque' is not a quantity; give one of load, .*, area_fraction"):
        scene.theory.mean("torque", 1.0)
    only = mcgw.simulate(scene, quantities=["load"])
    assert only["pressure"].shape == (60, 3)
    for statistic in (only.mean, only.values, only.interval):
        with pytest.raises(KeyError, match="'area_fraction' is not in this ensemble; it has load"):
            statistic("area_fraction")


# --- tables ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("where", ["memory", "file"])
def test_xarray_is_as_the_file_is(scene, ensemble, where, tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    stored = mcgw.save(ensemble, tmp_path / "e.h5")
    found = (ensemble if where == "memory" else stored).to_xarray()
    with xarray.open_dataset(tmp_path / "e.h5", engine="h5netcdf") as file:
        for name in (*scene.quantities, "surface", "separation"):
            assert found[name].dims == file[name].dims
            np.testing.assert_array_equal(found[name], file[name])
            kept = {key: file[name].attrs[key] for key in ("units", "long_name")}
            assert found[name].attrs == kept
        for key in ("title", "scene", "sampler"):
            assert found.attrs[key] == file.attrs[key]
    assert mcgw.scene_from(found.attrs["scene"]) == scene


def test_a_dataframe_has_a_row_for_each_surface_and_separation(ensemble):
    pytest.importorskip("pandas")
    table = ensemble.to_dataframe()
    assert list(table.index.names) == ["surface", "separation"]
    assert list(table.columns) == list(ensemble.scene.quantities)
    for k, h in enumerate(H):
        np.testing.assert_array_equal(table["load"].xs(h, level="separation"), ensemble.load[:, k])
    assert table.loc[(7, 0.0), "area"] == ensemble.area[7, 1]
    assert table["contacts"].dtype == np.int64


@pytest.mark.parametrize(("method", "package"), [("to_dataframe", "pandas"), ("to_xarray", "xarray")])
def test_a_package_that_is_not_installed_is_named(ensemble, monkeypatch, method, package):
    monkeypatch.setitem(__import__("sys").modules, package, None)
    how = r"in a clone of mcgw, pip install -e '\.\[notebook\]'"
    with pytest.raises(ImportError, match=rf"^{method} needs {package}: {how}$"):
        getattr(ensemble, method)()


# --- short looks -------------------------------------------------------------------------------------------


def test_everything_is_shown_in_a_dozen_lines_and_as_a_table(results, scene):
    for name, result in {**results, "scene": scene}.items():
        lines = repr(result).splitlines()
        assert len(lines) <= 12, name
        assert max(map(len, lines)) <= 120, name
        page = result._repr_html_()
        assert page.count("<table>") == page.count("</table>") >= 1, name
        assert str(result) == repr(result)


def test_a_large_ensemble_is_not_read_for_a_look(ensemble):
    class Untouched(MemoryResults):
        def rows(self):
            return 10**9

        def read(self, *_):
            raise AssertionError

    shown = repr(Ensemble(ensemble.scene, "cells", Untouched({})))
    assert "1000000000 surfaces" in shown
    assert "load, area" in shown


def test_a_title_is_no_tag_and_no_command(scene, ensemble):
    title = "<script>alert(1)</script>\x1b[31m\n$x"
    for shown in (scene.replace(title=title), mcgw.simulate(scene, title=title, n_surfaces=2)):
        assert "<script" not in shown._repr_html_()
        assert "&lt;script" in shown._repr_html_()
        assert "\x1b" not in repr(shown)
    shown = Table((Column("<d>", ["<e>"]),), "<a>", [("<b>", "<c>")])._repr_html_()
    assert not [tag for tag in ("<a>", "<c>", "<d>", "<e>") if tag in shown]
    assert shown.count("<b>") == 1  # our own
    assert brief("x" * 88) == "x" * 88
    assert brief("x" * 500) == "x" * 85 + "..."


def test_tables_under_each_other_are_their_rows_one_by_one():
    """A unit that is not common has a column of its own; errors stay where every table has them."""

    def cell(values, unit, **more):
        return Table((Column("x", values, unit=unit, **more), Column("n", [7.0] * len(values))))

    one, two = cell([1.0, 2.0], "N", error=[0.1, 0.2]), cell([3.0], "N", error=[0.3])
    both = joined([one, two])
    assert (list(both.columns[0].values), list(both.columns[1].values)) == ([1.0, 2.0, 3.0], [7.0] * 3)
    assert (both.columns[0].unit, list(both.columns[0].error)) == ("N", [0.1, 0.2, 0.3])
    other = joined([one, cell([4.0], "m^2")]).columns[0]
    assert (other.unit, other.error) == ("", None)
    part = both.at([2, 0])
    assert (list(part.columns[0].values), list(part.columns[0].error)) == ([3.0, 1.0], [0.3, 0.1])
    bare = stacked({"a": cell([1.0], ""), "b": cell([2.0], "")}, "who")
    assert [column.name for column in bare.columns] == ["who", "x", "n"]


# --- pictures ----------------------------------------------------------------------------------------------


@pytest.fixture(autouse=True)
def no_window():
    yield
    plt.close("all")


def test_everything_draws_itself(results, recorded):
    seen = []
    for name, result in results.items():
        figure, ax = plt.subplots()
        before = set(plt.get_fignums())
        assert result.plot(ax) is ax, name
        assert result.plot(ax=ax) is ax, name
        assert set(plt.get_fignums()) == before, name
        assert ax.get_xlabel(), name
        assert ax.lines or ax.patches or ax.collections, name
        own = result.plot()
        assert own.figure is not figure, name
        assert own.figure.number in plt.get_fignums(), name  # so a notebook shows it
        seen += [] if name == "study" else drawn(own)  # which is of times
        if name == "ensemble":  # the others are drawn in the tests of figures
            own.figure.canvas.draw()
    recorded("drawn.results", seen)


def test_what_is_drawn_is_what_there_is(ensemble, results):
    """The rest is recorded above."""
    ax, order = ensemble.plot(quantity="pressure"), np.argsort(H)
    np.testing.assert_allclose(ax.lines[0].get_ydata(), ensemble.mean("pressure")[order], rtol=1e-15)
    (bars,) = ax.containers[0].lines[2]
    low, high = ensemble.interval("pressure")
    ends = np.transpose([np.maximum(low, 0.001 * ensemble.mean("pressure")), high])[order]
    np.testing.assert_allclose(np.array(bars.get_segments())[..., 1], ends, rtol=1e-12)
    assert results["study"].plot(want="quantile").get_title(loc="left") == "99% quantile"
    with pytest.raises(ValueError, match="want = 'median': give one of "):
        results["study"].plot(want="median")
    with pytest.raises(KeyError, match="torque"):
        ensemble.plot(quantity="torque")
    with pytest.raises(TypeError, match=r"^int: there is no figure of it"):
        draw(3)


# --- progress ----------------------------------------------------------------------------------------------


def checked(seen, total):
    assert [of for _, of in seen] == [total] * len(seen)
    done = [number for number, _ in seen]
    assert done == sorted(done)
    assert len(done) >= 2
    return done


@pytest.mark.slow
def test_progress_means_the_same_everywhere(scene, tmp_path):
    calls = {
        60: lambda tell: mcgw.simulate(scene, progress=tell),
        61: lambda tell: mcgw.run(scene, tmp_path / "e.h5", n_surfaces=61, progress=tell),
        5: lambda tell: mcgw.converge(scene, n_surfaces=64, seeds=5, quantities=["load"], progress=tell),
        0.2: lambda tell: few_methods(scene, seconds=0.2, progress=tell),
    }
    for total, call in calls.items():
        seen = []
        call(lambda done, of, seen=seen: seen.append((done, of)))
        assert checked(seen, total)[-1] == total
    seen, rule = [], scene.replace(n_surfaces=None, rel_err=0.05)
    ruled = mcgw.run(rule, tmp_path / "ruled.h5", progress=lambda done, of: seen.append((done, of)))
    assert checked(seen, ruled.n_surfaces)[-1] == ruled.n_surfaces


# --- questions ---------------------------------------------------------------------------------------------


def test_one_load_by_four_names(scene):
    scene = scene.replace(n_surfaces=9)
    area = SURFACE.nominal_area
    one = mcgw.solve(scene, load=2.0)
    for words in ({"load": "2 N"}, {"pressure": 2.0 / area}, {"pressure": "2 MPa"}, {"load": np.float64(2)}):
        found = mcgw.solve(scene, **words)
        assert found.theory == pytest.approx(one.theory, rel=1e-14)
        np.testing.assert_allclose(found.surfaces["area"], one.surfaces["area"], rtol=1e-12)
    several = mcgw.solve(scene, area_fraction=["0.1 %", 0.002])
    assert [s.amount / area for s in several] == pytest.approx([0.001, 0.002], rel=1e-15)
    for words in (np.array([1e-9]), [1e-9], ["1e-3 mm^2"]):
        assert [s.amount for s in mcgw.solve(scene, area=words)] == [1e-9]
    assert math.isclose(mcgw.solve(scene, load=2.0, n_surfaces=7).surfaces["load"].size, 7)

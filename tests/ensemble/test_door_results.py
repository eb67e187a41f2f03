"""What a notebook is given: quantities by name, tables, pictures, short looks, progress, files."""

import matplotlib as mpl
import numpy as np
import pytest
from oracles.inside import Column, Table, brief
from oracles.told import drawn

import analytic
import mcgw
from mcgw.statistics import tradeoff

mpl.use("agg")
import matplotlib.pyplot as plt

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
H = (2.0, 0.0, 1.0)  # in no order


@pytest.fixture(scope="module")
def scene():
    quantities = tuple(analytic.QUANTITIES)
    given = {"contact": mcgw.Contact(quantities=quantities), "n_surfaces": 60, "seed": 1}
    return mcgw.Scene(SURFACE, separations=H, grading=mcgw.Exponential(2.0), **given)


@pytest.fixture(scope="module")
def ensemble(scene):
    return mcgw.simulate(scene)


@pytest.fixture(scope="module")
def results(scene, ensemble, tmp_path_factory):
    """One of everything that is shown and drawn."""
    folder = tmp_path_factory.mktemp("map")
    z = np.random.default_rng(1).normal(size=(128, 128)) * 1e-6
    np.save(folder / "map.npy", z)
    other = mcgw.simulate(ensemble.scene, grading=mcgw.Exponential(1.2))
    with pytest.MonkeyPatch.context() as patch:  # of one sampler
        patch.setattr(tradeoff, "sampled_ways", lambda scene: ["tail"])
        study = mcgw.tradeoff(scene, seconds=0.1)
    return {
        "ensemble": ensemble,
        "one surface": mcgw.simulate(scene, n_surfaces=1),
        "comparison": mcgw.compare(ensemble),
        "other grading": other,
        "ratio": mcgw.paired_ratio(other, ensemble, "load"),
        "solution": mcgw.solve(scene, pressure="1 MPa"),
        "convergence": mcgw.converge(scene, n_surfaces=64, seeds=4, quantities=["load"]),
        "study": study,
        "fit": mcgw.fit(folder / "map.npy", cutoff="10 um", pixel="1 um"),
    }


@pytest.fixture(scope="module")
def sweep(scene):
    return mcgw.sweep(scene.replace(quantities=("load", "area")), {"grading.gamma": [0.5, 2.0]})


def test_columns_have_names_that_programs_may_rely_on(results, sweep):
    """As files have them."""
    solution = "quantity unit value low_95 high_95 std {}infinite best best_95"
    ratio = "load_ratio load_ratio_low load_ratio_high"
    for table, names in (
        (results["ratio"].table(), "separation ratio stderr variance_gain"),
        (results["solution"].table(), solution.format("")),
        (results["solution"].table(specimens=True), solution.format("specimen_05 specimen_95 ")),
        (results["solution"].budget().table(), "95_% area stiffness conductance gap_to_summits"),
        (sweep.table(), f"grading.gamma separation load_mean load_std {ratio} area_mean area_std"),
        (sweep.sheet(), "point load stderr area stderr"),
        (
            mcgw.compare(sweep).table(),
            "grading.gamma quantity unit separation mean theory residual p_of_point",
        ),
    ):
        assert [column.name.replace(" ", "_") for column in table.columns] == names.split()


@pytest.mark.parametrize(("name", "of"), [("pressure", "load"), ("area_fraction", "area")])
def test_pressure_and_area_fraction_are_load_and_area_per_nominal_area(ensemble, name, of):
    e = ensemble
    area = SURFACE.nominal_area
    np.testing.assert_array_equal(e[name], e[of] / area)
    np.testing.assert_array_equal(e.values(name), getattr(e, name))
    theory = e.scene.theory
    for statistic in (theory.mean, theory.std, theory.slope):
        np.testing.assert_allclose(statistic(name, H), statistic(of, H) / area, rtol=1e-14)
    np.testing.assert_allclose(theory.separation_at(name, theory.mean(name, H)), H, rtol=1e-10, atol=1e-10)
    matrix = theory.covariance([name, of], H)
    np.testing.assert_allclose(matrix[0, :, 1], matrix[1, :, 1] / area, rtol=1e-12)


def test_xarray_is_as_the_file_is_and_a_dataframe_has_a_row_for_each_surface_and_separation(
    scene, ensemble, tmp_path
):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    found = ensemble.to_xarray()
    xarray.testing.assert_identical(mcgw.save(ensemble, tmp_path / "e.h5").to_xarray(), found)
    with xarray.open_dataset(tmp_path / "e.h5", engine="h5netcdf") as file:
        for name in (*scene.quantities, "surface", "separation"):
            assert found[name].dims == file[name].dims
            np.testing.assert_array_equal(found[name], file[name])
            assert found[name].attrs == {key: file[name].attrs[key] for key in ("units", "long_name")}
        for key in ("title", "scene", "sampler"):
            assert found.attrs[key] == file.attrs[key]
    assert mcgw.scene_from(found.attrs["scene"]) == scene
    table = ensemble.to_dataframe()
    assert list(table.index.names) == ["surface", "separation"]
    assert list(table.columns) == list(scene.quantities)
    np.testing.assert_array_equal(table["load"].to_numpy().reshape(60, 3), ensemble.load)
    assert table.loc[(7, 0.0), "area"] == ensemble.area[7, 1]
    assert table["contacts"].dtype == np.int64


@pytest.mark.parametrize(("method", "package"), [("to_dataframe", "pandas"), ("to_xarray", "xarray")])
def test_a_package_that_is_not_installed_is_named(ensemble, missing, method, package):
    missing(package)
    how = r"in a clone of mcgw, pip install -e '\.\[notebook\]'"
    with pytest.raises(ImportError, match=rf"^{method} needs {package}: {how}$"):
        getattr(ensemble, method)()


def test_everything_is_shown_in_a_dozen_lines_and_as_a_table(results, scene):
    for name, result in {**results, "scene": scene}.items():
        lines = repr(result).splitlines()
        assert len(lines) <= 12, name
        assert max(map(len, lines)) <= 120, name
        page = result._repr_html_()
        assert page.count("<table>") == page.count("</table>") >= 1, name
        assert str(result) == repr(result)


def test_a_title_is_no_tag_and_no_command(scene, ensemble):
    title = "<script>alert(1)</script>\x1b[31m\n$x"
    for shown in (scene.replace(title=title), mcgw.simulate(scene, title=title, n_surfaces=2)):
        assert "<script" not in shown._repr_html_()
        assert "&lt;script" in shown._repr_html_()
        assert "\x1b" not in repr(shown)
    shown = Table((Column("<d>", ["<e>"]),), "<a>", [("<b>", "<c>")])._repr_html_()
    assert not [tag for tag in ("<a>", "<c>", "<d>", "<e>") if tag in shown]
    assert shown.count("<b>") == 1  # our own
    assert (brief("x" * 88), brief("x" * 500)) == ("x" * 88, "x" * 85 + "...")


@pytest.fixture(autouse=True)
def no_window():
    yield
    plt.close("all")


def test_everything_draws_itself(results, recorded):
    seen = []
    for name, result in results.items():
        figure, ax = plt.subplots()
        assert result.plot(ax=ax) is ax, name
        own = result.plot()
        assert own.figure is not figure, name
        assert own.figure.number in plt.get_fignums(), name  # so a notebook shows it
        seen += [] if name == "study" else drawn(own)  # which is of times
        if name == "ensemble":  # the others are drawn in the tests of figures
            own.figure.canvas.draw()
    recorded("drawn.results", seen)


def test_what_is_drawn_is_what_there_is(ensemble, results):
    """The rest is recorded above."""
    (bars,) = ensemble.plot(quantity="pressure").containers[0].lines[2]
    low, high = ensemble.interval("pressure")
    ends = np.transpose([np.maximum(low, 0.001 * ensemble.mean("pressure")), high])[np.argsort(H)]
    np.testing.assert_allclose(np.array(bars.get_segments())[..., 1], ends, rtol=1e-12)
    assert results["study"].plot(want="quantile").get_title(loc="left") == "99% quantile"
    with pytest.raises(ValueError, match="want = 'median': give one of "):
        results["study"].plot(want="median")
    with pytest.raises(KeyError, match="torque"):
        ensemble.plot(quantity="torque")
    pulled = mcgw.simulate(ensemble.scene, law=analytic.JohnsonKendallRoberts(pull_off=1.0), n_surfaces=9)
    assert pulled.plot(quantity="load").get_yscale() == "linear"


def test_one_load_by_four_names(scene):
    scene, area = scene.replace(n_surfaces=9), SURFACE.nominal_area
    one = mcgw.solve(scene, load=np.float64(2.0))
    for words in ({"load": "2 N"}, {"pressure": "2 MPa"}):
        found = mcgw.solve(scene, **words)
        assert found.theory == pytest.approx(one.theory, rel=1e-14)
        np.testing.assert_allclose(found.surfaces["area"], one.surfaces["area"], rtol=1e-12)
    several = mcgw.solve(scene, area_fraction=["0.1 %", 0.002], n_surfaces=7)
    assert [s.amount / area for s in several] == pytest.approx([0.001, 0.002], rel=1e-15)
    assert several[0].surfaces["load"].size == 7
    assert [s.amount for s in mcgw.solve(scene, area=np.array([1e-9]))] == [1e-9]

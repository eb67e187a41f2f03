"""What an ensemble can, kept statistics and a sweep can too: compared with the values of every surface."""

import numpy as np
import pytest
from oracles.inside import verdict

import mcgw
from mcgw.ensemble.ensemble import MOST_SHOWN

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(SURFACE, separations=[1.0, 0.0, 2.0], n_surfaces=60, seed=3)
AREAS = ("1 mm^2", "2 mm^2")
VALUES = [mcgw.simulate(SCENE.replace(nominal_area=area)) for area in AREAS]


@pytest.fixture(scope="module", params=["values", "statistics", "sweep"])
def dataset(request):
    """One that has two points where it is a sweep, and what VALUES those have."""
    if request.param == "values":
        return VALUES[0], VALUES[0]
    if request.param == "statistics":
        return mcgw.simulate(SCENE, keep="statistics"), VALUES[0]
    return mcgw.sweep(SCENE, {"surface.nominal_area": AREAS}), VALUES


def of(values, get):
    return np.array([get(one) for one in values]) if isinstance(values, list) else get(values)


@pytest.mark.parametrize("name", ["load", "contacts", "pressure", "area_fraction"])
def test_statistics_are_those_of_the_values(dataset, name):
    found, values = dataset
    expected = {
        "mean": of(values, lambda one: one[name].mean(axis=0)),
        "std": of(values, lambda one: one[name].std(axis=0, ddof=1)),
        "stderr": of(values, lambda one: one[name].std(axis=0, ddof=1) / 60**0.5),
        "theory": of(values, lambda one: one.scene.theory.mean(name, one.separations)),
    }
    for kind, numbers in expected.items():
        np.testing.assert_allclose(getattr(found, kind)(name), numbers, rtol=1e-9)
        some = getattr(found.sel(separation=[2.0, 1.0]), kind)(name)
        np.testing.assert_allclose(some, numbers[..., [2, 0]], rtol=1e-9)
    for k in (0, 1):
        ends = of(values, lambda one, k=k: one.interval(name)[k])
        np.testing.assert_allclose(found.interval(name)[k], ends, rtol=1e-9)


def test_what_is_not_kept_is_said_in_one_line(dataset):
    found, values = dataset
    if found is values:
        np.testing.assert_array_equal(found.quantile("load", 0.3), np.quantile(found.load, 0.3, axis=0))
        np.testing.assert_array_equal(found.sel(separation=2.0)["load"], found.load[:, [2]])
    else:
        with pytest.raises(ValueError, match=r"^load: (single surfaces are not kept|a sweep only keeps)"):
            found.quantile("load", 0.3)
    with pytest.raises(ValueError, match=r"share = 1\.5"):
        found.quantile("load", 1.5)
    if isinstance(values, list):
        with pytest.raises(ValueError, match=r"^load: a sweep only keeps"):
            found.covariance("load", "area")
    else:
        both = np.concatenate([values["pressure"], values.area], axis=1)
        expected = np.cov(both, rowvar=False)[:3, 3:]
        np.testing.assert_allclose(found.covariance("pressure", "area"), expected, rtol=1e-9)
        some = found.sel(separation=[2.0, 1.0]).covariance("pressure", "area")
        np.testing.assert_allclose(some, expected[np.ix_([2, 0], [2, 0])], rtol=1e-9)


def test_no_such_quantity_nor_separation(dataset):
    found, _ = dataset
    with pytest.raises(KeyError, match=r"'depth' is not in this (ensemble|sweep); it has load, area"):
        found.std("depth")
    with pytest.raises(ValueError, match=r"^separation = 0\.5: there are 1, 0, 2; scene\.theory has"):
        found.sel(separation=0.5)


@pytest.mark.parametrize("keep", ["sums", "statistics"])
def test_a_comparison_shows_some_of_many_separations_and_its_verdict_is_on_all(keep):
    """The first, the last and some between, in their order; up to a limit all."""
    h = np.linspace(1.5, 0.0, 2 * MOST_SHOWN + 1)
    whole = mcgw.simulate(SCENE, separations=h, n_surfaces=40, keep=keep)
    found = mcgw.compare(whole)
    assert found.of_many == f"at {MOST_SHOWN} of {h.size} separations"
    assert found.of_many in str(found)
    for name, table in found.tables().items():
        shown, mean = (table.only(column).columns[0].values for column in ("separation", "mean"))
        index = [h.tolist().index(x) for x in shown]
        assert (len(index), index[0], index[-1]) == (MOST_SHOWN, 0, h.size - 1)
        assert np.all(np.diff(index) > 0)
        np.testing.assert_array_equal(mean, whole.mean(name)[index])
    assert found.verdict == verdict(whole)
    assert mcgw.compare(whole.sel(separation=h[:MOST_SHOWN])).of_many == ""

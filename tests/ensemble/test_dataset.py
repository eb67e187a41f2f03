"""What an ensemble can, kept statistics and a sweep can too: compared with the values of every surface."""

import numpy as np
import pytest

import mcgw

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


@pytest.mark.parametrize("name", ["load", "contacts", "pressure"])
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


def test_other_forms_have_a_row_a_separation_and_the_axes_before(dataset):
    pytest.importorskip("xarray")
    found, values = dataset
    data = found.to_xarray()
    dims = data["load" if found is values else "load_mean"].dims
    lead = ("surface",) if found is values else ("nominal_area",) if isinstance(values, list) else ()
    assert dims == (*lead, "separation")
    assert len(found.to_dataframe()) == np.prod([60 if found is values else 1, *found.shape, 3])
    assert found.sel(separation=0.0).to_xarray().separation.values.tolist() == [0.0]


def test_no_such_quantity_nor_separation(dataset):
    found, _ = dataset
    with pytest.raises(KeyError, match=r"'depth' is not in this (ensemble|sweep); it has load, area"):
        found.std("depth")
    with pytest.raises(ValueError, match=r"^separation = 0\.5: there are 1, 0, 2; scene\.theory has"):
        found.sel(separation=0.5)

"""Several maps of one surface: one fit of all, and what they scatter is in its errors."""

import math

import numpy as np
import pytest
from scipy.stats import t as student

import mcgw
from mcgw.cli import main
from mcgw.maps import Spectrum, Topography, gaussian_map, moments_on_grid

SPECTRUM = Spectrum(1e-6, 60e-6, 16e-6)
PIXEL = (1e-6, 1e-6)


def drawn(seed, shape=(200, 200), times=1.0):
    found = gaussian_map(SPECTRUM, shape, PIXEL, np.random.default_rng(seed))
    return Topography(times * found.heights, PIXEL)


@pytest.fixture(scope="module")
def maps():
    """Two small ones and a large one."""
    return [drawn(1), drawn(2), drawn(3, (200, 500))]


@pytest.fixture(scope="module")
def fits(maps):
    return [mcgw.fit(z, cutoff=None) for z in maps]


@pytest.fixture(scope="module")
def found(maps):
    return mcgw.fit(maps, cutoff=None)


def weighted(fits, of):
    areas = [fit.area for fit in fits]
    return sum(a * of(fit) for a, fit in zip(areas, fits, strict=True)) / sum(areas)


def test_moments_are_means_over_the_area(fits, found):
    assert found.area == pytest.approx(sum(fit.area for fit in fits))
    for name in ("m0", "m2", "m4"):
        expected = weighted(fits, lambda fit: fit.numbers[name].value)  # noqa: B023
        assert found.numbers[name].value == pytest.approx(expected, rel=1e-12)
        assert getattr(found.moments, name) == pytest.approx(expected, rel=1e-12)
    m, told = found.moments, found.estimates["moments"]
    assert found.numbers["alpha"].value == pytest.approx(m.m0 * m.m4 / m.m2**2)
    of_moments = told.eta.value, told.radius.value, told.sigma.value
    assert of_moments == pytest.approx((m.eta, m.radius, m.sigma), rel=1e-12)
    for name, power in (("sk", 3), ("ku", 4)):
        expected = weighted(fits, lambda fit: getattr(fit.roughness, name) * fit.roughness.q**power)  # noqa: B023
        assert getattr(found.roughness, name) == pytest.approx(expected / found.roughness.q**power)
    third = weighted(fits, lambda fit: fit.skewness[0] * fit.numbers["m0"].value ** 1.5)
    assert found.skewness[0] == pytest.approx(third / found.numbers["m0"].value ** 1.5)
    squares = [(fit.area * fit.skewness[1] * fit.moments.m0**1.5) ** 2 for fit in fits]
    assert found.skewness[1] == pytest.approx(math.sqrt(sum(squares)) / found.area / m.m0**1.5, rel=1e-12)


def test_summits_are_those_of_all_maps(fits, found):
    heights = np.concatenate([fit.summits + fit.mean_summit for fit in fits])
    assert found.summits == pytest.approx(heights - heights.mean(), abs=1e-20)
    assert found.mean_summit == pytest.approx(heights.mean(), rel=0.01)  # weights as estimated and as counted
    assert found.radii.size == found.listed.tile.size == heights.size
    assert np.bincount(found.listed.tile).tolist() == [fit.summits.size for fit in fits]
    each = [fit.estimates["summits"] for fit in fits]
    numbers = np.array([e.eta.value * fit.area for e, fit in zip(each, fits, strict=True)])
    told = found.estimates["summits"]
    assert told.eta.value == pytest.approx(numbers.sum() / found.area)
    curvature = sum(n / e.radius.value for n, e in zip(numbers, each, strict=True)) / numbers.sum()
    assert told.radius.value == pytest.approx(1 / curvature)
    within = sum(n * e.sigma.value**2 for n, e in zip(numbers, each, strict=True)) / numbers.sum()
    between = np.cov([fit.mean_summit for fit in fits], aweights=numbers, ddof=0)
    assert told.sigma.value == pytest.approx(math.sqrt(within + between))
    assert list(found.tiles.columns[0].values) == ["map 1", "map 2", "map 3"]


def test_errors_are_of_the_maps_or_between_them(fits, found):
    """The larger one, by hand: a weighted mean of logarithms, and Student's t for two degrees of freedom."""
    weights, larger = np.array([fit.area for fit in fits]) / found.area, set()
    for name in ("m0", "m2", "m4", "alpha"):
        values, errors = np.transpose([(fit.numbers[name].value, fit.numbers[name].relative) for fit in fits])
        within, logs = math.sqrt(sum((weights * errors) ** 2)), np.log(values)
        scatter = sum(weights**2 * (logs - sum(weights * logs)) ** 2)
        between = math.sqrt(1.5 * scatter) * student.ppf(0.977249868, 2) / 2
        assert found.numbers[name].relative == pytest.approx(max(within, between), rel=1e-6)
        larger.add(within > between)
    assert larger == {True, False}


def test_one_map_four_times_has_its_numbers_and_half_of_its_errors(maps, fits):
    """Four equal maps scatter by nothing; their own errors are taken as independent."""
    found, one = mcgw.fit([maps[0]] * 4, cutoff=None), fits[0]
    for name in ("m0", "m2", "m4", "alpha"):
        told, own = found.numbers[name], one.numbers[name]
        assert told.value == pytest.approx(own.value, rel=1e-12)
        assert told.relative == pytest.approx(own.relative / 2, rel=1e-9)
        for end in ("low", "high"):
            ends = [math.log(getattr(x, end) / x.value) for x in (told, own)]
            assert ends[0] == pytest.approx(ends[1] / 2, rel=1e-9)
    assert found.waves.independent == pytest.approx(4 * one.waves.independent)
    assert found.waves.covariance == pytest.approx(one.waves.covariance / 4)
    told, own = found.estimates["summits"], one.estimates["summits"]
    for name in ("eta", "radius", "sigma"):
        assert getattr(told, name).value == pytest.approx(getattr(own, name).value, rel=1e-9)


@pytest.mark.parametrize(("errors", "named"), [(3.0, False), (4.5, True)])
def test_maps_are_named_beyond_what_chance_makes(maps, fits, errors, named):
    """A map and the same one higher, by so many errors of the difference: 3 in 370 pairs, 4.5 in 150 000."""
    surest = min(fits[0].numbers[name].relative for name in ("m0", "m2", "m4"))
    higher = Topography(maps[0].heights * math.exp(errors * surest / math.sqrt(2)), PIXEL)
    cautions = mcgw.fit([maps[0], higher], cutoff=None).cautions
    assert any(line.startswith("maps:") for line in cautions) == named


def test_a_caution_of_one_map_names_it_and_what_is_not_of_one_surface_is_told(maps):
    spiked = Topography(maps[0].heights.copy(), PIXEL)
    spiked.heights[100, 100] += 30e-6
    told = mcgw.fit([maps[1], spiked, drawn(4, times=2.0)], cutoff=None).cautions
    (line,) = [line for line in told if line.startswith("spikes")]
    assert line.endswith("(map 2)")
    (line,) = [line for line in told if line.startswith("maps: mean square slopes")]
    assert 3 < float(line.partition("factor of ")[2].split()[0]) < 5


def test_what_does_not_go_together_is_refused(tmp_path, in_tmp_path, capsys, maps):
    np.save("a.npy", maps[0].heights)
    np.savetxt("b.csv", maps[1].heights)
    z = 1e-7 * np.random.default_rng(1).normal(size=50)
    np.savetxt("p.txt", np.column_stack([np.arange(50) * 1e-6, z]))
    words = ["--pixel", "1um", "--cutoff", "none", "-o", "f.toml"]
    for files, line in (
        (["a.npy", "p.txt"], "p.txt: a profile, and a.npy is a map; fit them apart"),
        (["a.npy", "a.npy", "--picture", "p.png"], "--picture p.png: draws one map; give one"),
        (["a.npy", "b.csv", "--tiles", "b.csv"], "--tiles b.csv: is an input (b.csv)"),
    ):
        assert main(["fit", *files, *words]) == 2
        assert line in capsys.readouterr().err
    assert not (tmp_path / "f.toml").exists()
    assert np.loadtxt("b.csv") == pytest.approx(maps[1].heights)


@pytest.mark.slow
def test_intervals_of_pooled_moments_cover():
    """20 surfaces of 4 maps: 72 of 80 intervals hold; 95 % misses that twice in 100, 80 % in 99 of 100."""
    held = []
    for k in range(20):
        maps = [drawn(1000 + 4 * k + i, (160, 160)) for i in range(4)]
        found = mcgw.fit(maps, cutoff=None, form="none")
        truth = moments_on_grid(SPECTRUM, (160, 160), PIXEL)
        for name, true in (("m0", truth.m0), ("m2", truth.m2), ("m4", truth.m4), ("alpha", truth.alpha)):
            told = found.numbers[name]
            held.append(told.low <= true <= told.high)
    assert sum(held) >= 72

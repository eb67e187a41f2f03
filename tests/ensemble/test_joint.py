"""Gap conductance of a gas: check values of Yovanovich's integral, limits, and whose heights count."""

import itertools
import math

import numpy as np
import pytest
from oracles.inside import correlation
from oracles.interacting_by_hand import LATTICE, MEAN_SINKING
from oracles.scenes import scene_by
from scipy.integrate import quad

import analytic
import mcgw
from analytic.joint import Gas, Joint, gap_integral

SURFACE = analytic.Surface(sigma=0.9e-6, radius=1e-5, eta=1e10, nominal_area=1e-4, E_star=1e11)


def gas_of(name, temperature=293.15, pressure=101325.0):
    return Joint(name, temperature=temperature, gas_pressure=pressure).held


@pytest.mark.parametrize(("y", "m", "value"), [
    (3, 0.1, 0.37663374387822), (2, 1, 0.357567566339058), (4, 0.01, 0.269913675556762),
    (0, 0.3, 0.618189222135803),
])  # fmt: skip
def test_check_values(y, m, value):
    assert float(gap_integral(y, m)) == pytest.approx(value, rel=1e-13)


def test_limits_and_many_distances():
    """Far apart two walls at a distance; many are interpolated to as many digits."""
    assert float(gap_integral(1e6, 0.5)) == pytest.approx(1 / (1e6 + 0.5), rel=1e-11)
    many = np.linspace(-2.0, 14.0, 9001)
    few = many[::900]
    np.testing.assert_allclose(gap_integral(many, 0.1)[::900], gap_integral(few, 0.1), rtol=1e-13)
    literal = quad(lambda x: math.exp(-((few[5] - x) ** 2) / 2) / (x + 0.1), 0, 20, points=(0.1, few[5]))[0]
    assert float(gap_integral(few[5], 0.1)) == pytest.approx(literal / math.sqrt(2 * math.pi), rel=1e-9)


def test_the_rms_is_that_of_the_surface():
    """By Nayak's heights, or given: both tell alpha and the offset; that of the summits is another one."""
    heights = analytic.Nayak(5.0)
    known = Joint("air").gap(SURFACE, heights)
    given = Joint("air", rms=SURFACE.sigma / heights.std).gap(SURFACE, analytic.Gaussian())
    assert given.rise == pytest.approx(known.rise, rel=1e-12)
    assert float(given(2.0)) == pytest.approx(float(known(2.0)), rel=1e-12)
    wrong = gas_of("air").conductivity / SURFACE.sigma * gap_integral(2.0, gas_of("air").jump / SURFACE.sigma)
    assert abs(float(wrong) / float(known(2.0)) - 1) > 0.1
    assert Joint({"conductivity": 0.15, "jump": 1e-6}).held == Gas(0.15, 1e-6)


def test_air_is_that_of_the_standard_atmosphere():
    """0.025326 W/(m K) at sea level (1976); Sutherland's law at 373.15 K, and jumps, by hand."""
    assert gas_of("air", 288.15).conductivity == pytest.approx(0.025326, rel=2e-5)
    assert gas_of("air", 373.15).conductivity == pytest.approx(0.0317379, rel=2e-5)
    paths = 2 * 1.13 / 0.87 * 2.8 / (2.4 * 0.71)
    assert gas_of("air", 576.0, 101325.0 / 4).jump == pytest.approx(8 * 64e-9 * paths, rel=1e-12)
    assert Joint("air").held == gas_of("air")


# mW/(m K) at 300, 400 and 500 K of the CRC Handbook; g/mol; viscosity at 288 K, uPa s; atoms in a molecule.
PUBLISHED = {
    "argon": ((17.9, 22.6, 26.8), 39.948, 22.1, 1),
    "helium": ((156.7, 190.6, 222.3), 4.0026, 19.4, 1),
    "hydrogen": ((186.9, 230.4, None), 2.0159, 8.7, 2),
    "nitrogen": ((26.0, 32.3, 38.3), 28.013, 17.4, 2),
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_gases_are_those_of_tables_and_of_kinetic_theory(name):
    """Conductivities to 1.5 %; jumps to 2 %, from L = mu/p sqrt(pi R T/(2 M)) and Song's accommodation."""
    conductivities, molar, viscosity, atoms = PUBLISHED[name]
    for t, known in zip((300, 400, 500), conductivities, strict=True):
        if known is not None:
            assert gas_of(name, t).conductivity == pytest.approx(known * 1e-3, rel=0.015)
    mass = molar * 1e-3
    path = viscosity * 1e-6 / 101325 * np.sqrt(np.pi * 8.314 * 288 / (2 * mass))
    accommodation = molar * (1.4 if atoms == 2 else 1) / (molar * (1.4 if atoms == 2 else 1) + 6.8)
    heats = 5 / 3 if atoms == 1 else 7 / 5
    prandtl = 4 * heats / (9 * heats - 5)  # Eucken's
    jump = 2 * (2 - accommodation) / accommodation * 2 * heats / ((heats + 1) * prandtl) * path
    assert gas_of(name, 288).jump == pytest.approx(jump, rel=0.02 if atoms == 1 else 0.09)
    assert gas_of(name, 576, 101325 / 4).jump == pytest.approx(8 * gas_of(name, 288).jump, rel=1e-12)


# --- in scenes ---

FILM = {"conductivities": (200.0, 16.0)}
ROUGH = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3.0e8, nominal_area=1e-6, E_star=78.6e9)
AIR, VACUUM = {**FILM, "gas": "air", "rms": "2 um"}, {**FILM, "gas": "vacuum"}
H = (1.5, 2.0)
OWN = {  # modes of interaction, and the separation that differs from surface to surface and tells the gap
    "alone": (None, None),
    "body": ("body", None),
    "plane": ("mean-plane", "nominal_separation"),
}


def scene_of(**changes):
    asked = {"separations": H, "joint": AIR, "seed": 3, "n_surfaces": 40}
    return scene_by(ROUGH, **asked | changes)


def by_hand(h, gas="air"):
    """Gap conductance at a distance over sigma, by the integral as it is written."""
    rms, gas, sigma = 2e-6, gas_of(gas), ROUGH.sigma
    alpha = (1 + 16 / math.pi - 3 * math.sqrt(3)) / (1 - (sigma / rms) ** 2)
    y, m = (h * sigma + 4 * rms / math.sqrt(math.pi * alpha)) / rms, gas.jump / rms
    ends = (0, m, 4 * m, 1, *((y,) if y > 1 else ()), y + 4, y + 12)
    parts = [
        quad(lambda x: math.exp(-((y - x) ** 2) / 2) / (x + m), *pair, epsabs=0, epsrel=1e-13)[0]
        for pair in itertools.pairwise(ends)
    ]
    return gas.conductivity / rms * sum(parts) / math.sqrt(2 * math.pi)


@pytest.mark.parametrize("mode", OWN)
def test_vacuum_is_the_spots_alone_and_no_contact_the_gas(mode):
    vacuum = mcgw.simulate(scene_of(interaction=OWN[mode][0], joint=VACUUM))
    np.testing.assert_allclose(vacuum["joint_conductance"], vacuum["contact_conductance"], rtol=1e-14)
    far = mcgw.simulate(scene_of(separations=9.0))
    np.testing.assert_array_equal(far["joint_conductance"], far["gap_conductance"])


@pytest.mark.parametrize("mode", OWN)
def test_many_have_the_mean_and_spread_of_theory(mode):
    """|z| < 5 of means, 7 of spreads: false alarms 6e-7 a number. The gap at the wrong plane fails."""
    interaction, own = OWN[mode]
    n = 4000
    scene = scene_of(interaction=interaction, n_surfaces=n)
    e, theory = mcgw.simulate(scene), scene.theory
    for name in scene.of_joint:
        mean, std = theory.mean(name, H), theory.std(name, H)
        if own is None and name == "gap_conductance":
            np.testing.assert_array_equal(e.mean(name), mean)
            assert (std == 0).all()
            continue
        assert np.abs((e.mean(name) - mean) / std * math.sqrt(n)).max() < 5
        assert e.std(name) == pytest.approx(std, rel=5 / math.sqrt(n))
    if own is not None:
        std = theory.std("gap_conductance", H)
        wrong = scene.filled(H) - e.mean("gap_conductance")
        assert (np.abs(wrong) / std * math.sqrt(n) > 10).any()
    covariance = theory.covariance(["joint_conductance", "load"], H)
    found = e.covariance("joint_conductance", "load")
    np.testing.assert_allclose(np.diag(found), np.diag(covariance[0, :, 1]), rtol=6.3 / math.sqrt(n))
    assert mcgw.compare(e).verdict.agrees


def network(scene, spots, h, load):
    """Gap and joint conductance from spots by themselves: 1/h = 1/(h_spots + h_gas) + R_bodies A_n."""
    area, rho, bodies = scene.surface.nominal_area, 1 / 200 + 1 / 16, 0.0
    spots = spots / area
    if scene.interaction and scene.interaction.reference == "body":
        bodies = MEAN_SINKING / 2 * rho * math.sqrt(area)
    elif scene.interaction:
        other = LATTICE / math.pi / math.sqrt(scene.n_asperities * area)  # m of the mean plane for each P/E*
        spots = 1 / (1 / spots - rho / 2 * other * area)
        h = h + other * load / ROUGH.E_star / ROUGH.sigma
    gas = np.vectorize(by_hand)(h)
    return gas, 1 / (1 / (spots + gas) + bodies)


BESIDE = [
    (None, 1e-6, {"film_resistance": 1e-8}), ("mean-plane", 1e-4, {"layer": analytic.Layer(1e-5, 1.3)}),
    ("mean-plane", 1e-8, {}), ("body", 1e-6, {"film_resistance": 1e-8}),
]  # fmt: skip


def with_and_without_gas(reference, area, film):
    asked = {"n_asperities": 3000, "n_surfaces": 6}
    scene = scene_of(**asked, joint=AIR | film, interaction=reference).replace(nominal_area=area)
    return scene, scene_of(**asked, joint=FILM | film).replace(nominal_area=area)


@pytest.mark.parametrize(("reference", "area", "film"), BESIDE)
def test_network_by_hand(reference, area, film):
    """Of every specimen at a separation."""
    scene, alone = with_and_without_gas(reference, area, film)
    e, single = mcgw.simulate(scene), mcgw.simulate(alone)
    gas, joint = network(scene, single["conductance_si"], np.tile(H, (6, 1)), single["load"])
    np.testing.assert_allclose(e["gap_conductance"], gas, rtol=1e-11)
    np.testing.assert_allclose(e["joint_conductance"], joint, rtol=1e-12)


@pytest.mark.parametrize(
    ("reference", "area", "film"), [BESIDE[0], pytest.param(*BESIDE[1], marks=pytest.mark.slow)]
)
def test_network_at_a_load_by_hand(reference, area, film):
    """Of the infinite surface and of specimens."""
    scene, alone = with_and_without_gas(reference, area, film)
    found, single = (mcgw.solve(x, pressure="1 MPa") for x in (scene, alone))
    for at, own in ((found.theory, single.theory), (found.surfaces, single.surfaces)):
        _, joint = network(scene, own["conductance_si"], own["separation"], 1e6 * area)
        np.testing.assert_allclose(at["joint_conductance"], joint, rtol=1e-11)
        np.testing.assert_allclose(at["thermal_resistance"], 1 / (joint * area), rtol=1e-11)


def test_distribution_of_a_joint_before_bodies():
    """As the specimens, at a separation; Hoeffding: false alarms 1e-6."""
    scene = scene_of(interaction="body", n_surfaces=2000)
    law = scene.theory.distribution("joint_conductance", 2.0)
    values = mcgw.simulate(scene)["joint_conductance"][:, 1]
    for share in (0.1, 0.5, 0.9):
        assert abs(np.mean(values <= law.ppf(share)) - share) < math.sqrt(math.log(2e6) / 2 / 2000)


def test_way_back_and_laws():
    scene = scene_of(
        law=analytic.KogutEtsion(critical=0.05), unload_from=1.0, interaction="mean-plane", n_surfaces=2000
    )
    e, name = mcgw.simulate(scene), "joint_conductance_unloading"
    gas = e["gap_conductance_unloading"]
    np.testing.assert_allclose(e[name], e["conductance_si_unloading"] / ROUGH.nominal_area + gas, rtol=1e-14)
    np.testing.assert_allclose(gas, scene.filled(e["nominal_separation_unloading"]), rtol=1e-14)
    mean, std = (get(name, H) for get in (scene.theory.mean, scene.theory.std))
    assert np.abs((e.mean(name) - mean) / std * math.sqrt(2000)).max() < 5


def test_slopes_of_the_joint():
    model, step = scene_of().theory, 1e-4
    for name in ("gap_conductance", "joint_conductance"):
        fall = float(model.mean(name, 1.5 - step) - model.mean(name, 1.5 + step)) / (2 * step)
        assert float(model.slope(name, 1.5)) == pytest.approx(fall, rel=1e-6)


def test_a_fit_tells_the_surface():
    """[fitted] knows rms and alpha; what is given as rms goes before."""
    fitted = {"m0": 4e-12, "m2": 1e-3, "m4": 5e6, "skewness": 0.0, "kurtosis": 3.0, "independent": 900.0}
    gap = scene_of(joint={**FILM, "gas": "air"}, fitted=fitted).filled
    assert (gap.rms, gap.rise) == (2e-6, pytest.approx(4 * 2e-6 / math.sqrt(math.pi * 20) / ROUGH.sigma))
    assert scene_of(fitted=fitted, joint={**AIR, "rms": 3e-6}).filled.rms == 3e-6


@pytest.mark.parametrize("law", [{"name": "hertz"}, {"name": "kogut-etsion", "hardness": "2.5 GPa"}])
def test_the_table_of_a_joint_has_its_correlation(law):
    """By hand from m0 and m2: Mikic's of elastic spots, Cooper, Mikic and Yovanovich's of yielding ones."""
    spectral = mcgw.SpectralSurface(1e-12, 1e-2, 5e8, "1 mm^2", "80 GPa")
    film = mcgw.Joint(conductivities=(150.0, 50.0))
    scene = mcgw.Scene(spectral, separations=1.0, n_surfaces=2, seed=1, joint=film, law=law)
    m, k, p = np.sqrt(2e-2 / np.pi), 75.0, np.array([1e6, 1e7])
    if law["name"] == "hertz":
        by_hand = 1.55 * k * m / 1e-6 * (p * np.sqrt(2) / (80e9 * m)) ** 0.94
    else:
        by_hand = 1.25 * k * m / 1e-6 * (p / 2.5e9) ** 0.95
    np.testing.assert_allclose(correlation(scene, p), by_hand, rtol=1e-9)
    assert correlation(scene.replace(joint=mcgw.Joint(resistivity=1e-7, film_resistance=1e-12)), p) is None
    plain = mcgw.Surface("1 um", "13 um", "300/mm^2", "1 mm^2", "80 GPa")
    assert correlation(mcgw.Scene(plain, separations=1.0, n_surfaces=2, joint=film), p) is None

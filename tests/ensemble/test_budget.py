"""What an answer may be off by, line by line: against redraws and scaling laws."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.inside import mean_surface
from oracles.scenes import scene_by
from scipy.stats import norm, qmc

import mcgw
from mcgw.cli import main
from mcgw.ensemble.budget import moved, slopes_of
from mcgw.maps import gaussian_map, spectrum_from

SURFACE = mcgw.Surface("1 um", "13 um", "1000/mm^2", "1 cm^2", "78.6 GPa")  # eta R sigma = 0.013
ERRORS = {
    "sigma": "20 %", "radius": 0.15, "eta": 0.12, "E_star": 0.05,
    "correlation": [[1, 0.1, -0.8, 0], [0.1, 1, 0.2, 0], [-0.8, 0.2, 1, 0], [0, 0, 0, 1]],
}  # fmt: skip
YIELDS = mcgw.KogutEtsion(hardness=8e9)
NAMES = ("area", "stiffness", "conductance", "gap_to_summits")


def scene_of(**more):
    given = {"separations": 1.0, "n_surfaces": 20, "seed": 1, "uncertainty": ERRORS} | more
    return scene_by(given.pop("surface", SURFACE), **given)


@pytest.fixture(scope="module")
def solved():
    return mcgw.solve(scene_of(), pressure="50 MPa")


def redrawn(scene, pressure, draws):
    """Logarithms of the answers of the exact theory for parameters drawn by their covariance."""
    unit = norm.ppf(qmc.Sobol(len(scene.uncertainty.names), seed=1).random(draws))
    steps = unit @ np.linalg.cholesky(scene.uncertainty.covariance).T
    load, found = pressure * scene.surface.nominal_area, []
    for row in steps:
        factors = dict(zip(scene.uncertainty.names, np.exp(row), strict=True))
        again = scene.replace(**{x: getattr(scene.surface, x) * f for x, f in factors.items()})
        h = float(again.theory.separation_at("load", load))
        found.append([float(again.theory.mean(x, h)) for x in NAMES[:3]])
    return np.log(found)


@pytest.mark.slow
@pytest.mark.parametrize("law", [None, YIELDS])
def test_the_parameters_line_is_that_of_redraws(law):
    """128 points of a sequence tell a deviation to 1 %; 5 % are asked."""
    solved = mcgw.solve(scene_of(law=law), pressure="50 MPa")
    scatter = 1.96 * redrawn(solved.scene, 50e6, 128).std(axis=0)
    np.testing.assert_allclose(solved.budget().shares["parameters"][:3], scatter, rtol=0.05)
    together = [[1, 0.9, 0, 0], [0.9, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]  # sqrt(R/sigma) hardly changes
    other = replace(solved.scene.uncertainty, correlation=together)
    shares = replace(solved, scene=solved.scene.replace(uncertainty=other)).budget().shares
    assert shares["parameters"][0] < 0.8 * scatter[0]  # a wrong covariance would be seen


@pytest.mark.parametrize("interaction", [None, "mean-plane"])
def test_derivatives_obey_what_scales(interaction):
    """By E* as by one over the load; by eta as A_n would, where no asperity feels another."""
    every = dict.fromkeys(("sigma", "radius", "eta", "E_star"), 0.1)
    scene = scene_of(interaction=interaction, uncertainty=every)
    of = ("area", "stiffness", "gap_to_summits")
    by = slopes_of(scene, scene.uncertainty, lambda s: mean_surface(s, "load", 5e3), of)
    ends = [mean_surface(scene, "load", 5e3 * np.exp(step)) for step in (1e-3, -1e-3)]
    by_load = np.array([(ends[0][x] - ends[1][x]) / 2e-3 / mean_surface(scene, "load", 5e3)[x] for x in of])
    np.testing.assert_allclose(by[:, 3], [0, 1, 0] - by_load, atol=1e-5)
    if interaction is None:
        extensive = np.array([1, 1, 0])
        np.testing.assert_allclose(by[:, 2], extensive - by_load, atol=1e-5)
        lengths = by[:, 0] + by[:, 1] - 2 * by[:, 2] + 2 * extensive  # all by c, with eta by c^-2, A_n by c^2
        np.testing.assert_allclose(lengths, [2, 1, 1], atol=1e-5)


def test_lines_of_surfaces_by_hand(solved):
    budget = solved.budget()
    for k, name in enumerate(NAMES):
        low, high = solved.interval(name)
        assert budget.shares["drawn surfaces"][k] == pytest.approx((high - low) / 2 / solved.value[name])
        assert budget.shares["specimens"][k] == pytest.approx(1.96 * solved.std[name] / solved.value[name])
    v = solved.scene.validity(solved.theory["separation"])
    assert budget.shares["model"][0] == pytest.approx(v.error["area"][0])
    assert budget.shares["model"][2] == budget.shares["model"][1]
    gap = v.error["separation"][0] * solved.scene.surface.sigma / solved.value["gap_to_summits"]
    assert budget.shares["model"][3] == pytest.approx(gap)
    squares = sum(share**2 for share in budget.shares.values())
    np.testing.assert_allclose(budget.all, np.sqrt(squares))


def test_what_dominates_is_said_with_what_would_lower_it(solved):
    assert "parameters (above all radius)" in solved.budget().advice
    bare = replace(solved, scene=solved.scene.replace(uncertainty=None)).budget()
    assert "mostly the model" in bare.advice
    small = scene_of(uncertainty=None).replace(nominal_area="0.2 mm^2")
    few = mcgw.solve(small, pressure="50 MPa").budget()
    assert "mostly the specimens" in few.advice


def test_corrected_is_divided_by_its_bias(solved):
    v = solved.scene.validity(solved.theory["separation"])
    for name, column in (("area", "area"), ("stiffness", "stiffness"), ("conductance", "stiffness")):
        found = solved.corrected(name)
        bias = v.bias[column][0]
        assert found.value * (1 + bias) == pytest.approx(solved.value[name])
        most = (v.error[column][0] - abs(bias)) / (1 + bias)  # of the very summits of a surface
        most = np.hypot(most, 1.96 * solved.std[name] / solved.value[name])
        assert found.high / found.value == pytest.approx(1 + most)
        assert found.low * found.high == pytest.approx(found.value**2)
    gap, sigma = solved.corrected("gap_to_summits"), solved.scene.surface.sigma
    assert gap.value == pytest.approx(solved.value["gap_to_summits"] - sigma * v.bias["separation"][0])
    off = sigma * (v.error["separation"][0] - abs(v.bias["separation"][0]))
    off = np.hypot(off, 1.96 * solved.std["gap_to_summits"])
    assert gap.high - gap.value == pytest.approx(off)
    assert "contacts: its error was not measured" in solved.corrected("contacts").why
    assert solved.corrected("area").value in solved.table().only("best").columns[0].values


@pytest.mark.parametrize("gas", ["air", "vacuum"])
def test_a_joint_is_corrected_through_its_network(gas):
    """Spots as stiffness, gas at the corrected gap, side by side: by hand."""
    joint = mcgw.Joint((200.0, 16.0), gas=gas, rms=2e-6)
    solved = mcgw.solve(scene_of(joint=joint, uncertainty=None), pressure="50 MPa")
    scene, value, v = solved.scene, solved.value, solved.against_elasticity
    (bias, error), (lift, gap) = ((v.bias[x][0], v.error[x][0]) for x in ("stiffness", "separation"))
    spots, found = solved.corrected("contact_conductance"), solved.corrected("joint_conductance")
    assert spots.value == pytest.approx(value["contact_conductance"] / (1 + bias))
    right = value["separation"] - lift
    assert found.value / value["joint_conductance"] == pytest.approx(
        (spots.value + scene.filled(right))
        / (value["contact_conductance"] + scene.filled(value["separation"])),
        rel=1e-9,
    )
    slope = (scene.filled(right + 1e-3) - scene.filled(right - 1e-3)) / 2e-3
    off = np.hypot(spots.value * (error - abs(bias)) / (1 + bias), slope * (gap - abs(lift)))
    off /= spots.value + scene.filled(right)
    own = 1.96 * solved.std["joint_conductance"] / value["joint_conductance"]
    low, high = solved.interval("joint_conductance")  # not a sum of asperities: of 20 surfaces
    drawn = (high - low) / 2 / value["joint_conductance"]
    assert drawn > 0 or scene.filled.gas is None  # in vacuum it is the sum over spots, exactly
    assert found.high / found.value - 1 == pytest.approx(np.sqrt(off**2 + own**2 + drawn**2), rel=1e-5)
    assert np.isfinite(solved.budget().all).all()


def test_spots_with_a_film_have_no_corrected_conductance():
    film = mcgw.Joint(resistivity=0.07, film_resistance=1e-8)
    solved = mcgw.solve(scene_of(joint=film, uncertainty=None), pressure="50 MPa")
    budget = solved.budget()
    assert np.isnan(budget.all).tolist() == [x == "contact_conductance" for x in budget.quantities]
    assert solved.corrected("contact_conductance").why.startswith("a film or layer is not")


PULLS = {"name": "derjaguin-muller-toporov", "pull_off": 1e-3}


@pytest.mark.parametrize(
    ("more", "given", "name", "why"),
    [
        ({}, {"area_fraction": 0.01}, "load", "model (its error was measured at a given load"),
        ({"law": PULLS}, {"pressure": "50 MPa"}, "area", "not measured: only for Hertz's law"),
    ],
)
def test_where_nothing_was_measured_the_answer_stays_alone(more, given, name, why):
    solved = mcgw.solve(scene_of(**more), **given)
    budget, corrected = solved.budget(), solved.corrected(name)
    assert budget.quantities[0] == name
    assert np.isnan(budget.shares["model"]).all()
    assert why in f"{budget.advice} {corrected.why}"
    assert np.isnan(corrected.value)
    assert budget.lacking["model"] == solved.against_elasticity.unknown or not more
    assert np.isnan(solved.table().only("best").columns[0].values).all()
    assert "best (95" not in repr(solved)


def test_a_fit_writes_what_it_knows(tmp_path, capsys):
    """Errors of the estimate in use; sigma^2 and eta go apart where m2 is uncertain."""
    spectrum = spectrum_from("rms=1um,long=8um,short=2um")
    z = gaussian_map(spectrum, (128, 128), (0.25e-6, 0.25e-6), np.random.default_rng(7))
    fit = mcgw.fit(z, cutoff=None)
    scene = mcgw.fitted_scene(fit, use="summits", separations=[1.0], n_surfaces=5, E_star="1 GPa")
    used = fit.estimates["summits"]
    for name in ("sigma", "radius", "eta"):
        assert getattr(scene.uncertainty, name) == pytest.approx(getattr(used, name).relative)
    assert scene.uncertainty.correlation[0][2] < -0.2
    by_moments = mcgw.fitted_scene(fit, heights="nayak", E_star="1 GPa").uncertainty
    assert by_moments.m0 == pytest.approx(fit.numbers["m0"].relative)
    assert by_moments.correlation[0][1] > 0.2
    assert mcgw.fitted_scene(fit, heights="summits", E_star="1 GPa").uncertainty is None
    (tmp_path / "s.toml").write_text(mcgw.scene_text(scene))
    assert main(["solve", str(tmp_path / "s.toml"), "--pressure", "10MPa", "1MPa", "-v"]) == 0
    out = capsys.readouterr().out
    assert out.count("Sources of error, at the load") == 2
    assert out.count("parameters ") >= 2


@pytest.mark.parametrize("name", ["m0", "m2", "m4"])
def test_a_moment_moves_all_that_is_made_of_it(name):
    """A scene of other moments is the one that is made of them; its flattest summit stays."""

    def made(**more):
        m = {"m0": 1e-12, "m2": 1e-3, "m4": 5e6} | more
        spectral = mcgw.SpectralSurface(**m, nominal_area=1e-6, E_star=1e11)
        alpha, radius = m["m0"] * m["m4"] / m["m2"] ** 2, spectral.surface.radius
        return mcgw.Scene(spectral, separations=[1.0], summits=mcgw.RandomCurvature(alpha, 1e-5 / radius))

    other = made(**{name: 1.1 * {"m0": 1e-12, "m2": 1e-3, "m4": 5e6}[name]})
    found = moved(made(), {name: np.log(1.1)})
    for key in ("sigma", "radius", "eta", "nominal_area", "E_star"):
        assert getattr(found.surface, key) == pytest.approx(getattr(other.surface, key), rel=1e-12)
    for key in ("alpha", "largest"):
        assert getattr(found.summits, key) == pytest.approx(getattr(other.summits, key), rel=1e-12)
    assert found.heights.alpha == found.summits.alpha

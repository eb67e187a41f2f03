"""Given a load, the separation: back through the simulator, against an exact law, and as typed."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.inside import crossing, solutions, solutions_text
from scipy.stats import t as student

import analytic
import mcgw
from mcgw.cli import main


@pytest.fixture(scope="module")
def scene(make_scene):
    return make_scene(separations=(0.0,), n_surfaces=300, seed=5)


@pytest.mark.parametrize("gamma", [1.5, 3.0])
def test_light_loads_on_softer_tips(scene, gamma):
    """Six decades: the search starts far below the answer, where moduli are negative that nothing touches.

    One asperity at unit approach carries 0.6 N. What the answers say of load and area is added up anew.
    """
    grading = analytic.Exponential(gamma)
    loads = [3e2, 3.0, 3e-2, 3e-4]
    graded = scene.replace(grading=grading, n_surfaces=20)
    found = solutions(graded, "load", loads, draw=True)
    for load, solution in zip(loads, found, strict=True):
        for number, h in enumerate(solution.surfaces["separation"]):
            assert h > grading.zero
            assert literal(solution, number)[0] == pytest.approx(load, rel=1e-9)
        exact = float(analytic.load(scene.surface, solution.theory["separation"], grading))
        assert exact * scene.n_asperities / scene.surface.n_asperities == pytest.approx(load, rel=1e-10)


def literal(found, number):
    """Hertz's load and area, added up over the very summits of a surface."""
    scene, s, radii = found.scene, found.heights(number), found.radii(number)
    depth = (s - found.surfaces["separation"][number]) * scene.surface.sigma
    assert np.all(depth > 0)
    load = 4 / 3 * scene.surface.E_star * np.sum(np.sqrt(radii) * depth**1.5 * scene.modulus(s))
    return load, np.pi * np.sum(radii * depth)


@pytest.mark.parametrize("negative", ["clip", "allow"])
def test_negative_moduli_as_the_scene_wants_them(scene, negative):
    """Clipped they carry nothing, allowed they pull."""
    wanted = scene.replace(negative=negative, n_asperities=20, n_surfaces=100)
    (solution,) = solutions(wanted, "load", [14.0], draw=True)
    below = 0
    for number in range(100):
        assert literal(solution, number)[0] == pytest.approx(14.0, rel=1e-10)
        below += bool(np.any(scene.grading(solution.heights(number)) < 0))
    assert below > 3


YIELDS = analytic.KogutEtsion(critical=0.05)
FEW = {"n_asperities": 8, "count": "poisson", "n_surfaces": 20, "grading": None}
SOFTER = {"grading": mcgw.Exponential(-0.5), "negative": "clip", "n_asperities": 2, "n_surfaces": 400}


@pytest.mark.parametrize(
    ("changes", "load", "words"),
    [
        ({}, 5e3, "^load = 5000 N: the mean surface reaches it only with asperities of negative modulus"),
        (  # which the mean surface does not reach
            {"n_asperities": 20, "n_surfaces": 100}, 14.0,
            r"^load = 14 N: surface \d+ reaches it only with .* s = -[\d.]+; give",
        ),
        (FEW | {"n_asperities": 2}, 1.0, r"^surface \d+ has no asperity; increase n_asperities$"),
        (FEW | {"law": YIELDS}, None, r"surface \d+ does not reach it; give less$"),
        (SOFTER, 0.1, r"^load = 0\.1 N: surface \d+ does not reach it; give less$"),
        ({"n_surfaces": 1}, 1.0, "at least 2 surfaces"),
        ({"n_asperities": 2**50}, 1e9, "too many to solve"),
        ({}, 1e12, "not reached"),
    ],
)  # fmt: skip
def test_what_cannot_be_solved(scene, changes, load, words):
    asked = scene.replace(**changes)
    load = load or float(asked.theory.mean("load", -39.0))
    with pytest.raises(ValueError, match=words):
        solutions(asked, "load", [load], draw=True)


def test_negative_sums_that_never_reach_a_value_have_no_crossing():
    """Of several at once; the largest of many roots, from above, also between steps and right at the end."""
    roots = np.array([0.3, -39.9, -40.1, 1.0, -np.inf])
    found = crossing(lambda h, k: roots[k] - h, np.ones(5))
    np.testing.assert_allclose(found, [0.3, -39.9, np.nan, 1.0, np.nan], atol=1e-12)
    assert crossing(lambda h, _: np.sin(h), np.array([-0.1])) == pytest.approx(-np.pi, abs=1e-12)


@pytest.mark.slow
def test_intervals_are_students(scene):
    """Of a mean of drawn surfaces, as under laws that pull; an exact mean has no width."""
    exact = mcgw.solve(scene, load=100.0)
    drawn = mcgw.solve(scene.replace(law=analytic.DerjaguinMullerToporov(pull_off=0.01)), load=100.0)
    for name, x in drawn.surfaces.items():
        half = student.ppf(0.75, x.size - 1) * x.std(ddof=1) / np.sqrt(x.size)
        if name != "load":
            assert drawn.interval(name, 0.5) == pytest.approx((x.mean() - half, x.mean() + half))
    for name, value in exact.value.items():
        assert exact.interval(name, 0.5) == (value, value)


@pytest.mark.parametrize("bodies", [pytest.param(None, marks=pytest.mark.slow), {"reference": "body"}])
def test_the_answer_is_the_mean_of_specimens(bodies, make_scene):
    """Not the infinite surface, whose area is a third at 0.06 contacts; resistances are means, too."""
    scene = make_scene(separations=0.0, n_surfaces=200, seed=5, grading=None)
    few = {"nominal_area": 1e-8, "n_asperities": 3}  # one contact or two carry 10 mN
    scene = scene.replace(**few, joint=mcgw.Joint(resistivity=1.7e-8), interaction=bodies)
    found = mcgw.solve(scene, load=0.01)
    for name, x in found.surfaces.items():
        assert abs(x.mean() - found.value[name]) <= 5 * x.std() / np.sqrt(x.size) + 1e-8 * abs(x.mean()), name
    x = found.surfaces["area"]
    assert abs(x.mean() - found.theory["area"]) > 5 * x.std() / np.sqrt(x.size)
    again, _ = mcgw.solve(scene, load=[0.01, 0.02])
    assert again.value["area"] == found.value["area"]
    assert f"{found.value['contact_resistance']:.4g}" in solutions_text(scene, [found, again])


def test_surfaces_too_many_to_draw_have_exact_answers(scene):
    """They scatter as little as their number says: 1/N in the variance."""
    few, many = (solutions(scene.replace(n_asperities=n), "load", [n * 1e-3])[0] for n in (2**30, 2**50))
    assert many.value["area"] == pytest.approx(many.theory["area"], rel=1e-6)
    assert many.std["area"] / few.std["area"] == pytest.approx(2**10, rel=1e-2)


@pytest.mark.parametrize(
    ("spectral", "reference"), [(False, "body"), pytest.param(True, "mean-plane", marks=pytest.mark.slow)]
)
def test_the_mean_gap(spectral, reference, make_scene):
    """From the mean plane of the surface where it is known: summits lie 4 sqrt(m0/(pi alpha)) above it.

    With interaction it is what the asperities feel, or the nominal separation from a periodic cell's plane.
    """
    rise = 0.0
    scene = make_scene(n_surfaces=3, n_asperities=30000, separations=1.0, grading=None)
    if spectral:
        m = analytic.SpectralMoments(1e-12, 5e-4, 2.5e6)  # alpha = 10
        rise = 4 * np.sqrt(m.m0 / (np.pi * m.alpha))
        surface = analytic.Surface(m.sigma, m.radius, m.eta, 30000 / m.eta, 1e9)
        scene = scene.replace(surface=surface, heights=analytic.Nayak(m.alpha))
    scene = scene.replace(interaction=analytic.Interaction(reference))
    for found in mcgw.solve(scene, area_fraction=[3e-4, 1e-2]):
        name = "nominal_separation" if reference == "mean-plane" else "separation"
        for values in (found.theory, found.surfaces):
            expected = scene.surface.sigma * values[name] + rise
            np.testing.assert_allclose(values[scene.gap], expected, rtol=1e-12)
    assert scene.gap == ("mean_gap" if spectral else "gap_to_summits")


def test_notes_are_about_the_load_and_not_the_scenes_separations(make_scene, tmp_path, capsys):
    """A scene down to h = -2, where most summits touch, and a light load; one at h = 3, and a heavy load."""
    low, high = (make_scene(separations=h, n_surfaces=3, grading=None) for h in ((-2.0, 3.0), 3.0))
    for scene, pressure, crowded in ((low, "1 kPa", False), (high, "1 GPa", True)):
        (tmp_path / "s.toml").write_text(mcgw.scene_text(scene))
        assert main(["solve", str(tmp_path / "s.toml"), "--pressure", pressure, "-v"]) == 0
        told = capsys.readouterr()
        notes = [line for line in told.err.splitlines() if line.startswith("mcgw: note: ")]
        assert any("more than half of all asperities touch" in line for line in notes) == crowded, notes
        assert "gap to the mean plane of the summits" in told.out


def test_specimens_follow_the_exact_law_of_the_separation(make_scene):
    """Shares within 4 standard errors; the law of a softer surface is refused. Planes only move."""
    few = make_scene(separations=(0.0,), n_surfaces=400, seed=6, n_asperities=3000)
    found = mcgw.solve(few, load=10.0)
    softer = few.replace(grading=analytic.Homogeneous()).theory.separation_law(10.0)
    shares, allowed = np.array([0.1, 0.5, 0.9]), 4 * np.sqrt([0.09 / 400, 0.25 / 400, 0.09 / 400])
    for law, right in ((found.separation_law, True), (softer, False)):
        seen = [np.mean(found.surfaces["separation"] <= h) for h in law.ppf(shares)]
        assert np.all(np.abs(seen - shares) < allowed) == right
    ends = found.specimens("separation", 0.5)
    assert found.separation_law.cdf(np.array(ends)) == pytest.approx([0.25, 0.75], abs=1e-9)
    sigma, h = few.surface.sigma, found.theory["separation"]
    gaps = found.theory["gap_to_summits"] + sigma * (np.array(ends) - h)
    assert found.specimens("gap_to_summits", 0.5) == pytest.approx(gaps, rel=1e-12)
    assert found.specimens("area") == tuple(np.quantile(found.surfaces["area"], [0.05, 0.95]))
    felt = replace(found, scene=few.replace(interaction=mcgw.Interaction("body")))
    assert felt.separation_law.ppf(0.3) == pytest.approx(found.separation_law.ppf(0.3), rel=1e-12)


def test_areas_that_fall_at_yield_have_no_law_of_the_separation(make_scene):
    yielding = make_scene(law=YIELDS, separations=(0.0,), n_surfaces=20, seed=6)
    found = mcgw.solve(yielding, area=1e-9)
    assert found.separation_law is None
    assert found.specimens("separation") == tuple(np.quantile(found.surfaces["separation"], [0.05, 0.95]))
    assert mcgw.solve(yielding, load=10.0).separation_law is not None


@pytest.mark.parametrize("given", [{"load": 300.0}, {"area": 1e-8}])
def test_so_many_asperities_scatter_so_little_at_a_given_value(make_scene, given):
    """Standard deviations of 600 surfaces are known to 2.9 %; the formula is right to 1/contacts."""
    scene = make_scene(separations=(0.0,), n_surfaces=600, seed=6)
    found = mcgw.solve(scene, **given)
    for name, n in found.asperities_for(0.01).items():
        x = found.surfaces[name]
        assert 0.01 * np.sqrt(n / found.scene.n_asperities) == pytest.approx(x.std() / x.mean(), rel=0.09)
    assert set(found.asperities_for(0.01)) == {"load", "area", "stiffness", "conductance"} - set(given)
    pressed_down = mcgw.solve(scene.replace(interaction="body"), **given)
    assert set(pressed_down.asperities_for(0.01)) == {"load", "area"} - set(given)
    if "area" in given:  # loads differ, and so do the sinkings, which no law of the separation knows
        ends = np.quantile(pressed_down.surfaces["gap_to_summits"], [0.05, 0.95])
        assert pressed_down.specimens("gap_to_summits") == tuple(ends)


@pytest.mark.parametrize("reference", ["body", "mean-plane"])
def test_nominal_separations_are_those_of_each_surfaces_own_load(reference, make_scene):
    """The load is summed here over the heights of ten surfaces; their separation is the root of it."""
    scene = make_scene(
        grading=mcgw.Exponential(2.0), interaction={"reference": reference}, n_surfaces=10, separations=1.0
    )
    sunk = scene.theory.compliance
    for found in mcgw.solve(scene, nominal_separation=[0.5, 2.0]):
        np.testing.assert_allclose(found.surfaces["nominal_separation"], found.amount, atol=1e-12)
        assert found.value["nominal_separation"] == found.amount
        assert found.theory["nominal_separation"] == pytest.approx(found.amount, abs=1e-12)
        for i, h in enumerate(found.surfaces["separation"]):
            load, _ = literal(found, i)
            assert h - sunk * load == pytest.approx(found.amount, abs=1e-12)
            assert found.surfaces["load"][i] == pytest.approx(load, rel=1e-12)
        error = found.surfaces["load"].std(ddof=1) / np.sqrt(10)
        assert abs(found.value["load"] - found.theory["load"]) < 6 * error


# --- the very asperities of the surfaces that were solved ---

PLAIN = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "0.5 mm^2", "78.6 GPa")
SPECTRAL = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "0.2 mm^2", "78.6 GPa")


@pytest.mark.parametrize(("surface", "count"), [(PLAIN, "poisson"), (SPECTRAL, "fixed")])
def test_their_loads_and_areas_add_up_to_what_was_given(surface, count):
    grading = mcgw.Exponential(0.5)
    scene = mcgw.Scene(
        surface, separations=0.0, grading=grading, ensemble=mcgw.Sampling(count=count), n_surfaces=3, seed=2
    )
    for found in mcgw.solve(scene, pressure=["0.1 MPa", "2 MPa"]):
        for i in (0, 2):
            assert literal(found, i) == pytest.approx((found.amount, found.surfaces["area"][i]), rel=1e-9)
            assert found.heights(i).size == found.radii(i).size == found.surfaces["contacts"][i]
        assert not np.array_equal(found.heights(0), found.heights(2))

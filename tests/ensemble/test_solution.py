"""Given a load, the separation: back through the simulator, against an exact law, and as typed."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.inside import Summits, crossing, solutions, solutions_text
from scipy.stats import t as student

import analytic
import mcgw
from mcgw.cli import main

LOADS = (3.0, 100.0, 900.0)


@pytest.fixture(scope="module")
def scene(make_scene):
    return make_scene(separations=(0.0,), n_surfaces=300, seed=5)


@pytest.fixture(scope="module")
def solved(scene):
    return solutions(scene, "load", LOADS)


def test_theory_inverts_the_load(scene, solved):
    """To 1e-10 as promised; the inversion itself holds 1e-13."""
    for load, solution in zip(LOADS, solved, strict=True):
        share = scene.n_asperities / scene.surface.n_asperities
        back = analytic.load(scene.surface, solution.theory["separation"], scene.grading) * share
        assert back == pytest.approx(load, rel=1e-10)
        assert solution.theory["load"] == pytest.approx(load, rel=1e-10)
        np.testing.assert_allclose(solution.surfaces["load"], load, rtol=1e-10)


def test_every_surface_inverts_the_simulator(scene, solved):
    """The simulator, given the separation of a surface, finds the asked load on it: 1e-10.

    The sampler ``tail`` draws the same heights whenever the lowest separation is the same, so that is
    asked too. With one contact at an approach of 1e-3 the last digit of h is 1e-12 of the load.
    """
    lowest = min(x.surfaces["separation"].min() for x in solved) - 0.2
    h = _separations_at(scene, lowest)
    again = scene.replace(sampler="tail", separations=(lowest, *h.ravel()), n_surfaces=12)
    loads = mcgw.simulate(again).load[:, 1:].reshape(12, 12, len(LOADS))
    own = loads[np.arange(12), np.arange(12)]
    np.testing.assert_allclose(own, np.broadcast_to(LOADS, own.shape), rtol=1e-10)
    assert np.abs(loads[0, 1] / LOADS - 1).max() > 1e-3  # another surface has another separation


def _separations_at(scene, lowest):
    """Solved as `solve` does, on heights drawn above a separation of our own."""
    scene = scene.replace(sampler="tail", separations=(lowest,))
    every = [Summits.of(scene, mcgw.heights(scene, number), None) for number in range(12)]
    q = analytic.QUANTITIES["load"]
    scale = q.scale(scene.surface)
    return np.array([[on.largest_separation(q, load / scale, lowest) for load in LOADS] for on in every])


def test_area_is_inverted_and_loads_of_one_asperity_are_hertz(scene):
    scene, load, area = (
        scene.replace(grading=None),
        analytic.quantity_of("load"),
        analytic.quantity_of("area"),
    )
    stiff = scene.replace(grading=lambda s: 3.0 + 0 * s)
    h = Summits.of(stiff, np.array([2.0]), None).largest_separation(load, 0.375, 0.0)
    assert h == pytest.approx(2 - 0.125 ** (2 / 3), rel=1e-15)
    two = Summits.of(scene, np.array([0.5, 1.0]), None)
    assert two.largest_separation(area, 0.9, -1.0) == pytest.approx(0.3, rel=1e-14)


def entered(monkeypatch, name):
    """Calls of a function of `mcgw.sampling.asperities` from now on."""
    calls, function = [], getattr(mcgw.sampling.asperities, name)

    def counted(*args, **options):
        calls.append(args)
        return function(*args, **options)

    monkeypatch.setattr(mcgw.sampling.asperities, name, counted)
    return calls


@pytest.mark.parametrize("gamma", [1.5, 2.0, 3.0])
def test_light_loads_on_softer_tips(scene, gamma, monkeypatch):
    """Six decades: the search starts far below the answer, where moduli are negative that nothing touches.

    One asperity at unit approach carries 0.6 N. What the answers say of load and area is added up anew.
    """
    grading = analytic.Exponential(gamma)
    loads = [3e2, 3e1, 3.0, 3e-1, 3e-2, 3e-3, 3e-4]
    graded = scene.replace(grading=grading, n_surfaces=20)
    drawn = entered(monkeypatch, "summits_of_many")
    found = solutions(graded, "load", loads, draw=True)
    assert drawn[0][0].lowest < grading.zero
    for number in range(20):
        s = mcgw.heights(drawn[0][0], number, untouched=True)
        for load, solution in zip(loads, found, strict=True):
            h = solution.surfaces["separation"][number]
            assert h > grading.zero
            assert literal_load(graded, s, h) == pytest.approx(load, rel=1e-9)
    for load, solution in zip(loads, found, strict=True):
        exact = float(analytic.load(scene.surface, solution.theory["separation"], grading))
        assert exact * scene.n_asperities / scene.surface.n_asperities == pytest.approx(load, rel=1e-10)


def test_a_negative_modulus_that_matters_is_told_with_the_load(scene):
    """At 5 kN the mean surface itself reaches negative moduli; of 20 asperities some surfaces do at 14 N."""
    told = r"^load = 5000 N: the mean surface reaches it only with asperities of negative modulus"
    with pytest.raises(ValueError, match=told):
        solutions(scene, "load", [5e3])
    few = scene.replace(n_asperities=20, n_surfaces=100)
    assert float(few.theory.separation_at("load", 14.0)) > few.grading.zero
    with pytest.raises(
        ValueError, match=r"^load = 14 N: surface \d+ reaches it only with .* s = -[\d.]+; give"
    ):
        solutions(few, "load", [14.0])


def literal_load(scene, heights, h):
    unit = 4 / 3 * scene.surface.E_star * np.sqrt(scene.surface.radius * scene.surface.sigma**3)
    return unit * np.sum(np.maximum(heights - h, 0) ** 1.5 * scene.modulus(heights))


@pytest.mark.parametrize("negative", ["clip", "allow"])
def test_negative_moduli_as_the_scene_wants_them(scene, negative, monkeypatch):
    """Clipped they carry nothing, allowed they pull: the heights are those of the search's own start."""
    drawn = entered(monkeypatch, "summits_of_many")
    wanted = scene.replace(negative=negative, n_asperities=20, n_surfaces=100)
    (solution,) = solutions(wanted, "load", [14.0], draw=True)
    starts = {args[0].lowest for args in drawn}
    below = 0
    for number, h in enumerate(solution.surfaces["separation"]):
        s = mcgw.heights(drawn[0][0], number, untouched=True)
        assert literal_load(wanted, s, h) == pytest.approx(14.0, rel=1e-10)
        below += bool(np.any(scene.grading(s[s > h]) < 0))
    assert len(starts) == 1
    assert below > 3


def test_what_a_surface_does_not_reach_is_said_of_it(scene):
    """Some surfaces have fewer asperities than the mean one, or none."""
    none = scene.replace(n_asperities=2, count="poisson", n_surfaces=20, grading=analytic.Homogeneous())
    with pytest.raises(ValueError, match=r"^surface \d+ has no asperity; increase n_asperities$"):
        solutions(none, "load", [1.0])
    few = none.replace(n_asperities=8, law=analytic.KogutEtsion(critical=0.05))
    most = float(few.theory.mean("load", -39.0))
    with pytest.raises(ValueError, match=rf"^load = {most:g} N: surface \d+ does not reach it; give less$"):
        solutions(few, "load", [most])


def test_surfaces_without_a_stiff_asperity_are_told_at_once(make_scene):
    """Both of two asperities lie above 1.1 in one surface of fifty, and carry nothing."""
    softer = mcgw.Graded(mcgw.Exponential(-0.5), negative="clip")
    scene = make_scene(separations=1.0, n_surfaces=400, grading=softer, n_asperities=2)
    with pytest.raises(ValueError, match=r"^load = 0\.1 N: surface \d+ does not reach it; give less$"):
        mcgw.solve(scene, load=0.1)


def test_negative_sums_that_never_reach_a_value_have_no_crossing():
    assert crossing(lambda h: -1.0 - h * 0, 1.0) is None
    assert crossing(lambda h: 0.3 - h, 1.0) == pytest.approx(0.3, abs=1e-14)
    assert crossing(lambda h: -39.9 - h, 1.0) == pytest.approx(-39.9, abs=1e-12)
    assert crossing(lambda h: -40.1 - h, 1.0) is None
    first = crossing(np.sin, -0.1)  # the largest of many, from above
    assert first == pytest.approx(-np.pi, abs=1e-12)


@pytest.mark.parametrize("pressed_down", [True, False])
def test_only_what_asperities_alone_decide_has_a_number_of_them(pressed_down, make_scene):
    scene = make_scene(separations=(0.0,), n_surfaces=3, quantities=("load", "area", "stiffness"))
    if pressed_down:
        scene = scene.replace(interaction=mcgw.Interaction("body"))
    found = mcgw.solve(scene, load=10.0).asperities_for(0.01)
    assert set(found) == ({"area"} if pressed_down else {"area", "stiffness", "conductance"})


def test_summits_of_other_radii_add_what_hertz_says(scene):
    """P = 4/3 E sqrt(R) d^1.5, A = pi R d, dP/dd = 2 E sqrt(R d), by hand; two of three touch."""
    scene = scene.replace(grading=None)
    s, ratios, x = np.array([0.4, 2.0, 1.5]), np.array([1.0, 4.0, 0.25]), scene.surface
    found = Summits.of(scene, s, ratios).sums(["load", "area", "stiffness", "contacts"], 1.0)
    d, r = x.sigma * np.array([1.0, 0.5]), x.radius * ratios[1:]
    assert found == pytest.approx(
        {
            "load": 4 / 3 * x.E_star * np.sum(np.sqrt(r) * d**1.5),
            "area": np.pi * np.sum(r * d),
            "stiffness": 2 * x.E_star * np.sum(np.sqrt(r * d)),
            "contacts": 2.0,
        },
        rel=1e-12,
    )


@pytest.mark.slow
@pytest.mark.parametrize("level", [0.5, 0.95])
def test_intervals_are_students(solved, level):
    """Of a mean of drawn surfaces, as under laws that pull; an exact mean has no width."""
    scene = solved[1].scene.replace(law=analytic.DerjaguinMullerToporov(pull_off=0.01))
    drawn = mcgw.solve(scene, load=solved[1].amount)
    for name, x in drawn.surfaces.items():
        half = student.ppf((1 + level) / 2, x.size - 1) * x.std(ddof=1) / np.sqrt(x.size)
        if name != "load":
            assert drawn.interval(name, level) == pytest.approx((x.mean() - half, x.mean() + half))
    for name, x in solved[1].surfaces.items():
        exact = solved[1].value[name]
        assert solved[1].interval(name, level) == (exact, exact)
        assert abs(x.mean() - exact) <= 5 * x.std() / np.sqrt(x.size) + 1e-9 * abs(exact)


LIGHT = {"nominal_area": 1e-8, "n_asperities": 3}  # one contact or two carry 10 mN


@pytest.mark.parametrize(
    ("changes", "load"), [(LIGHT, 0.01), ({"nominal_area": 1e-6, "n_asperities": 300}, 1.0)]
)
@pytest.mark.parametrize("bodies", [None, {"reference": "body"}])
def test_the_answer_is_the_mean_of_specimens(changes, load, bodies, make_scene):
    """Not the infinite surface, whose area is a third at 0.06 contacts; resistances are means, too."""
    scene = make_scene(separations=0.0, n_surfaces=200, seed=5, grading=None)
    scene = scene.replace(**changes, joint=mcgw.Joint(resistivity=1.7e-8), interaction=bodies)
    found = mcgw.solve(scene, load=load)
    for name, x in found.surfaces.items():
        assert abs(x.mean() - found.value[name]) <= 5 * x.std() / np.sqrt(x.size) + 1e-8 * abs(x.mean()), name
    x = found.surfaces["area"]
    assert abs(x.mean() - found.theory["area"]) > 5 * x.std() / np.sqrt(x.size)
    again, _ = mcgw.solve(scene, load=[load, 2 * load])
    assert again.value["area"] == found.value["area"]
    assert f"{found.value['contact_resistance']:.4g}" in solutions_text(scene, [found, again])


def test_what_cannot_be_solved(scene):
    with pytest.raises(ValueError, match="at least 2 surfaces"):
        solutions(scene.replace(n_surfaces=1), "load", [1.0])
    with pytest.raises(ValueError, match="too many to solve"):
        solutions(scene.replace(n_asperities=2**50), "load", [1e9], draw=True)
    with pytest.raises(ValueError, match="not reached"):
        solutions(scene, "load", [1e12])


def test_surfaces_too_many_to_draw_have_exact_answers(scene):
    """They scatter as little as their number says: 1/N in the variance."""
    few, many = (solutions(scene.replace(n_asperities=n), "load", [n * 1e-3])[0] for n in (2**30, 2**50))
    assert many.value["area"] == pytest.approx(many.theory["area"], rel=1e-6)
    assert many.std["area"] / few.std["area"] == pytest.approx(2**10, rel=1e-2)


@pytest.mark.slow
def test_a_solution_of_too_few_contacts_has_no_interval(make_scene):
    """Of surfaces drawn: where the mean is exact, few do not matter."""
    scene = make_scene(n_surfaces=3, separations=(0.0,), law=analytic.KogutEtsion(critical=0.01))
    light, heavy = solutions(scene, "load", [float(x) for x in scene.theory.mean("load", [3.4, 2.0])])
    assert light.surfaces["contacts"].sum() < 10 < heavy.surfaces["contacts"].sum()
    assert np.isnan(light.interval("load_slope")).all()
    assert (
        heavy.interval("load_slope")[0]
        < heavy.surfaces["load_slope"].mean()
        < heavy.interval("load_slope")[1]
    )


SPECTRAL = {"m0": 1e-12, "m2": 5e-4, "m4": 2.5e6}  # alpha = 10


@pytest.mark.parametrize("reference", ["body", pytest.param("mean-plane", marks=pytest.mark.slow)])
@pytest.mark.parametrize("spectral", [pytest.param(True, marks=pytest.mark.slow), False])
def test_the_mean_gap(spectral, reference, make_scene):
    """From the mean plane of the surface where it is known: summits lie 4 sqrt(m0/(pi alpha)) above it.

    With interaction it is what the asperities feel, or the nominal separation from a periodic cell's plane.
    """
    rise = 0.0
    scene = make_scene(n_surfaces=3, n_asperities=30000, separations=1.0, grading=None)
    if spectral:
        m = analytic.SpectralMoments(*SPECTRAL.values())
        rise = 4 * np.sqrt(m.m0 / (np.pi * m.alpha))
        surface = analytic.Surface(m.sigma, m.radius, m.eta, 30000 / m.eta, 1e9)
        scene = scene.replace(surface=surface, heights=analytic.Nayak(m.alpha))
    scene = scene.replace(interaction=analytic.Interaction(reference))
    solved = mcgw.solve(scene, area_fraction=[3e-4, 1e-2])
    for found in solved:
        name = "nominal_separation" if reference == "mean-plane" else "separation"
        for values in (found.theory, found.surfaces):
            expected = scene.surface.sigma * values[name] + rise
            np.testing.assert_allclose(values[scene.gap], expected, rtol=1e-12)
            assert ("mean_gap" in values, "gap_to_summits" in values) == (spectral, not spectral)
        assert scene.gap in repr(found)
    assert scene.gap == ("mean_gap" if spectral else "gap_to_summits")
    told = solutions_text(scene, solved, full=True)
    assert ("gap between the mean planes of the surfaces" in told) == spectral
    assert ("gap to the mean plane of the summits" in told) != spectral


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
        assert "gap_to_summits" in told.out
        assert "mean_gap" not in told.out


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
    yielding = make_scene(law=analytic.KogutEtsion(critical=0.05), separations=(0.0,), n_surfaces=20, seed=6)
    found = mcgw.solve(yielding, area=1e-9)
    assert found.separation_law is None
    assert found.specimens("separation") == tuple(np.quantile(found.surfaces["separation"], [0.05, 0.95]))
    assert mcgw.solve(yielding, load=10.0).separation_law is not None


@pytest.mark.parametrize(
    "given",
    [{"load": 300.0}, {"area": 1e-8}, pytest.param({"nominal_separation": 1.0}, marks=pytest.mark.slow)],
)
def test_so_many_asperities_scatter_so_little_at_a_given_value(make_scene, given):
    """Standard deviations of 600 surfaces are known to 2.9 %; the formula is right to 1/contacts."""
    scene = make_scene(separations=(0.0,), n_surfaces=600, seed=6)
    found = mcgw.solve(scene.replace(interaction="body") if "nominal_separation" in given else scene, **given)
    for name, n in found.asperities_for(0.01).items():
        x = found.surfaces[name]
        assert 0.01 * np.sqrt(n / found.scene.n_asperities) == pytest.approx(x.std() / x.mean(), rel=0.09)
    assert ("area" in found.asperities_for(0.01)) == ("area" not in given)
    assert ("load" in found.asperities_for(0.01)) == ("load" not in given)


@pytest.mark.parametrize("reference", ["body", "mean-plane"])
def test_nominal_separations_are_those_of_each_surfaces_own_load(reference, make_scene):
    """The load is summed here over the heights of ten surfaces; their separation is the root of it."""
    scene = make_scene(
        grading=mcgw.Exponential(2.0), interaction={"reference": reference}, n_surfaces=10, separations=1.0
    )
    x, sunk = scene.surface, scene.compliance / scene.surface.sigma
    for found in mcgw.solve(scene, nominal_separation=[0.5, 2.0]):
        np.testing.assert_allclose(found.surfaces["nominal_separation"], found.amount, atol=1e-12)
        assert found.value["nominal_separation"] == found.amount
        assert found.theory["nominal_separation"] == pytest.approx(found.amount, abs=1e-12)
        for i, h in enumerate(found.surfaces["separation"]):
            s = found.heights(i)
            loads = (2 - np.exp(-s)) * (s - h) ** 1.5
            load = 4 / 3 * x.E_star * x.radius**0.5 * x.sigma**1.5 * loads.sum()
            assert h - sunk * load == pytest.approx(found.amount, abs=1e-12)
            assert found.surfaces["load"][i] == pytest.approx(load, rel=1e-12)
        error = found.surfaces["load"].std(ddof=1) / np.sqrt(10)
        assert abs(found.value["load"] - found.theory["load"]) < 6 * error


def test_nominal_separations_need_an_interaction_and_a_number(make_scene):
    scene = make_scene(n_surfaces=3, separations=1.0)
    with pytest.raises(
        ValueError, match=r'^nominal_separation: it needs \[interaction\] reference = "body" or'
    ):
        mcgw.solve(scene, nominal_separation=1.0)
    pressed = scene.replace(interaction="body")
    for wrong in ("1 um", np.inf):
        with pytest.raises(ValueError, match=r"nominal_separation = .*: give a finite number, d/sigma"):
            mcgw.solve(pressed, nominal_separation=wrong)
    found = mcgw.solve(pressed, nominal_separation=1.0)
    assert found.title == "At the nominal separation 1 sigma"
    assert found.budget().lacking["model"].endswith("not at a given nominal separation")

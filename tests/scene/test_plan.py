"""``mcgw show --plan``: what would be drawn, and what not."""

import re
import subprocess
import sys

import numpy as np
import pytest
from oracles.inside import THREADS, forecast, in_words, plan_text, rough_seconds, sampler_of

import analytic
import mcgw
from mcgw.sampling.expected import expected


def number(word, text):
    """The first number of a line of the plan."""
    return float(re.search(rf"^  {word} +(?:about )?([-+.\de]+)", text, re.MULTILINE)[1])


def test_plan_says_what_is_drawn(make_scene):
    scene = make_scene(separations=(1.0, 2.0), n_asperities=10**5, sampler="cells")
    text, known, touching = plan_text(scene), expected(scene), 10**5 * float(analytic.fn(0, 1.0))
    assert number("touching", text) == pytest.approx(touching, rel=1e-3)
    moments, counts, _ = sampler_of(scene).drawn(0, 64, sampler_of(scene).response.layout)
    assert counts.sum() / 64 == pytest.approx(touching, abs=5 * np.sqrt(touching / 64))
    assert (number("cells", text), known.moments) == (len(counts), pytest.approx(len(moments), rel=0.2))
    assert number("results", text) == pytest.approx(1e-6 * 8 * 200 * 2 * 4)
    assert "chosen by auto" not in text
    enough = forecast(scene.replace(rel_err=0.01, n_surfaces=10**9)).surfaces
    assert f"{enough:.2g} surfaces, {in_words(rough_seconds(scene, 200) / 200 * enough)}" in text
    many = plan_text(scene.replace(keep="statistics", n_surfaces=10**6))
    assert float(re.search(r"statistics alone, about (\S+) MB", many)[1]) < 8
    ruled = make_scene(rel_err=0.01, n_surfaces=10**6, separations=(0.0,))
    assert number("surfaces", plan_text(ruled)) < 10**6


def test_contacts_alone_and_crowds_draw_hardly_any_height(make_scene):
    scene = make_scene(quantities=("contacts",), sampler="cells")
    assert expected(scene).moments == 0
    assert expected(scene).draws < 0.1  # what lies beyond the last cell is drawn one by one
    assert "no heights are drawn" in plan_text(scene)
    assert expected(make_scene(sampler="direct", separations=(1.0, 2.0), n_asperities=300)).draws == 300
    huge = expected(make_scene(sampler="aggregate", n_asperities=10**15))
    assert huge.moments <= huge.draws < huge.moments + 0.1
    assert huge.moments < 5000


@pytest.mark.parametrize(("n", "told"), [(20_000, True), (10_000, False)])
def test_crowds_are_offered_where_cells_are_full(make_scene, n, told):
    scene = make_scene(n_asperities=n, separations=(0.0,))
    times = rough_seconds(scene.replace(sampler="aggregate"), 200) / rough_seconds(scene, 200)
    assert (f"would buy crowded cells, {times:.2g} x the time" in plan_text(scene)) == told


WISHES = {
    "one law of two": {"law": mcgw.KogutEtsion(critical=0.1), "unload_from": 0.0},
    "steep": {"grading": analytic.Table((0.0, 1.37, 3.0), (1.0, 2.0, 1.5))},
    "radii": {"heights": analytic.Nayak(5.0), "summits": mcgw.RandomCurvature(5.0)},
    "beyond all": {"separations": (9.0, 10.0)},
}


@pytest.mark.parametrize("name", WISHES)
def test_what_is_expected_is_what_is_made(make_scene, name):
    """To a share that no reader would miss: moments are counted before any law is resolved."""
    scene = make_scene(**{"separations": (0.0, 0.5, 1.0, 2.0), "sampler": "cells", **WISHES[name]})
    plan, made = expected(scene), sampler_of(scene)
    assert plan.name == made.name
    assert plan.draws == pytest.approx(made.draws, rel=1e-2)
    assert plan.cells == pytest.approx(made.cells, rel=0.2)
    assert plan.moments == pytest.approx(made.response.layout.starts[-1], rel=0.4)


ONE_BY_ONE, BY_LAW = 1.2e-7 + 4 * 2 * 1.9e-9, 1.2e-7 + 4 * 2 * 3.5e-8  # of four quantities at two separations
LAW = mcgw.KogutEtsion(critical=0.1)
SPECTRAL = {"surface": mcgw.SpectralSurface(1e-12, 1e-2, 4e8, 1e-6, 1e11)}
CROWDS = {"sampler": "aggregate", "n_asperities": 10**15}
SECONDS = {
    "direct": ({"sampler": "direct"}, lambda n, moments: 3e-4 + n * ONE_BY_ONE),
    "tail of a law": ({"sampler": "tail", "law": LAW}, lambda n, moments: 2e-6 + n * BY_LAW),
    "own radii": (SPECTRAL | {"sampler": "tail"}, lambda n, moments: 2e-6 + n * (ONE_BY_ONE + 9 * 1.2e-7)),
    "crowds": (CROWDS, lambda n, moments: 2e-6 + moments * 1.1e-8),
    "crowds of a law": (CROWDS | {"law": LAW}, lambda n, moments: 2e-6 + moments * 2.5e-8),
}


@pytest.mark.parametrize("name", SECONDS)
def test_a_surface_takes_what_its_parts_do(make_scene, name):
    """Measured once: seconds of a surface, an asperity, a value, a step of a search, a moment.

    Drawing is shared by the threads; statistics take 4e-8 s for each of 36 numbers, 2.5e-10 s for each pair.
    """
    changes, by_hand = SECONDS[name]
    scene = make_scene(separations=(1.0, 2.0), **changes)
    known, touching = expected(scene), scene.n_asperities * float(scene.heights.sf(np.array(scene.lowest)))
    assert known.seconds == pytest.approx(by_hand(touching, known.moments), rel=2e-3)
    shared = known.seconds / THREADS.get()
    assert rough_seconds(scene, 50) == pytest.approx(50 * shared, rel=1e-14)
    kept = scene.replace(keep="statistics", separations=np.linspace(1.0, 2.0, 9))
    drawing = expected(kept).seconds / THREADS.get()
    with_pairs = 50 * (drawing + 36 * 4e-8 + 36**2 / 2 * 2.5e-10)
    assert rough_seconds(kept, 50) == pytest.approx(with_pairs, rel=1e-14)


CHILD = """
import sys, mcgw
from mcgw.reports.plan import plan_text
surface = mcgw.Surface(1e-6, 1e-5, 3e8, 1e-4, 8e10)
spectrum = mcgw.SpectralSurface(m0=1e-12, m2=1e-2, m4=4e8, nominal_area=1e-6, E_star=1e11)
asked = {"separations": [2.0, 3.0], "ensemble": mcgw.Sampling(100, 10**4)}
for changes in ({}, {"accuracy": 0.01}, {"sampler": "direct"}, {"law": mcgw.KogutEtsion(critical=0.1)},
                {"grading": lambda s: 1 + abs(s - 2.5)}, {"interaction": mcgw.Interaction("mean-plane")}):
    print(plan_text(mcgw.Scene(surface, **asked).replace(**changes)))
print(plan_text(mcgw.Scene(spectrum, **asked)))
assert not {"numba", "h5py"} & {*sys.modules}
"""


def test_a_plan_loads_no_compiled_loop():
    """Whatever the scene."""
    done = subprocess.run([sys.executable, "-c", CHILD], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("not done:") == 7


def test_times_are_told_as_people_say_them():
    told = {
        0.0123: "0.012 s", 59.0: "59 s", 60.0: "1 min", 3599.0: "60 min", 3600.0: "1 h", 259_199.0: "72 h",
        259_200.0: "3 days", 3.15576e7: "1 years",
    }  # fmt: skip
    assert {seconds: in_words(seconds) for seconds in told} == told

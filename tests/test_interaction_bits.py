"""Surfaces whose asperities press each other down: the same bits, whoever draws, and from their files."""

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import SURFACE
from interacting_by_hand import QUANTITIES, SEPARATIONS, STRENGTHS, interaction
from test_same_bits_everywhere import OLD_BLAS, OLD_C, OLD_NUMPY

import analytic
import mcgw
from mcgw.sampling.samplers import sampler_of
from mcgw.store import ensembles


@pytest.mark.parametrize("sampler", ["direct", "tail", "cells"])
def test_same_bits_in_any_block_by_any_threads(pressed, sampler):
    scene = pressed(3.0, sampler=sampler, n_asperities=300, n_surfaces=40)
    one, two = mcgw.simulate(scene, threads=1), mcgw.simulate(scene, threads=2)
    drawn = sampler_of(scene)
    whole = drawn.block(0, 40).sums
    for name, values in whole.items():
        np.testing.assert_array_equal(one[name], two[name])
        for first, n in ((0, 1), (33, 7), (10, 20)):
            np.testing.assert_array_equal(drawn.block(first, n).sums[name], values[first : first + n])


def test_company_of_separations_changes_hardly_a_digit(pressed):
    """The search begins anew at each; which asperities are drawn one by one is all that may differ."""
    h = (2.0, 0.0, 2.0, 1.0)
    many = sampler_of(pressed(3.0, separations=h)).block(0, 3).sums
    few = sampler_of(pressed(3.0, separations=(0.0, 1.0, 2.0))).block(0, 3).sums
    for name in many:
        np.testing.assert_array_equal(many[name][:, 0], many[name][:, 2])
        np.testing.assert_allclose(many[name][:, [1, 3, 0]], few[name], rtol=1e-13)


@pytest.mark.parametrize("at", ["effective", "nominal"])
def test_a_file_holds_both_separations_and_goes_on(pressed, at, tmp_path):
    """At once, in two goes, and in memory: one digest; the scene reads back from its text."""
    scene, path = pressed(3.0, at, n_surfaces=100, n_asperities=500), tmp_path / "e.h5"
    mcgw.run(scene.replace(n_surfaces=40), path)
    mcgw.run(scene, path)
    mcgw.run(scene, tmp_path / "at_once.h5", threads=1)
    found, memory = mcgw.open_ensemble(path), mcgw.simulate(scene)
    assert ensembles.verify(path) == ensembles.verify(tmp_path / "at_once.h5")
    assert found.scene == scene
    assert mcgw.scene_from(mcgw.scene_text(found.scene)) == scene
    for name in (*QUANTITIES, *scene.other_separations):
        np.testing.assert_array_equal(found[name], memory[name])


@pytest.mark.slow
def test_processes_draw_the_same(pressed, tmp_path):
    scene = pressed(3.0, n_surfaces=300, n_asperities=500)
    for name, asked in (("a", {"engine": "processes", "threads": 2}), ("b", {})):
        mcgw.run(scene, tmp_path / f"{name}.h5", **asked)
    assert ensembles.verify(tmp_path / "a.h5") == ensembles.verify(tmp_path / "b.h5")


def test_scenes_without_interaction_know_nothing_of_it():
    """Their bits are those of `golden_samplers.json`; no file of the interaction is even read."""
    code = (
        "import sys, mcgw; s = mcgw.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e9); "
        "mcgw.simulate(mcgw.Scene(s, separations=[1.0], n_surfaces=2, seed=1)); "
        "print([m for m in sys.modules if 'interact' in m or m.endswith(('balance', 'nominal'))])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def digests():
    """Of surfaces of both references by `cells`."""
    found = {}
    for name, strength in STRENGTHS.items():
        values = {"grading": analytic.Exponential(1.5), "separations": SEPARATIONS, "n_asperities": 5000}
        scene = mcgw.Scene(SURFACE, seed=1, interaction=interaction(strength, SURFACE, 5000), **values)
        sums = sampler_of(scene).block(0, 5).sums
        found[name] = hashlib.sha256(b"".join(sums[key].tobytes() for key in sorted(sums))).hexdigest()
    return found


def test_older_processors_find_the_same_balances():
    """Their libraries round otherwise (`test_same_bits_everywhere`)."""
    code = "import json, test_interaction_bits as t; print(json.dumps(t.digests()))"
    folder = Path(__file__).parent
    older = {
        **OLD_BLAS,
        **OLD_C,
        **OLD_NUMPY,
        "PYTHONPATH": os.pathsep.join(map(str, (folder, folder.parent))),
    }
    call = [sys.executable, "-W", "ignore", "-c", code]
    done = subprocess.run(call, env=os.environ | older, capture_output=True, check=True)
    assert json.loads(done.stdout) == digests()

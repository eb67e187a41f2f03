"""Compiling ahead: in two processes, every kind of scene that has loops of its own."""

import runpy
import sys

import pytest

import mcgw
from mcgw.commands import warm
from mcgw.machine.child_process import ChildError
from mcgw.scene.promises import SAMPLERS


@pytest.mark.parametrize(("cores", "halves"), [(1, 1), (2, 2), (8, 2), (None, 1)])
def test_it_takes_two_processes_where_there_are_two_cores(cores, halves, monkeypatch):
    called = []
    monkeypatch.setattr(warm.os, "cpu_count", lambda: cores)
    monkeypatch.setattr("mcgw.machine.child_process.run_child", lambda *words: called.append(words))
    warm.warm()
    assert sorted(called) == [("mcgw.commands.warm", str(k), str(halves)) for k in range(halves)]


def test_a_process_that_ends_badly_is_told(monkeypatch):
    def fail(*_):
        raise ChildError("crashed with SIGSEGV", "")

    monkeypatch.setattr("mcgw.machine.child_process.run_child", fail)
    with pytest.raises(ChildError, match="SIGSEGV"):
        warm.warm()
    with pytest.raises(mcgw.RunError, match=r"^the loops could not all be compiled: crashed with SIGSEGV$"):
        warm.execute(None)


def test_scenes_of_every_kind_are_drawn(monkeypatch):
    """Once, by one process or by two that share them; and a map is fitted."""
    scenes, fitted = [], []
    monkeypatch.setattr("mcgw.ensemble.simulation.simulate", scenes.append)
    monkeypatch.setattr("mcgw.maps.fitting.fit", lambda *words, **options: fitted.append((words, options)))
    drawn = []
    for shares in ([(0, 1)], [(0, 2), (1, 2)]):
        scenes.clear()
        for words in shares:
            monkeypatch.setattr(sys, "argv", ["warm", *map(str, words)])
            runpy.run_path(warm.__file__, run_name="__main__")
        drawn.append(list(scenes))
    assert drawn[0] == drawn[1]
    assert {scene.sampler for scene in scenes} == set(SAMPLERS)
    assert {scene.keep for scene in scenes} == {"sums", "moments", "statistics"}
    assert {scene.count for scene in scenes} == {"fixed", "poisson"}
    assert {scene.hertzian for scene in scenes} == {True, False}
    assert {scene.unload_from for scene in scenes} == {None, 0.0}
    assert {scene.curvature is None for scene in scenes} == {True, False}
    assert {scene.nominal for scene in scenes} == {True, False}
    assert {scene.exact for scene in scenes} == {True, False}
    assert max(scene.n_asperities for scene in scenes) == 10**6
    assert [options for _, options in fitted] == [{"cutoff": "8 um"}] * 2
    assert fitted[0][0][0].heights.shape == (64, 64)

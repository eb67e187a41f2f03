"""Compiling ahead: every kind of scene that has loops of its own."""

from oracles.inside import SAMPLERS

from mcgw.commands import warm


def test_scenes_of_every_kind_are_drawn(monkeypatch):
    """And a map is fitted."""
    scenes, fitted = [], []
    monkeypatch.setattr("mcgw.ensemble.simulation.simulate", scenes.append)
    monkeypatch.setattr("mcgw.maps.fitting.fit", lambda *words, **options: fitted.append((words, options)))
    warm.warm()
    assert {scene.sampler for scene in scenes} == set(SAMPLERS)
    assert {scene.keep for scene in scenes} == {"sums", "statistics"}
    assert {scene.count for scene in scenes} == {"fixed", "poisson"}
    assert {scene.hertzian for scene in scenes} == {True, False}
    assert {scene.unload_from for scene in scenes} == {None, 0.0}
    assert {scene.summits is None for scene in scenes} == {True, False}
    assert max(scene.n_asperities for scene in scenes) == 10**6
    assert [options for _, options in fitted] == [{"cutoff": "8 um"}]
    assert fitted[0][0][0].heights.shape == (64, 64)

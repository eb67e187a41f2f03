"""What a person at a prompt types first: a mean at a separation, units, generators."""

import numpy as np
import pytest

import analytic
import mcgw

_SURFACE = mcgw.Surface("1 um", "10 um", "1000/mm^2", "1 mm^2", "72 GPa")


def test_a_mean_at_a_separation():
    ensemble = mcgw.simulate(mcgw.Scene(_SURFACE, separations=[2.0, 0.1 + 0.2, 1.0], n_surfaces=20, seed=1))
    for kind in ("mean", "std", "stderr"):
        every = getattr(ensemble, kind)("pressure")
        for asked, which in ((2.0, [0]), (0.3, [1]), ([1.0, 2.0], [2, 0])):
            np.testing.assert_array_equal(
                getattr(ensemble.sel(separation=asked), kind)("pressure"), every[which]
            )
    with pytest.raises(ValueError, match=r"^separation = 1\.5: there are 2, 0\.3, 1; scene\.theory has"):
        ensemble.sel(separation=[1.0, 1.5])


def test_a_body_with_units():
    assert mcgw.Body("70 GPa", 0.33) == analytic.Body(70e9, 0.33) == mcgw.Body(70e9, nu=0.33)
    assert mcgw.composite_modulus([mcgw.Body("70 GPa", 0.5), mcgw.Body(np.inf)]) == pytest.approx(70e9 / 0.75)
    for given, line in (
        (("70 m",), "E = '70 m': give a finite number > 0 in Pa"),
        ((-1.0,), "E = -1.0: give a finite number > 0 in Pa"),
        ((7e10, 0.6), "nu = 0.6: give a finite number"),
        ((7e10, "x"), "nu = 'x': give a finite number"),
    ):
        with pytest.raises(mcgw.SceneError) as error:
            mcgw.Body(*given)
        assert len(error.value.problems) == 1
        assert error.value.problems[0].startswith(line)


_SOURCES = {
    "generator": lambda: np.random.default_rng(7),
    "old bits": lambda: np.random.Generator(np.random.MT19937(7)),
    "bits": lambda: np.random.PCG64(7),
    "sequence": lambda: np.random.SeedSequence(7),
}


@pytest.mark.parametrize("name", _SOURCES)
def test_a_seed_from_numpy(name):
    """It is drawn once and recorded; the next of a generator is another one, of a sequence the same."""
    source = _SOURCES[name]()
    scene = mcgw.Scene(_SURFACE, separations=[1.0], n_surfaces=3, seed=source)
    assert type(scene.seed) is int
    assert scene.seed == mcgw.Scene(_SURFACE, separations=[1.0], seed=_SOURCES[name]()).seed
    assert mcgw.scene_from(mcgw.scene_text(scene)) == scene
    changed = scene.replace(seed=source).seed
    assert (changed == scene.seed) == (name == "sequence")
    assert changed == mcgw.Scene(_SURFACE, separations=[1.0], seed=source).seed or name != "sequence"


@pytest.mark.parametrize("seed", ["x", -1, 2**64, 1.5, np.random.RandomState(1)])
def test_other_seeds_are_refused_as_before(seed):
    with pytest.raises(
        mcgw.SceneError, match=r"ensemble\.seed = .*: give a whole number from 0 to 2\^64 - 1"
    ):
        mcgw.Scene(_SURFACE, separations=[1.0], seed=seed)

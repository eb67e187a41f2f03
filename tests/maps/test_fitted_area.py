"""A fitted scene on another nominal area than that of its map: N follows, in files, options and Python."""

import numpy as np
import pytest

import mcgw
from mcgw.cli import main

LAWS = ["gaussian", "nayak", "table"]


@pytest.fixture(scope="module")
def heights():
    z = np.random.default_rng(1).normal(size=(96, 96))
    for axis in (0, 1):
        z = sum(np.roll(z, k, axis) for k in range(-2, 3))
    return 1e-7 * z


@pytest.fixture
def folder(tmp_path, in_tmp_path, heights):
    np.save("map.npy", heights)
    return tmp_path


def fit(*more, code=0):
    assert main(["fit", "map.npy", "--pixel", "1um", "--cutoff", "none", "-o", "f.toml", *more]) == code


@pytest.mark.parametrize("law", LAWS)
def test_the_area_of_a_fitted_file_can_be_changed_by_hand(folder, law):
    fit("--heights", law)
    before = mcgw.load_scene("f.toml")
    text = (folder / "f.toml").read_text()
    (line,) = [line for line in text.splitlines() if line.startswith("nominal_area =")]
    (folder / "f.toml").write_text(text.replace(line, 'nominal_area = "1 cm^2"'))
    after = mcgw.load_scene("f.toml")
    assert after.surface.nominal_area == 1e-4
    assert after.n_asperities == round(before.surface.eta * 1e-4) > 1000 * before.n_asperities
    assert after.replace(nominal_area=before.surface.nominal_area) == before


@pytest.mark.parametrize("law", LAWS)
def test_an_option_and_an_argument_give_the_same_area(folder, law, heights):
    fit("--heights", law, "--nominal-area", "0.5 mm^2")
    scene = mcgw.load_scene("f.toml")
    found = mcgw.fit("map.npy", cutoff=None, pixel="1 um")
    of_map = mcgw.fitted_scene(found, heights=law)
    assert of_map.surface.nominal_area != 5e-7
    for one in (scene, mcgw.fitted_scene(found, heights=law, nominal_area="0.5 mm^2")):
        assert one.surface.nominal_area == 5e-7
        assert one.n_asperities == pytest.approx(of_map.surface.eta * 5e-7, rel=1e-3)
        assert type(one.heights) is type(of_map.heights)

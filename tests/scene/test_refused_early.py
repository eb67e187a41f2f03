"""What used to be refused late, wrongly, or by a message that misleads."""

import re
import warnings

import numpy as np
import pytest
import scipy.stats as st
from oracles.scenes import scene_by
from scipy.integrate import quad

import analytic
import mcgw
from mcgw.cli import main

_SURFACE = mcgw.Surface("1 um", "10 um", "1000/mm^2", "1 mm^2", "100 GPa")
_ENDS = {
    "pearson3(-1.2)": (st.pearson3(-1.2), 2 / 1.2),
    "triang(0.2)": (st.triang(0.2), 0.6 / np.sqrt(0.84 / 18)),
    "triang(0)": (st.triang(0.0), 2 * np.sqrt(2)),
    "cosine": (st.cosine(), np.pi / np.sqrt(np.pi**2 / 3 - 2)),
}


@pytest.mark.parametrize("name", _ENDS)
def test_a_density_ends_where_scipy_does_not_say(name):
    given, end = _ENDS[name]
    heights = analytic.ScipyHeights(given)
    assert heights.support[1] == pytest.approx(end, rel=1e-9)
    h = end - 0.047
    exact = quad(lambda t: t**1.5 * float(heights.pdf(np.array(h + t))), 0, end - h, epsrel=1e-11, epsabs=0)
    model = analytic.Model(_SURFACE, heights=heights)
    unit = 1000 * 4 / 3 * 1e11 * 1e-5**0.5 * 1e-6**1.5
    assert float(model.mean("load", h)) == pytest.approx(unit * exact[0], rel=1e-9)


def test_the_low_end_too_and_none_where_there_is_none():
    assert analytic.ScipyHeights(st.pearson3(0.8)).support == pytest.approx((-2.5, np.inf))
    for law in (st.norm(), st.gumbel_l(), st.t(6), st.laplace(), st.skewnorm(-8.0), st.gamma(4)):
        assert analytic.ScipyHeights(law).support[1] == np.inf


@pytest.mark.parametrize("quantities", [None, ["stiffness"], ["area", "load_slope", "load"]])
def test_what_breaks_off_is_told_with_the_list_to_give(quantities):
    law = {"name": "johnson-kendall-roberts", "pull_off": 0.1}
    with pytest.raises(mcgw.SceneError) as error:
        mcgw.Scene(
            _SURFACE,
            separations=[0.0, 1.0],
            law=law,
            contact=mcgw.Contact(unload_from=0.0, quantities=quantities),
        )
    (line,) = error.value.problems
    names = re.search(r"; give \[(.*)\], or leave out unload_from$", line)[1].replace('"', "").split(", ")
    assert names == {0: ["load", "area", "contacts"], 1: ["load"], 3: ["area", "load"]}[len(quantities or ())]
    mcgw.Scene(
        _SURFACE, separations=[0.0, 1.0], law=law, contact=mcgw.Contact(unload_from=0.0, quantities=names)
    )


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("[surface]\nsigma = 1 um\n", 'sigma = 1 um; quote a text with its unit: sigma = "1 um"'),
        ("[surface]\nradius = 1.3e-5m # R\n", 'quote a text with its unit: radius = "1.3e-5m"'),
        ("[contact]\nlaw = hertz\n", 'law = hertz; quote a text: law = "hertz"'),
        ("[surface]\nradius 1e-5\n", "radius 1e-5; write key = value"),
        ("[surface]\nsigma = 1e-6\n[surface]\n", ": [surface]"),
        ("[grading\n", ": [grading"),
        ('title = "a\n', ': title = "a'),
        ("a = [1,\n", ""),
    ],
)
def test_a_line_that_is_no_toml_is_quoted_with_its_cure(text, line, tmp_path, capsys):
    path = tmp_path / "bad.toml"
    path.write_text(text)
    for command in (["run", str(path)], ["solve", str(path), "--load", "1"], ["show", "--plan", str(path)]):
        assert main(command) == 2
        told = capsys.readouterr().err
        assert told.startswith(f"mcgw: {path}: this is not TOML: ")
        assert told.endswith(f"{line}\n")
        assert told.count("\n") == 1
    with pytest.raises(mcgw.SceneError, match=r"^this is not TOML: "):
        mcgw.scene_from(text)


@pytest.mark.parametrize(
    ("n", "surfaces", "separation"), [(10**12, 1000, 0.0), (2 * 10**12, 1, 0.0), (10**14, 1000, 4.0)]
)
def test_hours_of_drawing_are_told_when_the_scene_is_made(n, surfaces, separation, tmp_path, capsys):
    def made(**others):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            asked = {"n_asperities": n, "n_surfaces": surfaces, "seed": 1} | others
            scene = scene_by(_SURFACE, separations=[separation, separation + 1], **asked)
        return scene, [str(each.message) for each in caught if "hours" in str(each.message)]

    scene, (line,) = made()
    share = st.norm.sf(separation)
    told = re.fullmatch(
        r'ensemble: .* take about (\S+) hours; give fewer, .* or sampler = "aggregate".*', line
    )
    assert float(told[1]) == pytest.approx(n * share * surfaces * 4.4e-9 / 3600, rel=0.06)
    assert not made(sampler="aggregate")[1]
    assert not made(n_asperities=int(n / float(told[1]) * 0.9))[1]
    assert made(n_asperities=min(int(n / float(told[1]) * 1.1), 2**53))[1]
    assert not made(max_seconds=60.0)[1]
    (tmp_path / "a.toml").write_text(mcgw.scene_text(scene))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert main(["show", "--plan", str(tmp_path / "a.toml")]) == 0
    assert capsys.readouterr().err.count(line) == 1


def test_a_plane_that_sinks_faster_than_it_is_pressed_is_told_up_to_where():
    """The nominal separation h - c P(h)/sigma falls below 1.5 for a half-space as soft as this."""
    plain = mcgw.Scene(_SURFACE, separations=[0.0, 1.0, 2.0], seed=1)
    soft = mcgw.Interaction("mean-plane", bulk_modulus=1e9)
    above, below = (float(plain.theory.mean("load", 1.5 + step)) for step in (-1e-4, 1e-4))
    ratio = soft.compliance(_SURFACE, plain.n_asperities) * (above - below) / 2e-4 / _SURFACE.sigma
    for_1_5 = 1e9 * abs(ratio)
    plain.replace(interaction=mcgw.Interaction("mean-plane", bulk_modulus=1e3 * for_1_5))
    with pytest.raises(mcgw.SceneError, match=r"^interaction: at d/sigma = 1 the mean plane sinks faster"):
        plain.replace(interaction=mcgw.Interaction("mean-plane", bulk_modulus=for_1_5))

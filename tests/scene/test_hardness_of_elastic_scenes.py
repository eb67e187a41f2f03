"""A hardness beside a law that stays elastic: taken everywhere, it changes no value."""

import pytest
from oracles.scenes import scene_by

import analytic
import mcgw

_SURFACE = mcgw.Surface("1 um", "10 um", "1000/mm^2", "1 mm^2", "100 GPa")
_LAWS = {
    "hertz": {},
    "power-law-graded": {"k": 0.3, "c0": "10 um"},
    "coated": {"ratio": 2.0, "thickness": "1 um"},
    "derjaguin-muller-toporov": {"work": "0.01 J/m^2"},
    "johnson-kendall-roberts": {"pull_off": 0.01},
}
_OWN = ("power-law-graded", "coated")  # have a Poisson's ratio already
_TEXT = """[surface]
sigma = 1e-6
radius = 1e-5
eta = 1e9
nominal_area = 1e-6
E_star = 1e11
[contact]
separations = [0.0, 1.0]
"""


def _scene(law, **others):
    given = {"name": law, **_LAWS.get(law, {})}
    return scene_by(_SURFACE, separations=[0.0, 1.0], law=given, n_surfaces=3, seed=1, **others)


@pytest.mark.parametrize("law", _LAWS)
def test_poisson_is_that_of_the_law_where_it_has_one(law):
    if law in _OWN:
        given = {"name": law, **_LAWS[law], "poisson": 0.4, "hardness": 2e9}
        scene = mcgw.Scene(_SURFACE, separations=[0.0], law=given)
        assert scene.poisson is None
        assert scene.law.poisson == 0.4
    else:
        scene = _scene(law, hardness=2e9, poisson=0.4)
    assert scene.softer == (2e9, 0.4)
    assert mcgw.scene_from(mcgw.scene_text(scene)) == scene


def test_the_share_of_a_scene():
    scene = _scene("hertz", hardness="10 GPa", poisson=0.25)
    share = analytic.yielding_share(scene.theory, [0.0, 1.0], *scene.softer)
    law = analytic.KogutEtsion(hardness=10e9, poisson=0.25)
    yielding = mcgw.Scene(
        _SURFACE, separations=[0.0, 1.0], law=law, contact=mcgw.Contact(quantities=["contacts", "yielded"])
    )
    exact = yielding.theory.mean("yielded", [0.0, 1.0]) / yielding.theory.mean("contacts", [0.0, 1.0])
    assert share == pytest.approx(exact, rel=1e-9)


def test_a_law_by_its_word_takes_its_own():
    by_word = mcgw.Scene(
        _SURFACE, separations=[0.0], law="kogut-etsion", contact=mcgw.Contact(hardness="2 GPa", poisson=0.33)
    )
    assert by_word.law == analytic.KogutEtsion(hardness=2e9, poisson=0.33)
    assert (by_word.hardness, by_word.poisson, by_word.softer) == (None, None, None)
    of_file = mcgw.scene_from(
        f'{_TEXT}[contact.law]\nname = "kogut-etsion"\nhardness = "2 GPa"\npoisson = 0.33\n'
    )
    assert (of_file.law, of_file.softer) == (by_word.law, None)


def test_a_poisson_without_a_hardness_is_refused_beside_hertz():
    for make in (
        lambda: mcgw.Scene(_SURFACE, separations=[0.0], contact=mcgw.Contact(poisson=0.3)),
        lambda: mcgw.scene_from(f"{_TEXT}[contact.law]\npoisson = 0.3\n"),
    ):
        with pytest.raises(mcgw.SceneError, match=r"^contact\.law\.poisson = 0\.3: give ") as error:
            make()
        assert len(error.value.problems) == 1


@pytest.mark.parametrize(
    "law",
    [
        analytic.KogutEtsion(hardness=1e9),
        analytic.ZhaoMaiettaChang(hardness=1e9),
        analytic.JacksonGreen(yield_strength=4e8),
        analytic.CustomLaw([lambda u: u**3], [lambda u: u**2], [], 0.05),
    ],
    ids=lambda law: law.name,
)
def test_a_law_that_yields_has_its_own(law):
    for key, value in (("hardness", 2e9), ("poisson", 0.2)):
        with pytest.raises(mcgw.SceneError) as error:
            scene_by(_SURFACE, separations=[0.0], law=law, **{key: value})
        advice = f"give it to the law, {type(law).__name__}, or leave it out"
        assert error.value.problems == [f"contact.law.{key} = {value}: {advice}"]


def test_a_law_of_python_that_has_a_poisson_keeps_it():
    law = analytic.Coated(ratio=2.0, thickness=1e-6, poisson=0.25)
    assert mcgw.Scene(_SURFACE, separations=[0.0], law=law, contact=mcgw.Contact(hardness=2e9)).softer == (
        2e9,
        0.25,
    )
    with pytest.raises(mcgw.SceneError, match=r"contact\.law\.poisson = 0\.2: give it to the law, Coated"):
        mcgw.Scene(_SURFACE, separations=[0.0], law=law, contact=mcgw.Contact(hardness=2e9, poisson=0.2))

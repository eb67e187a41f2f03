"""A hardness beside a law that stays elastic: taken everywhere, it changes no value."""

import pytest
from oracles.scenes import scene_by

import analytic
import mcgw

SURFACE = mcgw.Surface("1 um", "10 um", "1000/mm^2", "1 mm^2", "100 GPa")
GRADED = {"name": "power-law-graded", "k": 0.3, "c0": "10 um"}  # has a Poisson's ratio already
COATED = analytic.Coated(ratio=2.0, thickness=1e-6, poisson=0.25)


def scene(law, **others):
    return scene_by(SURFACE, separations=[0.0, 1.0], law=law, n_surfaces=3, seed=1, **others)


@pytest.mark.parametrize(
    ("law", "beside", "softer"),
    [
        ("hertz", {"hardness": "2 GPa", "poisson": 0.4}, (2e9, 0.4)),
        ("hertz", {"hardness": "2 GPa"}, (2e9, 0.3)),
        (
            {"name": "johnson-kendall-roberts", "pull_off": 0.01},
            {"hardness": 2e9, "poisson": 0.4},
            (2e9, 0.4),
        ),
        ({**GRADED, "poisson": 0.4, "hardness": 2e9}, {}, (2e9, 0.4)),
        (COATED, {"hardness": 2e9}, (2e9, 0.25)),
        ("kogut-etsion", {"hardness": "2 GPa", "poisson": 0.33}, None),  # its own
    ],
)
def test_what_tells_whether_contacts_yield(law, beside, softer):
    found = scene(law, **beside)
    assert found.softer == softer
    assert mcgw.scene_from(mcgw.scene_text(found)) == found
    assert softer or found.law == analytic.KogutEtsion(hardness=2e9, poisson=0.33)


def test_the_share_of_a_scene():
    elastic = scene("hertz", hardness="10 GPa", poisson=0.25)
    share = analytic.yielding_share(elastic.theory, [0.0, 1.0], *elastic.softer)
    theory = scene(analytic.KogutEtsion(hardness=10e9, poisson=0.25), quantities=["yielded"]).theory
    exact = theory.mean("yielded", [0.0, 1.0]) / theory.mean("contacts", [0.0, 1.0])
    assert share == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize(
    ("law", "beside", "line"),
    [
        ("hertz", {"poisson": 0.3}, "poisson = 0.3: give hardness too, or leave it out"),
        (
            {"name": "hertz", "k": 0.3},
            {},
            "k: unknown key; it is for name = 'power-law-graded' only; leave it out",
        ),
        (
            COATED,
            {"hardness": 2e9, "poisson": 0.2},
            "poisson = 0.2: give it to the law, Coated, or leave it out",
        ),
        *(
            (law, {key: value}, f"{key} = {value}: give it to the law, {type(law).__name__}, or leave it out")
            for law in (
                analytic.KogutEtsion(hardness=1e9),
                analytic.JacksonGreen(yield_strength=4e8),
                analytic.CustomLaw([lambda u: u**3], [lambda u: u**2], [], 0.05),
            )
            for key, value in (("hardness", 2e9), ("poisson", 0.2))
        ),
    ],
)
def test_what_says_nothing_beside_a_law_is_refused(law, beside, line):
    with pytest.raises(mcgw.SceneError) as error:
        scene(law, **beside)
    assert error.value.problems == [f"contact.law.{line}"]

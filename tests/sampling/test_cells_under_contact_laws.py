"""`cells` under every contact law against exactly rounded sums of each asperity's own formula."""

import re

import numpy as np
import pytest
from conftest import SURFACE
from oracles.accurately import worst_error
from oracles.scenes import scene_by
from tables.drawn_scenes import CLOSE_KINKS

import analytic
import mcgw
from analytic import laws

LAWS = {
    "kogut": laws.KogutEtsion(critical=0.05),
    "kogut-soft": laws.KogutEtsion(critical=0.001),
    "kogut-hard": laws.KogutEtsion(critical=10.0),
    "kogut-bridged": laws.KogutEtsion(critical=0.05, bridge="hermite"),
    "chang": laws.ChangEtsionBogy(critical=0.05),
    "zhao": laws.ZhaoMaiettaChang(critical=0.05),
    "jackson": laws.JacksonGreen(yield_strain=0.004, critical=0.1),
    "half-space": laws.PowerLawGraded(0.5, reduced_c0=1.0),
    "coated": laws.Coated(reduced_thickness=0.5, ratio=3.0),
    "derjaguin": laws.DerjaguinMullerToporov(pull_off=0.05),
    "johnson": laws.JohnsonKendallRoberts(pull_off=0.05),
    "johnson-sticky": laws.JohnsonKendallRoberts(pull_off=0.5),
}
GRADINGS = {
    "homogeneous": analytic.Homogeneous(),
    "gamma-0": analytic.Exponential(0.0),
    "gamma-0.2": analytic.Exponential(0.2),
    "gamma-2": analytic.Exponential(2.0),
    "table": analytic.Table((-4.0, 0.0, 1.0, 4.0), (0.5, 1.0, 2.0, 1.5)),
    "close-kinks": CLOSE_KINKS,
}
SEPARATIONS = {
    "equal": tuple(np.linspace(0, 3, 7)),
    "geometric": tuple(np.geomspace(0.01, 3, 6)),
    "random": tuple(0.5 + 2 * np.random.default_rng(4).random(6)),
    "close": (1.0, 1.0 + 1e-9, 1.5),
}
# Every law, every grading and every kind of separations. Slow: every law with every grading, and with
# every kind of separations; cells refuse some of the close kinks where a separation is next to them.
TABLE = """
kogut           close-kinks  random       kogut           homogeneous  equal
kogut-soft      gamma-0      equal        kogut-hard      gamma-0.2    equal
kogut-bridged   gamma-2      close        chang           table        geometric
zhao            close-kinks  close        jackson         gamma-2      random
half-space      gamma-0      equal        coated          table        close
derjaguin       gamma-0.2    close        johnson         table        geometric
johnson-sticky  close-kinks  geometric    johnson-sticky  gamma-2      random
"""
PAIRS = re.findall(r"(\S+) +(\S+) +(\S+)", TABLE)
KINDS = list(SEPARATIONS)
REST = [(a, b, KINDS[(i + j) % 4]) for i, a in enumerate(LAWS) for j, b in enumerate(list(GRADINGS)[:5])]
REST = [rest for rest in REST if rest not in PAIRS]
QUANTITIES = ("load", "area", "stiffness", "contacts", "conductance", "load_slope")


def scene_of(law, grading, separations, **changes):
    names = QUANTITIES if law.elastic else (*QUANTITIES, "yielded")
    if "unload_from" in changes and not law.stiff:
        names = ("load", "area", "contacts", "conductance")
    values = {"quantities": names, "n_asperities": 5000, "n_surfaces": 1, "seed": 11, "negative": "clip"}
    values |= {"sampler": "cells"}
    return scene_by(SURFACE, law=law, grading=grading, separations=separations, **(values | changes))


@pytest.mark.parametrize(
    ("law", "grading", "separations"), PAIRS + [pytest.param(*x, marks=pytest.mark.slow) for x in REST]
)
def test_sums_are_those_of_the_asperities(law, grading, separations):
    back = {} if law in ("chang", "zhao", "jackson") else {"unload_from": "loop"}
    assert worst_error(scene_of(LAWS[law], GRADINGS[grading], SEPARATIONS[separations], **back), 1) < 1e-12


def test_asperities_outside_the_cells_follow_the_law_too():
    scene = scene_of(LAWS["kogut"], analytic.Exponential(2.0), (2.0, 2.5, 3.0, 4.5), n_asperities=20_000)
    assert worst_error(scene, 15) < 1e-12
    assert worst_error(scene.replace(sampler="tail"), 15) < 1e-12


@pytest.mark.parametrize(
    ("name", "way"),
    [("chang", {}), ("kogut", {"unload_from": "loop"}), ("johnson", {"unload_from": "loop"})],
)
def test_contacts_are_counted_where_nothing_else_is_asked(name, way):
    """Under laws that yield or stick, of the very surfaces whose heights are told."""
    given = {"law": LAWS[name], "quantities": ["contacts"], "n_surfaces": 2, "n_asperities": 3000, "seed": 5}
    scene = scene_by(SURFACE, separations=[0.0, 1.0], sampler="cells", **given, **way)
    counted = [[np.sum(mcgw.heights(scene, i) > h) for h in scene.separations] for i in range(2)]
    assert np.array_equal(mcgw.simulate(scene).contacts, counted)


def test_contacts_that_dwindle_towards_asperities_which_soften(make_scene):
    """On the way back a row from farther below is the rougher one on a cell next to where it is lost."""
    scene = make_scene(
        separations=(-2.34, -1.45, -0.65), grading=lambda s: 1 + 0.8 * np.sin(13.2 * s + 0.56),
        law=laws.KogutEtsion(critical=0.0446), heights=analytic.ExponentialHeights(), unload_from=-6.6,
        n_asperities=30, n_surfaces=60, quantities=("stiffness",), sampler="cells",
    )  # fmt: skip
    assert worst_error(scene, 60) < 1e-11

"""Theory of asperities that press each other down: identities, values from elsewhere, pairs at places."""

import math
import runpy
from dataclasses import replace
from pathlib import Path

import mpmath
import numpy as np
import pytest
from conftest import SURFACE
from oracles.interacting_by_hand import interaction

import analytic
from analytic import Model
from analytic.interaction import BOWL, LATTICE

H = np.array([0.0, 0.8, 2.0])


def test_mean_sinking_of_a_square():
    """Integral of (1 - x)(1 - y)/r over the square, the distances of two of its points, in polar form."""

    def along(angle):
        """Of (1 - r cos)(1 - r sin) up to r = 1/cos."""
        tan = mpmath.tan(angle)
        return (1 - (1 + tan) / 2 + tan / 3) / mpmath.cos(angle)

    mean = 8 / mpmath.pi * mpmath.quad(along, [0, mpmath.pi / 4])
    assert pytest.approx(float(mean), rel=1e-14) == BOWL


def test_potential_of_a_square_lattice():
    """By zeta functions."""
    beta = (mpmath.zeta(0.5, 0.25) - mpmath.zeta(0.5, 0.75)) / 2
    assert pytest.approx(float(-4 * mpmath.zeta(0.5) * beta), rel=1e-14) == LATTICE


@pytest.mark.parametrize(
    ("strength", "grading"),
    [(3.0, analytic.Exponential(2.0)), (-0.3, analytic.Custom(lambda s: 1 + 0.3 * np.tanh(s)))],
)
def test_compliances_add(strength, grading):
    """Of a surface so large that it does not fluctuate; and the stiffness is the slope of the load."""
    n = 1e16
    how = interaction(strength, SURFACE, n)
    model = Model(SURFACE, n_asperities=n, interaction=how, grading=grading)
    sunk = model.compliance * SURFACE.sigma
    stiffness = model.mean("stiffness", H)
    apart = 1 / model.alone.mean("stiffness", H)
    np.testing.assert_allclose(1 / stiffness - apart, sunk, rtol=1e-12 * (apart / abs(sunk)).max())
    assert (np.abs(sunk) / apart > 5e-3).all()  # without it, 1/K would be off by so much
    step = 1e-3

    def change(name):
        found = [model.mean(name, H + k * step) for k in (-2, -1, 1, 2)]
        return found[0] - 8 * found[1] + 8 * found[2] - found[3]

    slope = -change("load") / change("nominal_separation") / SURFACE.sigma
    np.testing.assert_allclose(stiffness, slope, rtol=1e-9)


GAP = analytic.Joint("air", rms=1.6e-6).gap(SURFACE, analytic.Gaussian())
SUMS = ("load", "stiffness", "conductance_si")


def literal_answers(reference, h, n, rho):
    """What a surface answers by its own load P, stiffness K and conductance C of the spots, in SI."""
    area, E, sigma = SURFACE.nominal_area, SURFACE.E_star, SURFACE.sigma
    sunk = {None: 0, "body": BOWL / math.sqrt(area), "mean-plane": -LATTICE / math.pi / math.sqrt(n * area)}
    sunk = sunk[reference] / E
    plane = sunk if reference == "mean-plane" else 0
    around = BOWL / 2 * rho * math.sqrt(area) if reference == "body" else 0

    def gas(x):
        return float(GAP(h - plane * x[0] / sigma))

    def joint(x):
        spots = 1 / (1 / x[2] + (rho * E / 2 * sunk if plane else 0)) / area + gas(x)
        return 1 / (1 / spots + around)

    return {
        "stiffness": lambda x: 1 / (1 / x[1] + sunk),
        "conductance_si": lambda x: 1 / (1 / x[2] + rho * E / 2 * sunk),
        "gap_conductance": gas,
        "joint_conductance": joint,
    } | ({"nominal_separation": lambda x: h - sunk * x[0] / sigma} if reference else {})


@pytest.mark.parametrize("reference", [None, "body", "mean-plane"])
def test_means_and_covariances_follow_from_those_of_sums(reference):
    """By differences of each answer by the sums that it follows from; of 100 contacts."""
    h, n, film = 1.0, 600, analytic.Film(conductivities=(16.0, 20.0))
    alone = Model(SURFACE, film=film, n_asperities=n, count="poisson")
    pressed = None if reference is None else analytic.Interaction(reference)
    model = replace(alone, interaction=pressed, filled=GAP)
    answers = literal_answers(reference, h, n, film.rho)
    at, covariance = np.array([alone.mean(x, h) for x in SUMS]), alone.covariance(SUMS, [h])[:, 0, :, 0]
    steps = 1e-4 * np.diag(at)
    rates = np.array([[(f(at + d) - f(at - d)) for d in steps] for f in answers.values()]) / (2e-4 * at)
    bends = [
        np.array([f(at + d) + f(at - d) - 2 * f(at) for d in steps]) / (1e-4 * at) ** 2
        for f in answers.values()
    ]
    for (name, f), bend in zip(answers.items(), bends, strict=True):
        second = bend @ np.diag(covariance) / 2
        assert float(model.mean(name, h)) == pytest.approx(
            f(at) + second, rel=1e-9, abs=1e-3 * abs(second)
        ), name
    found = model.covariance(list(answers), [h])[:, 0, :, 0]
    wanted = rates @ covariance @ rates.T
    spread = np.sqrt(wanted.diagonal())
    size = np.outer(spread, spread) + 1e-300  # gas between planes at one distance has no spread
    np.testing.assert_allclose(found / size, wanted / size, atol=1e-6)
    for name in ("gap_conductance", *(["joint_conductance"] if reference == "mean-plane" else [])):
        with pytest.raises(ValueError, match="only 'joint_conductance' is known"):
            model.distribution(name, h)


# Load of the mean field over that of pairs, less 1, and area of pairs over that of independent asperities at
# the same load, h = 0, 1, 2: of another script, with other heights and places. What means of 16 surfaces
# scatter by from seed to seed was seen on eight seeds; gates are about four times that.
PRINTED = {"rms": (0.066, 0.047, 0.037), "area": (0.984, 0.988, 0.995)}


@pytest.mark.slow
def test_the_mean_field_against_pairs():
    """A punch as printed elsewhere; a periodic cell, where the lattice's shift leaves a few of 27 % error."""
    study = runpy.run_path(str(Path(__file__).parents[2] / "runs" / "interaction_witness.py"))["study"]
    rows = study("body")
    assert [x.error_field for x in rows] == pytest.approx(PRINTED["rms"], abs=0.02)
    assert [x.area for x in rows] == pytest.approx(PRINTED["area"], abs=0.01)
    assert rows[0].error_independent > 1.5  # nearly three times the load
    rows = study("mean-plane", surfaces=6)
    assert rows[0].error_independent > 0.2
    assert all(x.error_field < 0.07 and x.error_field < x.error_independent for x in rows)
    assert all(x.independent < x.field < x.pairs for x in rows)

"""One colour for one meaning, told apart by readers who see no red or no green, and in grey print."""

import itertools

import numpy as np
import pytest

from mcgw.figures import style

pytestmark = pytest.mark.site

# Machado, Oliveira and Fernandes 2009 (doi:10.1109/TVCG.2009.113), severity 1.0, on linear RGB.
EYES = {
    "all cones": np.eye(3),
    "protanopia": [
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]
    ],
}  # fmt: skip
# CIE 1976 units: 2.3 is just seen side by side; lines apart from each other need several times that.
LEAST, LEAST_GREY = 15.0, 7.0

GRADINGS = [style.GRADINGS[g] for g in (0.2, 0.5, 0.8, 1.0, 1.2, 1.5, 2.0)]
PALETTES = {
    "gradings": GRADINGS,
    "categories": [*style.CATEGORIES, style.HOMOGENEOUS],
    "separations": list(style.SEPARATIONS),
    "steps": list(style.STEPS),
    "theory and Monte Carlo": [style.THEORY, style.MONTE_CARLO, style.SAMPLE, style.HOMOGENEOUS],
}


def lab(colour, eyes="all cones"):
    """CIELAB of an sRGB colour as these eyes see it."""
    coded = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    linear = np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)
    seen = np.clip(np.array(EYES[eyes]) @ linear, 0, 1)
    to_xyz = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    t = np.array(to_xyz) @ seen / [0.9505, 1.0, 1.0890]
    x, y, z = np.where(t > (6 / 29) ** 3, np.cbrt(t), t * (29 / 6) ** 2 / 3 + 4 / 29)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def nearest(colours, eyes):
    return min(np.linalg.norm(lab(a, eyes) - lab(b, eyes)) for a, b in itertools.combinations(colours, 2))


def test_the_measure_is_that_of_the_standard():
    """White, the primary red of sRGB, and red and green that dichromats confuse."""
    np.testing.assert_allclose(lab("#FFFFFF"), [100, 0, 0], atol=0.05)
    np.testing.assert_allclose(lab("#FF0000"), [53.24, 80.09, 67.20], atol=0.05)
    red, green = "#B33A3A", "#6B7A1E"
    assert np.linalg.norm(lab(red) - lab(green)) > 60
    assert np.linalg.norm(lab(red, "deuteranopia") - lab(green, "deuteranopia")) < 35


def test_colours_that_meet_are_told_apart():
    for name, palette in PALETTES.items():
        for eyes in EYES:
            assert nearest(palette, eyes) > LEAST, (name, eyes)
        grey = np.sort([lab(colour)[0] for colour in palette])
        assert np.diff(grey).min() > LEAST_GREY, name


def test_gradings_are_ordered():
    """Lighter the farther from homogeneous, blue above it and orange below, in between too."""
    for gammas, blue in (((1.05, 1.2, 1.4, 2.0, 8.0), True), ((0.95, 0.8, 0.6, 0.4, 0.1), False)):
        found = [lab(style.look(f"γ = {g:g}")["color"]) for g in gammas]
        assert np.all(np.diff([x[0] for x in found]) >= 0)
        assert all((x[2] < 0) == blue for x in found)
    assert style.look("γ = 1")["color"] == style.HOMOGENEOUS


def test_what_a_figure_shows_together_has_other_dashes_and_markers_too():
    for family in (*style.FAMILIES, *style.PAIRS):
        looks = [style.look(name) for name in family]
        for key in ("color", "linestyle", "marker"):
            assert len({str(look[key]) for look in looks}) == len(family), (family, key)

"""Figures of the paper, those it lacks, those of any scene: every Monte-Carlo point against theory."""

import csv
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from conftest import SURFACE
from oracles import inside
from oracles.crowding import crowded
from oracles.inside import CATALOGUE, Compared, FigureData, _ratio as ratio_of_sums, draw, figures_of
from oracles.scenes import scene_by
from oracles.told import mark
from scipy.integrate import quad
from scipy.stats import norm

import analytic
import mcgw

THEORY_ALONE = {"figure-1"}


@pytest.fixture(scope="module")
def figures():
    """All of the sweep; eta A_n is 5000, as pressures are per nominal area."""
    surface = replace(SURFACE, nominal_area=5000 / SURFACE.eta)
    scene = scene_by(surface, separations=0.0, n_surfaces=400, n_asperities=5000, seed=11)
    return dict(figures_of(Compared(scene, swept=True, most_listed=10)))


def points(data):
    return [s.points for panel in data.panels for s in panel.series if s.points is not None]


def said(figures):
    """Words, axes and numbers of figures, a line for each series."""
    for name, data in figures.items():
        if not isinstance(data, FigureData):
            yield f"{name}: {data}"
            continue
        yield f"{name}: {data.title}; {data.caption}"
        for panel in data.panels:
            axes = f"{panel.xlabel} | {panel.ylabel}, {' '.join(panel.scales)}, level {panel.level}"
            yield f" {panel.title or '-'}: {axes}"
            for s in panel.series:
                p = s.points
                parts = (s.x, s.theory, *((p.x, p.mean, p.stderr, p.theory) if p else ()))
                yield f"  {s.label}: {'; '.join(map(mark, parts))}"


def test_all_are_there_and_nothing_moves(figures, recorded):
    assert list(CATALOGUE) == list(figures)  # the names that are checked before one is drawn
    assert {name for name, data in figures.items() if not points(data)} == THEORY_ALONE
    recorded("figures.sweep", said(figures))


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=() if name == "figure-3" else pytest.mark.site) for name in CATALOGUE],
)
def test_panels_have_room(figures, name):
    assert not crowded(draw(figures[name]))


def test_every_point_agrees_with_theory(figures):
    """|z| < 5 at each of some 700 points, one false alarm in 2500 seeds for Gaussian means.

    Errors come from the surfaces, so points that few contacts make (below 20 in the ensemble, at
    h = 4 with 2 000 000 asperities there are 63) would not be Gaussian; there are none.
    """
    for name in figures.keys() - THEORY_ALONE:
        z = np.concatenate([p.residual for p in points(figures[name])])
        assert np.all(np.isfinite(z)), name
        assert np.abs(z).max() < 5, name
        assert np.abs(z).max() > 0.05, name  # points that are theory itself would be no test


def test_points_with_wrong_theory_would_show(figures):
    """The companion: at half the points of Fig. 6 an error of 0.03 in gamma is 5 standard errors."""
    for panel in figures["figure-6"].panels:
        for series in panel.series[:3]:
            h = float(series.label.split("=")[1])
            p = series.points
            slope = analytic.stiffness_ratio(h, analytic.Exponential(2.0)) - 1
            assert np.median(np.abs((p.mean - p.theory - 0.03 * slope) / p.stderr)) > 5


def test_numbers_of_the_paper(figures):
    """Independent of the functions behind the figures: theory.md's and the paper's own figures."""
    just, *_, by_load = figures["figure-4"].panels
    assert just.series[0].theory == pytest.approx(np.ones(73))  # s = 0: no effect, the paper's reading
    assert by_load.series[0].theory[-1] == pytest.approx(1.727, abs=5e-4)
    six = figures["figure-6"].panels[0].series
    assert six[1].theory[-1] == pytest.approx(1.802, abs=5e-4)
    assert six[4].theory[-1] == pytest.approx(2, abs=0.03)  # "C_FGM/C_HOM = gamma" at d/sigma = 4
    conductance = figures["equal-load"].panels[1].series[1]
    assert conductance.theory[[0, -1]] == pytest.approx([3.114, 0.548], abs=5e-4)
    stiffness = figures["equal-load"].panels[3].series[1]
    assert stiffness.theory[[0, -1]] == pytest.approx([0.945, 1.057], abs=5e-4)
    homogeneous = figures["area-and-load"].panels[1].series[1]
    assert np.all(np.diff(homogeneous.theory) > 0)
    assert homogeneous.theory[-1] < 1  # area grows slower than load, ever less so


def test_ratio_of_sums_against_repetition():
    """The stated error is the spread of repeated ratios: 200 of them know it to 5 %, four times that."""
    rng = np.random.default_rng(3)
    a = rng.gamma(3, size=(200, 500))
    b = 2 * a + rng.normal(size=a.shape)
    found = [ratio_of_sums([y, x], [x, x]) for x, y in zip(a, b, strict=True)]
    np.testing.assert_allclose(found[0], ratio_of_sums([b[0]], [a[0]]), rtol=1e-12)
    assert ratio_of_sums([0.3 * a[0]], [a[0]]) == (pytest.approx(0.3, rel=1e-14), 0.0)
    spread = np.std([r for r, _ in found], ddof=1)
    assert spread == pytest.approx(np.mean([e for _, e in found]), rel=0.2)


@pytest.mark.usefixtures("blank_figures")
def test_files_and_every_number_of_a_figure_in_its_csv(figures, tmp_path):
    paths = [tmp_path / f"f.{ending}" for ending in ("png", "pdf", "svg", "csv")]
    inside.save(figures["figure-6"], *paths)
    assert all(path.exists() for path in paths)
    found = list(csv.reader(paths[-1].read_text().splitlines()))[1:]
    wanted = []
    for panel in figures["figure-6"].panels:
        for s in panel.series:
            p = s.points
            wanted += [(panel.title, s.label, "line", *row) for row in zip(s.x, s.theory, strict=True)]
            told = zip(p.x, p.theory, p.mean, p.stderr, strict=True)
            wanted += [(panel.title, s.label, "point", *row) for row in told]
    assert [(*row[:3], *(float(x) for x in row[3:] if x)) for row in found] == wanted


# --- figures of a scene ----------------------------------------------------------------------------------

H = (0.0, 1.0, 2.0)
SOFT = mcgw.Surface("0.2 um", "50 um", "1000/mm^2", "1 mm^2", "10 MPa")


def scene_of(surface=SURFACE, **given):
    return scene_by(
        surface, **{"separations": H, "n_asperities": 20_000, "n_surfaces": 200, "seed": 3} | given
    )


def drawn(scene):
    """Figures by name, the names of those with no meaning, and why."""
    found = dict(figures_of(Compared(scene)))
    assert list(CATALOGUE) == list(found)
    figures = {name: x for name, x in found.items() if isinstance(x, FigureData)}
    without = {name: x for name, x in found.items() if name not in figures}
    assert all(isinstance(why, str) and why and "\n" not in why for why in without.values())
    return figures, without


YIELDS = {"law": mcgw.KogutEtsion(hardness=1.2e9, poisson=0.3), "grading": mcgw.Exponential(1.5)}
STICKS = {"law": mcgw.JohnsonKendallRoberts(work=0.05), "unload_from": "loop", "quantities": ["load"]}
SPECTRAL = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "100 GPa")
UNGRADED = {"figure-1", "figure-4"}
# Of each kind its scene, and the figures without meaning.
SCENES = {
    "graded": ({"grading": mcgw.Exponential(0.5)}, set()),
    "clipped": ({"grading": mcgw.Exponential(2.0), "negative": "clip", "separations": (-1.0, 0.0)}, set()),
    "coated": ({"law": mcgw.Coated(thickness=1e-6, ratio=3.0, poisson=0.3), "count": "poisson"}, UNGRADED),
    "sticks": ({"surface": SOFT, **STICKS}, UNGRADED | {"figure-3", "equal-load", "area-and-load"}),
    "interacting": ({"interaction": "body"}, UNGRADED),
    "homogeneous": ({}, UNGRADED | {"figure-3", "figure-6", "equal-load"}),
    # At d/sigma = 0 Hertz's asperities carry more than those that yield can.
    "yields, and back": (YIELDS | {"unload_from": "loop"}, {"equal-load"}),
    "own radii": ({"surface": SPECTRAL, "grading": mcgw.Exponential(0.5)}, set()),
}
RECORDED = ("graded", "coated", "sticks", "interacting")
DEAR = ("yields, and back", "own radii")  # seconds to half a minute of theory


@cache
def drawn_of(name):
    return drawn(scene_of(**SCENES[name][0]))


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if name in DEAR else ()) for name in SCENES]
)
def test_every_kind_of_scene_has_its_figures(name, recorded):
    """|z| < 5 at each of some 100 points, of Gaussian means one false alarm in 10^4 seeds."""
    figures, without = drawn_of(name)
    assert set(without) == SCENES[name][1]
    if name in RECORDED:
        recorded(f"figures.{name}", said(figures | without))
    every = [p for figure in figures.values() for p in points(figure)]
    scatter = [p.stderr > 1e-14 * np.abs(p.mean) for p in every]  # more than rounding
    z = np.concatenate([(p.mean - p.theory)[s] / p.stderr[s] for p, s in zip(every, scatter, strict=True)])
    assert z.size > 10
    assert 0.05 < np.abs(z).max() < 5
    for panel in (panel for figure in figures.values() for panel in figure.panels):
        assert len({one.label for one in panel.series}) == len(panel.series), panel.title


FALLING = {"heights": analytic.HeightTable.of([1.0, 2.0, 5.0, 9.0]), "separations": (0.0, 9.0)}


@pytest.mark.parametrize(
    ("changes", "name", "why"),
    [
        (YIELDS, "equal-load", "does not reach the load of its reference"),
        (FALLING, "area-and-load", "the mean load is not positive at every separation"),  # none touches
    ],
)
def test_a_figure_without_meaning_says_why(changes, name, why):
    assert why in dict(figures_of(Compared(scene_of(**changes)), [name]))[name]


def test_numbers_are_integrals_over_the_heights():
    """Of a graded Gaussian surface at d/sigma = 1, by quadrature alone."""
    graded, _ = drawn_of("graded")

    def modulus(s):
        return 0.5 + 0.5 * np.exp(-s)

    def integral(power, weight=lambda s: 1.0):
        return quad(lambda s: (s - 1) ** power * weight(s) * norm.pdf(s), 1, 12, epsrel=1e-11)[0]

    def at_one(name, series=0, panel=0):
        p = graded[name].panels[panel].series[series].points
        (value,) = p.theory[np.isclose(p.x, 1.0)]
        return value

    x, plain = SURFACE, integral(1.5)
    pressure = 4 / 3 * x.eta * x.E_star * x.radius**0.5 * x.sigma**1.5 * integral(1.5, modulus)
    pressure *= 20_000 / (x.eta * x.nominal_area)
    assert graded["figure-2"].panels[0].ylabel == "pressure $P/A_n$ (MPa)"
    assert at_one("figure-2") == pytest.approx(pressure / 1e6, rel=1e-9)
    assert at_one("figure-3") == pytest.approx(plain / integral(1.5, modulus), rel=1e-9)
    assert at_one("figure-6") == pytest.approx(integral(0.5, modulus) / integral(0.5), rel=1e-9)
    assert at_one("figure-4") == pytest.approx(integral(0, modulus) / integral(0), rel=1e-9)
    squared = integral(1.5, lambda s: modulus(s) ** 2)
    assert at_one("figure-4", series=2) == pytest.approx(squared / integral(1.5, modulus), rel=1e-9)
    grading = graded["figure-1"].panels[0].series[0]
    np.testing.assert_allclose(grading.theory, modulus(grading.x), rtol=1e-12)
    assert {s.label for s in graded["figure-2"].panels[0].series} == {"this scene", "homogeneous"}


LISTED = {"heights": mcgw.MeasuredHeights(np.linspace(-2, 2, 99)), "n_asperities": 99}
FEW = {
    "hardly touches": {"separations": (4.9, 5.1), "n_surfaces": 4},
    "one surface": {"separations": 1.0, "n_surfaces": 1},
    "measured": LISTED | {"separations": (0.5, 1.0), "n_surfaces": 1},
}


@pytest.mark.parametrize("name", FEW)
def test_what_hardly_touches_or_is_one_surface_has_no_markers(name):
    figures, without = drawn(scene_of(grading=mcgw.Exponential(2.0), quantities=["load"], **FEW[name]))
    assert set(without) <= {"fluctuations", "equal-load"}
    assert not [p for x in figures.values() for p in points(x)]
    if FEW[name]["n_surfaces"] == 1:
        assert "fluctuations" in without
        assert not any("Markers" in data.caption for data in figures.values())


def test_prefixes_and_digits_of_captions():
    for largest, size, prefix in ((999.0, 1, ""), (1000.0, 1e3, "k"), (0.02, 1e-3, "m"), (3e-6, 1e-6, "µ")):
        assert inside.prefixed(largest) == (pytest.approx(size), prefix)
    law = "KogutEtsion(hardness=1234567000.0, poisson=0.3333333333)"
    assert inside.short(law) == "KogutEtsion(hardness=1.23457e+09, poisson=0.333333)"
    assert inside.short("Hertz()") == "Hertz"

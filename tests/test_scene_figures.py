"""Figures of anybody's scene: their numbers are those of theory and of Monte Carlo, under every law."""

from importlib.resources import files

import numpy as np
import pytest
from conftest import SURFACE
from scipy.integrate import quad
from scipy.stats import norm

import mcgw
from mcgw.figures.data import FigureData
from mcgw.figures.drawing import draw
from mcgw.figures.of_scene import OF_SCENE, scene_figures
from mcgw.scene.scene_file import scene_from

H = (0.0, 1.0, 2.0)
SOFT = mcgw.Surface("0.2 um", "50 um", "1000/mm^2", "1 mm^2", "10 MPa")
RATIOS = {"figure-3", "figure-6", "equal-load"}


def scene_of(surface=SURFACE, **given):
    return mcgw.Scene(
        surface, **{"separations": H, "n_asperities": 20_000, "n_surfaces": 200, "seed": 3} | given
    )


def preset(name):
    scene = scene_from((files("mcgw.scene") / "presets" / f"{name}.toml").read_text(encoding="utf-8"))
    return scene.replace(separations=H, n_surfaces=60)


def drawn(scene):
    """Figures by name, and the names of those with no meaning."""
    found = dict(scene_figures(scene))
    assert tuple(found) == OF_SCENE
    figures = {name: x for name, x in found.items() if isinstance(x, FigureData)}
    assert all(
        isinstance(x, str) and x and "\n" not in x for x in found.values() if x not in figures.values()
    )
    return figures, set(found) - set(figures)


def residuals(figures):
    every = [s.points for x in figures.values() for panel in x.panels for s in panel.series if s.points]
    return np.concatenate([((p.mean - p.exact)[p.stderr > 0] / p.stderr[p.stderr > 0]) for p in every])


SCENES = {
    "graded": lambda: scene_of(grading=mcgw.Exponential(0.5)),
    "own grading": lambda: scene_of(grading=lambda s: 1 + 0.3 * np.tanh(s), count="poisson"),
    "clipped": lambda: scene_of(grading=mcgw.Exponential(2.0), negative="clip", separations=(-1.0, 0.0, 1.0)),
    "other heights": lambda: scene_of(grading=mcgw.Exponential(2.0), heights=mcgw.Weibull(10.0)),
    "yields, and back": lambda: scene_of(
        law=mcgw.KogutEtsion(hardness=1.2e9, poisson=0.3), grading=mcgw.Exponential(1.5), unload_from="loop"
    ),
    "coated": lambda: scene_of(law=mcgw.Coated(thickness=1e-6, ratio=3.0, poisson=0.3)),
    "sticks": lambda: scene_of(
        SOFT, law=mcgw.JohnsonKendallRoberts(work=0.05), unload_from="loop", quantities=["load"]
    ),
    "interacting": lambda: scene_of(interaction="body"),
    "own radii": lambda: scene_of(
        mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "100 GPa"), grading=mcgw.Exponential(0.5)
    ),
    **{f"preset {name}": (lambda name=name: preset(name)) for name in ("aluminium", "nanoindentation")},
}
WITHOUT = {  # beside "who-yields", "way-back"
    "yields, and back": {
        "equal-load"
    },  # at d/sigma = 0 Hertz's asperities carry more than those that yield can
    "coated": {"figure-1", "figure-4"},
    "sticks": {"figure-1", "figure-3", "figure-4", "equal-load", "area-and-load"},
    "interacting": {"figure-1", "figure-4"},
    "preset aluminium": {"figure-1", "figure-4"} | RATIOS,
}


_SLOW = ("own radii", "other heights")  # half a minute of theory each


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if name in _SLOW else ()) for name in SCENES]
)
def test_every_kind_of_scene_has_its_figures(name):
    """|z| < 5 at each of some 100 points, of Gaussian means one false alarm in 10^4 seeds."""
    scene = SCENES[name]()
    figures, without = drawn(scene)
    back = set() if scene.unload_from is not None else {"way-back"}
    yields = set() if name == "yields, and back" else {"who-yields"}
    assert without == WITHOUT.get(name, set()) | back | yields
    z = residuals(figures)
    assert z.size > 10
    assert np.abs(z).max() < 5
    assert np.abs(z).max() > 0.05


def test_another_scene_would_show():
    """The companion: an error of 0.02 in gamma is more than 5 standard errors at most points of figure 6."""
    one, other = (drawn(scene_of(grading=mcgw.Exponential(g)))[0]["figure-6"] for g in (0.5, 0.52))
    (points,), (exact,) = ([s.points for s in x.panels[0].series] for x in (one, other))
    assert np.median(np.abs(points.mean - exact.exact) / points.stderr) > 5


def test_numbers_are_integrals_over_the_heights():
    """Of a graded Gaussian surface at d/sigma = 1, by quadrature alone."""
    figures, _ = drawn(scene_of(grading=mcgw.Exponential(0.5)))

    def modulus(s):
        return 0.5 + 0.5 * np.exp(-s)

    def integral(power, weight=lambda s: 1.0):
        return quad(lambda s: (s - 1) ** power * weight(s) * norm.pdf(s), 1, 12, epsrel=1e-11)[0]

    def at_one(name, series=0, panel=0):
        p = figures[name].panels[panel].series[series].points
        (value,) = p.exact[np.isclose(p.x, 1.0)]
        return value

    x, plain = SURFACE, integral(1.5)
    pressure = 4 / 3 * x.eta * x.E_star * x.radius**0.5 * x.sigma**1.5 * integral(1.5, modulus)
    pressure *= 20_000 / (x.eta * x.nominal_area)
    assert figures["figure-2"].panels[0].ylabel == "pressure $P/A_n$ (MPa)"
    assert at_one("figure-2") == pytest.approx(pressure / 1e6, rel=1e-9)
    assert at_one("figure-3") == pytest.approx(plain / integral(1.5, modulus), rel=1e-9)
    assert at_one("figure-6") == pytest.approx(integral(0.5, modulus) / integral(0.5), rel=1e-9)
    assert at_one("figure-4") == pytest.approx(integral(0, modulus) / integral(0), rel=1e-9)
    squared = integral(1.5, lambda s: modulus(s) ** 2)
    assert at_one("figure-4", series=2) == pytest.approx(squared / integral(1.5, modulus), rel=1e-9)
    grading = figures["figure-1"].panels[0].series[0]
    np.testing.assert_allclose(grading.theory, modulus(grading.x), rtol=1e-12)
    assert {s.label for s in figures["figure-2"].panels[0].series} == {"this scene", "homogeneous"}


def test_one_surface_has_no_markers():
    figures, without = drawn(scene_of(n_surfaces=1, grading=mcgw.Exponential(2.0), separations=1.0))
    assert "fluctuations" in without
    assert not [s for x in figures.values() for panel in x.panels for s in panel.series if s.points]
    for data in figures.values():
        draw(data)
        assert "Markers" not in data.caption

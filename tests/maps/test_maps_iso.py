"""Numbers of ISO 25178 and of profiles: formulas against drawn maps, and what is refused or told."""

import math
import tomllib

import numpy as np
import pytest
from oracles.inside import write_scene

import mcgw
from analytic import SpectralMoments
from mcgw.maps.iso import NUMBERS, moments_from

MOMENTS = ("m0", "m2", "m4")
SURFACE = SpectralMoments(6.4e-13, 7.2e-3, 8.1e8)  # alpha = 10


def test_numbers_as_they_are_spelled():
    """Of the printed arithmetic: alpha = 10."""
    for slope, sharpness in ((0.12, "0.043/um"), ("12 %", "43 mm^-1"), ("0.12", 4.3e4)):
        moments, doubts = moments_from({"Sq": "0.8 um", "Sdq": slope, "Spc": sharpness}, pruning=0)
        assert moments.alpha == pytest.approx(10.08, abs=0.01)
        assert not doubts


def numbers_of(m: SpectralMoments, *keys: str) -> dict[str, float]:
    """The numbers of a surface, from printed formulas."""
    all_of = {
        "Sq": math.sqrt(m.m0), "Sdq": math.sqrt(2 * m.m2), "Rq": math.sqrt(m.m0), "Rdq": math.sqrt(m.m2),
        "Spc": 8 * math.sqrt(m.m4 / math.pi) / 3, "Spd": m.m4 / (6 * math.pi * math.sqrt(3) * m.m2),
        "Rpd": math.sqrt(m.m4 / m.m2) / (2 * math.pi), "RSm": 2 * math.pi * math.sqrt(m.m0 / m.m2),
    }  # fmt: skip
    return {key: all_of[key] for key in keys}


@pytest.mark.parametrize(
    "keys",
    [("Sq", "Sdq", "Spc"), ("Sq", "Sdq", "Spd"), ("Rq", "Rdq", "Rpd"), ("Rq", "RSm", "Rpd"), (*NUMBERS,)],
)
def test_three_numbers_or_more_give_the_moments(keys):
    """From printed formulas back; all eight agree."""
    found, doubts = moments_from(numbers_of(SURFACE, *keys), pruning=0)
    expected = [getattr(SURFACE, name) for name in MOMENTS]
    assert [getattr(found, name) for name in MOMENTS] == pytest.approx(expected, rel=1e-12)
    assert not doubts


def test_disagreement_is_told():
    """A density four times too small is named, and the rest share it."""
    numbers = numbers_of(SURFACE, "Sq", "Sdq", "Spc", "Spd")
    numbers["Spd"] /= 4
    with pytest.warns(UserWarning, match=r"disagree.*Spc by a factor of .*Spd by a factor of") as told:
        mcgw.surface_from(**numbers, pruning=0, nominal_area=1e-6, E_star=1e11)
    assert told[0].filename == __file__
    numbers["Spd"] *= 4 * 1.02
    assert not moments_from(numbers, pruning=0)[1]


def test_pruned_peaks_are_told():
    """By default an instrument has left out low peaks."""
    with pytest.warns(UserWarning, match="Spc: the formula is for all summits.*pruning = 0"):
        mcgw.surface_from(Sq=8e-7, Sdq=0.12, Spc=4.3e4, nominal_area=1e-6, E_star=1e11)
    assert not moments_from(numbers_of(SURFACE, "Rq", "Rdq", "Rpd"))[1]


def test_autocorrelation():
    """Gaussian: alpha = 3 and l = Sal/sqrt(ln 5); exponential: integrals of its spectrum by quadrature."""
    sal, length = 10e-6, 10e-6 / math.sqrt(math.log(5))
    m = moments_from({"Sq": 1e-6, "Sal": sal})[0]
    assert (m.m0, m.m2, m.m4) == pytest.approx((1e-12, 2e-12 / length**2, 12e-12 / length**4), rel=1e-13)
    m = moments_from({"Sq": 1e-6, "Sal": sal, "autocorrelation": "exponential", "short": "2 um"})[0]
    u = 2 * math.pi * sal / math.log(5) / 2e-6
    x, w = np.polynomial.legendre.leggauss(200)
    q, w = (x + 1) * u / 2, w * u / 2
    density = q * (1 + q * q) ** -1.5
    q2, q4 = ((w * density * q**k).sum() / (w * density).sum() / (sal / math.log(5)) ** k for k in (2, 4))
    assert (m.m2, m.m4) == pytest.approx((q2 / 2 * 1e-12, 3 * q4 / 8 * 1e-12), rel=1e-10)


@pytest.mark.parametrize(
    ("numbers", "told"),
    [
        ({"Ra": 1e-6}, "Ra: is not a number"),
        ({"Sq": 1e-6}, "Sq: does not tell m2, m4; add Sdq"),
        ({"Rq": 1e-6, "Rdq": 0.1, "RSm": 1e-5}, "does not tell m4; add Spc, Spd or Rpd"),
        ({}, "no number: does not tell m0"),
        ({"Sq": "1 kg", "Sdq": 0.1, "Spc": 1e4}, "Sq = '1 kg': give a finite number"),
        ({"Sq": 1e-6, "Sdq": 1.0, "Spc": 1e3}, "alpha = m0 m4/m2.* has at least 1.5"),
        ({"Sq": 1e-6, "Sdq": 0.1, "Sal": 1e-5}, "go with Sq alone"),
        ({"Sq": 1e-6, "autocorrelation": "gaussian"}, "needs Sal"),
        ({"Sq": 1e-6, "Sal": 1e-5, "autocorrelation": "exponential"}, "diverge; give short"),
        ({"Sq": 1e-6, "Sal": 1e-5, "autocorrelation": "x"}, "give gaussian or exponential"),
        ({"Sq": 1e-6, "Sal": 1e-5, "short": 1e-6}, "short: is for autocorrelation = exponential"),
        ({"Sq": 1e-6, "Sdq": 0.1, "Spc": 1e4, "pruning": 1.0}, "pruning = 1.0: give a share"),
    ],
)
def test_refused_in_one_line(numbers, told):
    """Named: the key, its value, and what would do."""
    with pytest.raises(mcgw.SceneError, match=told) as caught:
        mcgw.surface_from(**numbers, nominal_area=1e-6, E_star=1e11)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("sigma", "eta", "area", "told"), [
    (1.23456e-6, 2.93e9, 1e-6, ('"1.235 um"', '"2930/mm^2"', '"1 mm^2"')),
    (4.2e-9, 9.99951e15, 2e-12, ('"4.2 nm"', '"1e+04/um^2"', '"2 um^2"')),
    (0.012e-6, 1.5e4, 1.0, ('"0.012 um"', '"0.015/mm^2"', '1.0')),
    (20.0, 3.0, 1e4, ("20.0", "3.0", "10000.0")),
])  # fmt: skip
def test_numbers_have_units_in_which_they_are_short(sigma, eta, area, told, tmp_path):
    """Four digits; what is natural in none of the units stays in SI, and defaults are left out."""
    surface = mcgw.Surface(sigma, 1e-5, eta, area, 1e11)
    scene = mcgw.Scene(surface, separations=[0.0], ensemble=mcgw.Sampling(n_asperities=9), seed=3)
    write_scene(scene, tmp_path / "f.toml", None, [])
    text = (tmp_path / "f.toml").read_text()
    tables = tomllib.loads(text)
    written = {f"{key} = {x}" for key, x in zip(("sigma", "eta", "nominal_area"), told, strict=True)}
    assert written <= set(text.splitlines())
    assert set(tables) == {"title", "surface", "contact", "ensemble"}
    assert set(tables["ensemble"]) == {"n_surfaces", "n_asperities", "seed"}


def test_nayaks_surfaces_are_written_by_their_moments(tmp_path):
    """m0, m2 and m4 alone; with a bound on the radii, or one radius, the summits stand there."""
    scene = mcgw.Scene(mcgw.SpectralSurface(1e-12, 1e-3, 5e6, 1e-6, 1e11), separations=[0.0], seed=1)
    write_scene(scene, tmp_path / "f.toml", None, [])
    tables = tomllib.loads((tmp_path / "f.toml").read_text())
    surface = {"m0": "1 um^2", "m2": 0.001, "m4": "5/mm^2", "nominal_area": "1 mm^2", "E_star": "100 GPa"}
    assert tables["surface"] == surface
    assert not {"heights", "summits"} & set(tables)
    for other in (scene.replace(summits="mean"), scene.replace(summits=type(scene.summits)(5.0, 1e5))):
        write_scene(other, tmp_path / "f.toml", None, [])
        assert tomllib.loads((tmp_path / "f.toml").read_text())["heights"] == {"law": "nayak", "alpha": 5.0}
        assert (mcgw.load_scene(tmp_path / "f.toml").summits is None) == (other.summits is None)

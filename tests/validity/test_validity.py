"""How far a scene says its model is from elasticity: recomputed from the packaged table by other means.

The numbers are read from the table, whatever it holds: nothing here knows one of them.
"""

import csv
import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import RegularGridInterpolator
from scipy.optimize import brentq
from scipy.special import psi
from scipy.stats import norm

import analytic
import mcgw
from mcgw.validity import error_table as grid
from mcgw.validity.lookup import LEAST_CROWDING, moments_of

TABLE = Path(mcgw.__file__).parent / "validity" / "table.csv"
HEAD = ["map", "model", "interaction", "x", "p"]
HEAD += [f"{name}{end}" for name in grid.COLUMNS for end in ("", "_std")] + ["maps", "contacts", "waves"]


def packaged():
    lines = [line for line in TABLE.read_text().splitlines() if not line.startswith("#")]
    for row in csv.DictReader(lines):
        words = {key: row[key] for key in HEAD[:3]}
        numbers = {key: float(row[key]) for key in HEAD[3:]}
        unsure = 0.0 if numbers["maps"] else numbers["area_std"] / (1 + numbers["area"])
        more = {"log": math.log(numbers["contacts"]), "unsure": unsure}  # to go between
        yield words | numbers | more | {"of": tuple(words.values())}


EVERY = list(packaged())
ROWS = [row for row in EVERY if row["maps"] > 0]
MODELS = sorted({row["of"] for row in ROWS})
ONE, OWN = ("gaussian", "one radius", "none"), ("gaussian", "own radii", "none")


def test_the_table_is_as_its_readers_take_it():
    """Errors with a scatter, positive axes, no point twice; a model's own loads rise with the right ones."""
    lines = TABLE.read_text().splitlines()
    assert next(line for line in lines if not line.startswith("#")).split(",") == HEAD
    keys = [tuple(row[key] for key in HEAD[:5]) for row in EVERY]
    assert len(set(keys)) == len(keys)
    for row in EVERY:
        assert min(row["x"], row["p"], row["contacts"]) > 0
        assert row["waves"] > 0 if row["map"] == "gaussian" else math.isnan(row["waves"])
        for name in grid.COLUMNS:
            assert math.isnan(row[name]) or row[name] > -1 or name == "separation"
            assert not row[f"{name}_std"] < 0
    for model in MODELS:
        rows = [row for row in EVERY if row["of"] == model]
        for x in {row["x"] for row in rows}:
            here = sorted((row["p"], row["p"] * (1 + row["load"])) for row in rows if row["x"] == x)
            own = [load for _, load in here if not math.isnan(load)]
            assert own == sorted(own), (model, x)


def law_of(model, name):
    """Logarithm of the scatter by x and contacts: normal equations, weighted by degrees of freedom."""
    rows = [row for row in ROWS if row["of"] == model]
    told = [(row, row[f"{name}_std"] / (1 if name == "separation" else 1 + row[name])) for row in rows]
    told = [(row, s) for row, s in told if s > 0]
    nu = np.array([row["maps"] - 1 for row, _ in told])
    logs = np.log([s for _, s in told]) + (np.log(nu / 2) - psi(nu / 2)) / 2
    A = np.array([[1.0, math.log(row["x"]), row["log"]] for row, _ in told])
    return np.linalg.solve((A.T * nu) @ A, (A.T * nu) @ logs)


@pytest.mark.parametrize("name", grid.COLUMNS[:-1])
@pytest.mark.parametrize("model", MODELS, ids="-".join)
def test_scatter_is_a_law_of_all_rows(model, name):
    law = law_of(model, name)
    np.testing.assert_allclose(grid.grid_of(*model).scatter[name], law, rtol=1e-6, atol=1e-9)
    if model[0] == "gaussian" and name == "area":  # spots are independent there: one over their root
        assert law[2] == pytest.approx(-0.5, abs=0.1)


def beside(model, x):
    """The measured surfaces next to one, on both sides."""
    xs = sorted({row["x"] for row in ROWS if row["of"] == model})
    return {max(a for a in xs if a <= x), min(a for a in xs if a >= x)}


def fewest(model, x):
    return min(row["maps"] for row in ROWS if row["of"] == model and row["x"] in beside(model, x))


def interpolated(model, name, x, p, end=""):
    """Bilinear in logarithms by SciPy, over surfaces with the same loads; nan outside."""
    rows = [row for row in EVERY if row["of"] == model]
    unit = {a: a if model[0] == "caps" else 1.0 for a in beside(model, x)}
    columns = {}
    for a in unit:
        mine = sorted((row["p"], row[f"{name}{end}"]) for row in rows if row["x"] == a)
        known = np.array([pair for pair in mine if not math.isnan(pair[1])])
        if not known.size:
            return math.nan
        q = math.log(p / (x if model[0] == "caps" else 1.0))
        at = np.log(known[:, 0] / unit[a])
        if not at[0] <= q <= at[-1]:
            return math.nan
        columns[a] = float(RegularGridInterpolator((at,), known[:, 1])([[q]])[0])
    low, high = min(columns), max(columns)
    if low == high:
        return columns[low]
    share = math.log(x / low) / math.log(high / low)
    return columns[low] + share * (columns[high] - columns[low])


def alpha_of(surface):
    """Solved from Nayak's summits, not from a formula of their density."""

    def crowding(alpha):
        found = analytic.SpectralMoments(1.0, 1.0, alpha).surface(1.0, 1.0)
        return found.eta * found.radius * found.sigma

    wanted = surface.eta * surface.radius * surface.sigma
    alpha = brentq(lambda a: crowding(a) - wanted, 1.5, 1e4, xtol=1e-13, rtol=1e-13)
    # sigma and R tell m0 and m4 of that alpha; alpha tells m2
    unit = analytic.SpectralMoments(1.0, 1.0, alpha).surface(1.0, 1.0)
    m0 = (surface.sigma / unit.sigma) ** 2
    m4 = alpha * (unit.radius / surface.radius) ** 2
    return alpha, math.sqrt(2 * math.sqrt(m0 * m4 / alpha)), math.sqrt(m0) / surface.sigma


def surface_of(alpha):
    return analytic.SpectralMoments(1e-12, 1e-3, 1e6 * alpha).surface(1e-6, 1e9)


def reduced_by_quadrature(scene, h):
    """Load over E* and nominal area, of Gaussian heights of one radius."""
    s = scene.surface
    mean, _ = quad(lambda t: (t - h) ** 1.5 * norm.pdf(t), h, max(h, 0) + 12, epsabs=0, epsrel=1e-9)
    return 4 / 3 * s.eta * math.sqrt(s.radius) * s.sigma**1.5 * mean


def test_a_gaussian_surface_by_its_own_interpolation():
    """alpha, g and m0 solved anew; load by quadrature; SciPy between the rows; scatter by the contacts."""
    middle = math.sqrt(2.6 * 4.3)
    scene = mcgw.Scene(surface_of(middle), separations=np.linspace(-1, 4, 26), seed=1)
    many = scene.replace(separations=np.linspace(4, -1, 5000)).validity().separations
    assert (len(many), many[0], many[-1]) == (64, -1.0, 4.0)
    alpha, g, rms = alpha_of(scene.surface)
    assert alpha == pytest.approx(middle, rel=1e-10)
    found, model = scene.validity(), ONE
    assert found.measured.any()
    assert not found.measured.all()
    for k, h in enumerate(found.separations):
        p = reduced_by_quadrature(scene, h) / g
        assert found.loads[k] == pytest.approx(p, rel=1e-7)
        for name, unit in (("area", 1.0), ("stiffness", 1.0), ("separation", rms)):
            wanted = unit * interpolated(model, name, alpha, p)
            np.testing.assert_allclose(found.bias[name][k], wanted, rtol=1e-5, atol=1e-9)
        area = interpolated(model, "area", alpha, p)
        if not math.isnan(area) and scene.n_asperities * norm.sf(h) >= 1:
            contacts = scene.n_asperities * norm.sf(h)
            of_map = math.exp(interpolated(model, "log", alpha, p))
            law = law_of(model, "area")
            scatter = math.exp(law @ [1.0, math.log(alpha), math.log(of_map)])
            of_maps = scatter * math.sqrt(of_map / contacts + 1 / fewest(model, alpha))
            off = 2.1 * math.hypot(of_maps, interpolated(model, "unsure", alpha, p))
            wanted = abs(area) + (1 + area) * (math.exp(off) - 1)
            assert found.error["area"][k] == pytest.approx(wanted, rel=1e-5)
    assert (found.error["area"] >= np.abs(found.bias["area"]))[found.measured].all()


def test_a_gap_is_as_sure_as_long_waves_are_many_and_spectra_are_alike():
    """At a row of the table, of a fit that saw few independent heights: 2.1 deviations by hand."""
    model, x = OWN, 5.0
    row = max((r for r in ROWS if r["of"] == model and r["x"] == x), key=lambda r: r["p"])
    surface = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 cm^2", "1 GPa")
    seen = {"skewness": 0.0, "kurtosis": 3.0, "independent": 100.0, "agreement": 1.0, "area": 1e-6}
    scene = mcgw.Scene(surface, separations=0.0, seed=1, fitted={"m0": 1e-12, "m2": 1e-3, "m4": 5e6, **seen})
    load = row["p"] * math.sqrt(2e-3) * 1e9 * scene.n_asperities / scene.surface.eta
    h = float(scene.theory.separation_at("load", load))
    law = law_of(model, "separation")
    scatter = math.exp(law @ [1.0, math.log(x), row["log"]])
    share = math.sqrt(row["waves"] * 1e-8 * scene.surface.eta / scene.n_asperities)
    assert share > math.sqrt(row["contacts"] / (scene.n_asperities * float(scene.heights.sf(np.array(h)))))
    unsure = math.hypot(scatter / math.sqrt(fewest(model, x)), 0.02 * math.log(x / 2))
    wanted = abs(row["separation"]) + 2.1 * math.hypot(scatter * share, unsure)
    rms = 1e-6 / scene.surface.sigma
    assert scene.validity(h).error["separation"][0] == pytest.approx(rms * wanted, rel=1e-4)


def test_the_load_is_looked_up_by_the_load_of_the_model():
    """At the gap of a row the model has (1 + error) times the right load, and that is what a scene knows."""
    rows = [row for row in ROWS if row["of"] == ONE and abs(row["load"]) > 0.2]
    row = max((row for row in rows if row["x"] < 10), key=lambda row: row["p"])
    surface = surface_of(row["x"])
    model_has = row["p"] * (1 + row["load"]) * math.sqrt(2e-3) * surface.E_star * surface.nominal_area
    h = float(analytic.Model(surface).separation_at("load", model_has))
    found = mcgw.Scene(surface, separations=[h], seed=1).validity()
    assert found.bias["load"][0] == pytest.approx(row["load"], rel=1e-5)


def test_caps_stand_below_where_no_gaussian_surface_is():
    least = analytic.SpectralMoments(1.0, 1.0, 1.5).surface(1.0, 1.0)
    assert least.eta * least.radius * least.sigma == pytest.approx(LEAST_CROWDING, rel=1e-12)
    for crowding, kind in ((0.999 * LEAST_CROWDING, "caps"), (1.001 * LEAST_CROWDING, "gaussian")):
        surface = analytic.Surface(1e-6, 1e-5, crowding * 1e11, 1e-6, 1e9)
        assert (moments_of(surface) is None) == (kind == "caps")
    crowding = math.sqrt(min(row["x"] for row in ROWS if row["map"] == "caps") * LEAST_CROWDING)
    surface = analytic.Surface(1e-6, 1e-5, crowding * 1e11, 1e-4, 1e9)
    scene = mcgw.Scene(surface, separations=np.linspace(-0.55, 3, 9), seed=1)
    found = scene.validity()
    assert found.measured.any()
    assert found.axis == "p/(E* sqrt(sigma/R))"
    for k, h in enumerate(found.separations):
        p = reduced_by_quadrature(scene, h) / math.sqrt(0.1)
        assert found.loads[k] == pytest.approx(p, rel=1e-7)
        wanted = interpolated(("caps", "one radius", "none"), "area", crowding, p)
        np.testing.assert_allclose(found.bias["area"][k], wanted, rtol=1e-5, atol=1e-9)
    assert found.known("area", "stiffness").all()
    lone = scene.replace(separations=[5.0]).validity()  # 0.2 contacts a surface
    assert np.isnan(lone.error["area"][0])


OFF_THE_MAP = {
    "another law": ({"law": mcgw.KogutEtsion(critical=0.05)}, "kogut-etsion"),
    "other heights": ({"heights": analytic.Weibull(3.0)}, "Weibull"),
    "measured heights": (
        {"heights": mcgw.MeasuredHeights(np.linspace(-2, 2, 99)), "n_asperities": 99, "n_surfaces": 1},
        "99 measured ones",
    ),
    "too broad a spectrum": ({"surface": surface_of(1e4)}, "outside the measured range"),
}


@pytest.mark.parametrize("name", OFF_THE_MAP)
def test_nothing_is_said_of_what_was_not_measured(make_scene, name):
    changes, word = OFF_THE_MAP[name]
    found = make_scene(grading=analytic.Homogeneous(), **changes).validity()
    assert not found.measured.any()
    assert all(np.isnan(values).all() for values in found.error.values())
    assert word in found.verdict
    assert "not measured" in found.verdict or "outside the measured range" in found.verdict


def test_radii_that_end_early_are_not_those_of_the_maps():
    surface = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "1 GPa")
    for bound, known in ((9.95, False), (10.05, True)):
        curvature = mcgw.RandomCurvature(surface.moments.alpha, bound)
        scene = mcgw.Scene(surface, separations=[1.0], summits=curvature, seed=1)
        assert scene.validity().measured.all() == known


def test_a_density_is_that_of_its_alpha_up_to_a_twentieth():
    """Of Nayak's heights, and of the asperities of an interaction that are all on the nominal area."""
    surface = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "1 GPa").surface
    scene = mcgw.Scene(surface, separations=1.0, heights=analytic.Nayak(5.0), seed=1)
    for ratio, known in ((1.049, True), (1.051, False), (0.951, True), (0.949, False)):
        dense = dataclasses.replace(surface, eta=ratio * surface.eta)
        assert scene.replace(surface=dense).validity().measured.all() == known
        found = scene.replace(
            interaction="mean-plane",
            n_asperities=round(1000 * ratio),
            surface=dataclasses.replace(surface, nominal_area=1000 / surface.eta),
        ).validity()
        assert np.isfinite(found.error["area"]).all()
        assert np.isfinite(found.error["load"]).all() == known


def test_far_away_and_far_down_are_outside():
    scene = mcgw.Scene(surface_of(4.0), separations=[-30.0, 0.5, 8.0], seed=1)
    found = scene.validity()
    np.testing.assert_array_equal(found.measured, [False, True, False])
    none = "outside the measured range or fewer than one contact per surface"
    assert f"at d/sigma = -30 and 8 {none}" in found.verdict
    lone = scene.validity(8.0)
    assert lone.verdict == "Model error: not stated, with fewer than one contact per surface"


def test_a_grading_leaves_the_share_of_the_geometry():
    plain = mcgw.Scene(surface_of(4.0), separations=[0.5], seed=1)
    graded = plain.replace(grading=analytic.Exponential(1.2))
    for name in grid.COLUMNS:
        np.testing.assert_array_equal(plain.validity().error[name], graded.validity().error[name])
    for scene, word in ((plain, False), (graded, True)):
        for said in (scene.validity().verdict, scene.validity().brief):
            assert ("measured for a uniform modulus" in said) == word


def test_an_interaction_has_its_own_rows_and_a_body_the_area_alone():
    plain = mcgw.Scene(surface_of(4.0), separations=[1.2, 1.6], seed=1)
    body = plain.replace(interaction="body").validity()
    np.testing.assert_array_equal(body.error["area"], plain.validity().error["area"])
    for name in grid.COLUMNS[1:]:
        assert np.isnan(body.error[name]).all()
    assert "undeformed body" in body.details
    assert "load at a given" not in body.verdict
    cell = plain.replace(interaction="mean-plane")
    alpha, _, rms = alpha_of(plain.surface)
    found = cell.validity()
    for load, bias in zip(found.loads, found.bias["separation"], strict=True):
        wanted = interpolated(("gaussian", "one radius", "summits"), "separation", alpha, load)
        assert bias == pytest.approx(rms * wanted, rel=1e-5)

"""The same bits on every x86-64: children believe to be on another one; and by any number of threads."""

import hashlib
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy._core import _multiarray_umath as umath

import analytic
import mcgw
from mcgw.errors import RunError, StoreError
from mcgw.jobs import job
from mcgw.jobs.job import commit_block
from mcgw.jobs.running import run
from mcgw.sampling.block import Layout
from mcgw.sampling.moments import cell_moments
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.promises import SAMPLERS
from mcgw.scene.scene import Scene
from mcgw.store import identity

GRADINGS = {
    "homogeneous": analytic.Homogeneous(),
    "exponential": analytic.Exponential(2.0),
    "clipped": analytic.Exponential(3.0),
    "table": analytic.Table([-5.0, 0.0, 9.0], [0.5, 1.0, 1.7]),
}
HEIGHTS = {
    "gaussian": analytic.Gaussian(),
    "exponential": analytic.ExponentialHeights(),
    "table": analytic.HeightTable([-2.0, -1.0, 0.0, 0.7, 2.0, 3.0], [0.0, 0.1, 0.4, 0.8, 0.97, 1.0]),
}
PAIRS = [(grading, "gaussian") for grading in GRADINGS] + [("exponential", law) for law in list(HEIGHTS)[1:]]

OLD_BLAS = {"OPENBLAS_CORETYPE": "Prescott"}
OLD_C = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX_Usable,-AVX2_Usable,-FMA_Usable"}
OLD_NUMPY = {
    "NPY_DISABLE_CPU_FEATURES": " ".join(f for f in umath.__cpu_dispatch__ if umath.__cpu_features__[f])
}
NO_VECTORS = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}  # two numbers at a time, nothing fused
HASWELL = {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": ""}


def made(sampler, grading, heights, accuracy=1e-13):
    """A few surfaces with crowded and empty cells, extras on both sides, and contacts one by one."""
    surface = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3.0e8, nominal_area=1e-4, E_star=78.6e9)
    return Scene(
        surface=surface,
        separations=(0.0, 0.3, 1.7),
        grading=GRADINGS[grading],
        negative="clip" if grading == "clipped" else "error",
        heights=HEIGHTS[heights],
        n_asperities=5000,
        seed=20240601,
        sampler=sampler,
        accuracy=accuracy,
    )


def digests():
    """Of all that is drawn, and of the set-up, for each sampler that owes the same bits to everybody."""
    found = {}
    for sampler, accuracy in (*((name, 1e-13) for name in SAMPLERS[2:]), ("cells", 1e-6), ("cells", 1e-3)):
        for pair in PAIRS:
            drawn = sampler_of(made(sampler, *pair, accuracy))
            block = drawn.block(3, 5)
            parts = (*block.sums.values(), block.counts, block.moments, block.extras, drawn.mesh.edges)
            sha = hashlib.sha256(b"".join(np.ascontiguousarray(part).tobytes() for part in parts))
            found[f"{sampler} {accuracy} {pair}"] = sha.hexdigest()
    return found


def report():
    return {"digests": digests(), "kind": identity.kind_of_processor()}


@pytest.fixture(scope="module")
def here():
    return report()


def elsewhere(cpu):
    """What a process finds that was told to be on another processor."""
    code = "import json, test_same_bits_everywhere as t; print(json.dumps(t.report()))"
    path = os.pathsep.join(map(str, (Path(__file__).parent, Path(__file__).parent.parent)))
    call = [sys.executable, "-W", "ignore", "-c", code]
    done = subprocess.run(call, env=os.environ | {"PYTHONPATH": path} | cpu, capture_output=True, check=True)
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def older():
    """On a processor whose libraries are the oldest there are."""
    return elsewhere(OLD_BLAS | OLD_C | OLD_NUMPY)


def test_an_older_processor_draws_the_same_bits_and_rounds_otherwise(here, older):
    """Otherwise the first says nothing."""
    assert older["digests"] == here["digests"]
    if OLD_NUMPY["NPY_DISABLE_CPU_FEATURES"]:  # or this is the oldest processor
        assert older["kind"] != here["kind"]


@pytest.mark.slow
@pytest.mark.parametrize("cpu", [OLD_BLAS | OLD_C | OLD_NUMPY | NO_VECTORS, HASWELL], ids=["all", "haswell"])
def test_every_processor_draws_the_same_bits(here, cpu):
    assert elsewhere(cpu)["digests"] == here["digests"]


def test_the_compiler_neither_fuses_nor_reorders():
    """Where sums are written out, no kernel may ask for the fast arithmetic that depends on the processor."""
    import mcgw.sampling

    for path in Path(mcgw.sampling.__file__).parent.rglob("*.py"):
        if path.parent.name == "located":  # solved until a residual is small: no bits are promised
            continue
        for word in ("fastmath", "reassoc", "contract", "import leggauss", "linalg", " @ "):
            code = path.read_text().replace("response @", "")
            lines = [line for line in code.splitlines() if word in line and not line.startswith(">>> ")]
            assert not [line for line in lines if '"""' not in line and "``" not in line], (path.name, word)


@pytest.mark.parametrize(
    ("change", "depends"),
    [
        ({}, False),
        ({"grading": GRADINGS["clipped"], "negative": "clip"}, False),
        ({"grading": GRADINGS["table"], "heights": HEIGHTS["table"]}, False),
        ({"sampler": "direct"}, True),
        ({"grading": analytic.Custom(np.cosh)}, True),
        ({"grading": analytic.Clipped(analytic.Custom(np.sinh))}, True),
        ({"heights": analytic.Weibull(3.6)}, True),
        ({"heights": analytic.Nayak(5.0)}, True),
    ],
)
def test_what_depends_on_the_processor(make_scene, change, depends):
    scene = make_scene(**change)
    sampler = "cells" if scene.sampler == "auto" else scene.sampler
    assert identity.depends_on_processor(scene, sampler) == depends
    assert (identity.kind_of_processor() in identity.drawn_with(scene, sampler)) == depends


WHY = "another kind of processor, which rounds exponentials differently"


@pytest.mark.parametrize("heights", [analytic.Weibull(3.6), analytic.Gaussian()], ids=["foreign", "own"])
def test_a_run_goes_on_where_it_was_drawn(make_scene, tmp_path, monkeypatch, heights):
    """Extended, resumed, sharded, drawn by a worker: refused with the reason, or the same bits."""
    scene = make_scene(heights=heights, sampler="tail", n_surfaces=4)
    more = make_scene(heights=heights, sampler="tail", n_surfaces=8)
    whole, begun = tmp_path / "whole.h5", tmp_path / "begun.h5"
    run(scene, whole)
    monkeypatch.setattr("mcgw.ensemble.simulation.Values.rows", 4)
    run(more, begun, shard="1/2")
    monkeypatch.setattr(identity, "kind_of_processor", lambda: "00000000")
    job._prepared.cache_clear()  # as in a worker that starts on such a processor
    going_on = [
        (StoreError, lambda: run(more, whole)),
        (StoreError, lambda: run(more, begun, shard="2/2")),
        (RunError, lambda: commit_block(f"{begun}.parts", 4, 4)),
        (StoreError, lambda: run(more, begun)),
    ]
    for kind, call in going_on:
        if isinstance(heights, analytic.Gaussian):
            call()
            continue
        with pytest.raises(kind, match=WHY) as caught:
            call()
        assert "\n" not in str(caught.value)


def test_elementary_functions_against_mpmath():
    """To a few units of the last digit, and where NumPy's have their limits."""
    import mpmath as mp

    from analytic import elementary

    rng = np.random.default_rng(1)
    spread = np.exp(rng.uniform(-700, 700, 300))
    small = np.concatenate([rng.uniform(-1, 1, 200), 10.0 ** rng.uniform(-17, 0, 200)])
    cases = [
        (elementary.exp, mp.exp, np.concatenate([small, rng.uniform(-700, 700, 300)])),
        (elementary.expm1, mp.expm1, np.concatenate([small, -small, rng.uniform(-30, 700, 300)])),
        (elementary.log, mp.log, np.concatenate([spread, 1 + 0.01 * small])),
        (elementary.log1p, mp.log1p, np.concatenate([spread, small, -0.999 * small])),
        (elementary.ndtr, mp.ncdf, np.concatenate([rng.uniform(-8, 8, 200), rng.uniform(-37, 0, 200)])),
    ]
    with mp.workdps(40):
        for ours, exact, x in cases:
            wanted = [exact(mp.mpf(v)) for v in x.tolist()]
            error = [abs(mp.mpf(a) / b - 1) for a, b in zip(ours(x).tolist(), wanted, strict=True) if b]
            assert max(error) < 6 * 2.0**-53 * (2 if ours in (elementary.expm1, elementary.ndtr) else 1), ours
        p = np.concatenate([rng.uniform(0, 1, 200), np.exp(rng.uniform(-600, 0, 200))])
        for share, x in zip(p.tolist(), elementary.ndtri(p).tolist(), strict=True):
            slope = mp.npdf(x) / mp.ncdf(x)  # by how much of itself the share changes with x
            assert abs(mp.ncdf(x) / mp.mpf(share) - 1) < 8 * 2.0**-53 * (1 + slope * abs(x))
    np.testing.assert_array_equal(elementary.exp([-800, -np.inf, 710, np.inf]), [0, 0, np.inf, np.inf])
    np.testing.assert_array_equal(elementary.log([0, np.inf]), [-np.inf, np.inf])
    np.testing.assert_array_equal(elementary.ndtri([0, 0.5, 1]), [-np.inf, 0, np.inf])
    np.testing.assert_array_equal(elementary.ndtr([-np.inf, np.inf]), [0, 1])
    assert math.isnan(elementary.exp(math.nan))


def test_compiled_exponential_and_logarithm_against_mpmath():
    import mpmath as mp

    from mcgw.sampling.exp_log import exp_minus, log, log_one_minus

    rng = np.random.default_rng(2)
    small = 10.0 ** rng.uniform(-17, -0.31, 300)
    cases = [
        (exp_minus, lambda y: mp.exp(-y), rng.uniform(0, 40, 300)),
        (log, mp.log, np.exp(rng.uniform(-100, 100, 300))),
        (log_one_minus, lambda p: mp.log(1 - p), small),
    ]
    with mp.workdps(40):
        for ours, exact, x in cases:
            error = [abs(mp.mpf(float(ours(v))) / exact(mp.mpf(v)) - 1) for v in x.tolist()]
            assert max(error) < 8 * 2.0**-53, ours


def test_rules_integrate_and_interpolate():
    """Gauss's rule to the degree it owes, the transform as the inverse of values, the triangle as NumPy's."""
    from numpy.polynomial import chebyshev

    from mcgw.sampling import rules

    for n in (5, 20, 48):
        x, w = rules.gauss_legendre(n)
        k = np.arange(2 * n)
        np.testing.assert_allclose(
            (w[:, None] * x[:, None] ** k).sum(axis=0), 1 / (k + 1), rtol=0, atol=1e-14
        )
    points = rules.chebyshev_points(20)
    there_and_back = rules.product(rules.chebyshev_transform(points), chebyshev.chebvander(points, 19))
    np.testing.assert_allclose(there_and_back, np.eye(20), atol=3e-15)
    matrix = np.random.default_rng(3).normal(size=(30, 12))
    theirs = np.linalg.qr(matrix, mode="r")
    theirs *= np.sign(np.diag(theirs))[:, None]
    np.testing.assert_allclose(rules.triangle(matrix), theirs, atol=1e-14)
    np.testing.assert_allclose(rules.product(matrix.T, matrix), matrix.T @ matrix, rtol=1e-12, atol=1e-12)


# --- nor do threads, blocks, or company change them ------------------------------------------------------


@pytest.mark.parametrize("sampler", SAMPLERS[1:])
def test_threads(make_scene, sampler):
    scene = make_scene(sampler=sampler, n_surfaces=70)
    one, two = mcgw.simulate(scene, threads=1), mcgw.simulate(scene, threads=2)
    for name in scene.quantities:
        np.testing.assert_array_equal(one.values(name), two.values(name))


@pytest.mark.parametrize("sampler", SAMPLERS[1:])
def test_blocks_and_company(make_scene, sampler):
    """Surfaces drawn in blocks of 1, 7, 64 or all at once, or a single one far down the list."""
    drawn = sampler_of(make_scene(sampler=sampler))
    whole = drawn.block(0, 140).sums
    for size in (1, 7, 64):
        for first in (0, 63, 133):
            part = drawn.block(first, size if first < 133 else 7).sums
            for name, values in part.items():
                np.testing.assert_array_equal(values, whole[name][first : first + len(values)])


def test_another_seed_is_another_ensemble(make_scene):
    a, b = (sampler_of(make_scene(seed=seed)).block(0, 2).sums["load"] for seed in (1, 2))
    assert (a[:, :5] != b[:, :5]).all()


def test_sums_of_a_huge_cell_are_compensated():
    """3e6 uniforms in pieces: the sum of T_0 is exact, the mean of T_1 and T_2 is that of a uniform."""
    n = 3_000_001
    moments = cell_moments(5, 0, np.array([[n]]), Layout(np.array([4]), np.array([0])))[:, 0]
    assert moments[0] == n
    assert abs(moments[1]) < 5 * np.sqrt(n / 3)
    assert abs(moments[2] + n / 3) < 5 * np.sqrt(n * 4 / 45 * 4)


@pytest.mark.parametrize("threads", [0, -1])
def test_no_threads_is_an_error(make_scene, threads):
    with pytest.raises(ValueError, match="whole number >= 1"):
        mcgw.simulate(make_scene(), threads=threads)


@pytest.mark.parametrize("sampler", ["cells", "tail", "direct"])
def test_separations_in_any_order_and_repeated(make_scene, sampler):
    """Columns go with their separations, to the last bit."""
    dice = np.random.default_rng(8)
    for n in (1, 1, 2, 3, 5, 5, 5):
        h = tuple(dice.uniform(0, 6, n).round(3).tolist())
        shuffled = tuple(dice.permutation([*h, *dice.choice(h, 2)]).tolist())
        a, b = (
            sampler_of(make_scene(separations=x, sampler=sampler, n_asperities=300)).block(0, 3).sums
            for x in (h, shuffled)
        )
        for name, values in b.items():
            for k, x in enumerate(shuffled):
                np.testing.assert_array_equal(values[:, k], a[name][:, h.index(x)])


@pytest.mark.parametrize(("metre", "pascal"), [(-30, 7), (13, -30), (30, 30), (0, 1), (1, 0)])
def test_units_of_length_and_stress_are_free(make_scene, metre, pascal):
    """Other units, powers of two apart: the very same digits."""
    scene = make_scene(separations=(0.0, 1.0, 2.5), sampler="tail", n_asperities=300)
    s, a, p = scene.surface, 2.0**metre, 2.0**pascal
    other = analytic.Surface(s.sigma * a, s.radius * a, s.eta / a**2, s.nominal_area * a**2, s.E_star * p)
    units = {"load": a * a * p, "area": a * a, "stiffness": a * p, "contacts": 1.0}
    before = sampler_of(scene).block(0, 3).sums
    for name, values in sampler_of(scene.replace(surface=other)).block(0, 3).sums.items():
        np.testing.assert_array_equal(values, before[name] * units[name])

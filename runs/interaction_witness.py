"""How good a mean field is: asperities at places that press each other down in pairs, against `mcgw`.

    python runs/interaction_witness.py [--surfaces 16] [--asperities 300]

The witness (Yeo, Katta and Polycarpou; Vakis): every asperity sinks by what the point load of every other one
presses the half-space down at its place, ``s_i - d_i = h + kappa/pi sum_j p_j/r_ij``, p = d^1.5, with
kappa = 4/3 sqrt(R sigma)/L. In a square of their own they are a punch, whose separation is from the
undeformed body. Lying in a periodic cell, where 1/r is replaced by its sum over all images in a neutral
background (Ewald), they count from the mean plane. The mean field is that of `mcgw.Interaction` on a scene
that has the same heights as each surface. Places are random, no two closer than half the lattice's distance;
eta R sigma = 0.05. Per surface: error of the load, rms over surfaces, of independent asperities and of the
mean field; and the area at the load of the witness, over that of independent asperities at the same load.
"""

import argparse
import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import erfc

import mcgw

CROWDING, APART = 0.05, 0.5  # eta R sigma; of two asperities, over 1/sqrt(eta)
SEPARATIONS = (0.0, 1.0, 2.0)
SIGMA, RADIUS, MODULUS = 1e-6, 1e-5, 1e9  # only their product with eta matters
SPLIT = 2.0  # between the two sums of Ewald, over the side: terms beyond those taken are below 1e-16
NEAR, WAVES = 3, 4
_CLOSE = 1e-11


def places(n: int, rng: np.random.Generator, *, periodic: bool) -> np.ndarray:
    """So many random places in the unit square, none closer to another than `APART` allows."""
    found = np.empty((0, 2))
    while len(found) < n:
        one = rng.random(2)
        away = found - one
        if periodic:
            away -= np.rint(away)
        if not len(found) or (away**2).sum(axis=1).min() > APART**2 / n:
            found = np.vstack([found, one])
    return found


def potential(at: np.ndarray, *, periodic: bool) -> np.ndarray:
    """Sinking of each under a unit load on each other, times pi: 1/r, or its sum over images."""
    away = at[:, None] - at
    if not periodic:
        r = np.hypot(away[..., 0], away[..., 1])
        np.fill_diagonal(r, np.inf)
        return 1 / r
    return lattice_potential(away[..., 0], away[..., 1])


def lattice_potential(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Potential of a square lattice of unit charges in a neutral background; at a charge, of all others."""
    total = np.full(x.shape, -2 * math.sqrt(math.pi) / SPLIT)
    for i in range(-NEAR, NEAR + 1):
        for j in range(-NEAR, NEAR + 1):
            r = np.hypot(x + i, y + j)
            own = r < 1e-12
            r[own] = 1.0
            total += np.where(own, -2 * SPLIT / math.sqrt(math.pi), erfc(SPLIT * r) / r)
    for i in range(-WAVES, WAVES + 1):
        for j in range(-WAVES, WAVES + 1):
            if k := 2 * math.pi * math.hypot(i, j):
                total += 2 * math.pi * erfc(k / (2 * SPLIT)) / k * np.cos(2 * math.pi * (i * x + j * y))
    return total


def pairwise(s: np.ndarray, sinking: np.ndarray, h: float) -> np.ndarray:
    """Penetrations of all asperities, by Newton's steps, each as long as the error falls."""

    def misfit(d: np.ndarray) -> np.ndarray:
        return d - (s - h) + sinking @ np.maximum(d, 0) ** 1.5

    d = s - h
    for _ in range(200):
        error = misfit(d)
        if np.abs(error).max() < _CLOSE:
            return np.maximum(d, 0)
        slope = np.eye(s.size) + sinking * (1.5 * np.sqrt(np.maximum(d, 0)))
        step, share = np.linalg.solve(slope, error), 1.0
        while share > 1e-6 and np.linalg.norm(misfit(d - share * step)) >= np.linalg.norm(error):
            share /= 2
        d = d - share * step
    raise RuntimeError(f"no balance of pairs at h = {h:g}: {np.abs(error).max():.1e} is left")


def mean_field(s: np.ndarray, reference: str | None) -> np.ndarray:
    """Reduced load of one surface at `SEPARATIONS` from the reference, with the compliance of `mcgw`."""
    eta = CROWDING / (RADIUS * SIGMA)
    surface = mcgw.Surface(SIGMA, RADIUS, eta, s.size / eta, MODULUS)
    unit = 4 / 3 * MODULUS * math.sqrt(RADIUS) * SIGMA**1.5
    own = 0.0 if reference is None else mcgw.Interaction(reference).compliance(surface, s.size)

    def load(x: float) -> float:
        return float((np.maximum(s - x, 0) ** 1.5).sum())

    def felt(h: float) -> float:
        def over(x: float) -> float:
            return x - h - own * unit / SIGMA * load(x)

        low, high = h, max(h, s.max())
        while over(low) > 0:
            low -= 0.1
        return float(brentq(over, low, high, xtol=1e-14)) if over(high) > 0 else high

    return np.array([load(felt(h)) for h in SEPARATIONS])


def area_at_load(s: np.ndarray, load: float) -> float:
    """Reduced area of independent asperities that carry this load."""

    def missing(x: float) -> float:
        return float((np.maximum(s - x, 0) ** 1.5).sum()) - load

    x = brentq(missing, s.min() - 20, s.max(), xtol=1e-14)
    return float(np.maximum(s - x, 0).sum())


@dataclass(frozen=True)
class Row:
    """Means over surfaces at one separation; errors are rms over them, areas have a standard error."""

    h: float
    contacts: float
    independent: float
    field: float
    pairs: float
    error_independent: float
    error_field: float
    bias_field: float
    area: float
    area_error: float


def study(reference: str, surfaces: int = 16, n: int = 300, seed: int = 5) -> list[Row]:
    """One row for each separation."""
    rng = np.random.default_rng(seed)
    periodic = reference == "mean-plane"
    kappa = 4 / 3 * math.sqrt(CROWDING / n)
    found = np.empty((surfaces, len(SEPARATIONS), 5))
    for one in found:
        s = rng.standard_normal(n)
        sinking = kappa / math.pi * potential(places(n, rng, periodic=periodic), periodic=periodic)
        one[:, 0], one[:, 1] = mean_field(s, None), mean_field(s, reference)
        for row, h in zip(one, SEPARATIONS, strict=True):
            d = pairwise(s, sinking, h)
            row[2], row[3] = (d**1.5).sum(), np.count_nonzero(d)
            row[4] = d.sum() / area_at_load(s, row[2])
    return [_row(h, found[:, k]) for k, h in enumerate(SEPARATIONS)]


def _row(h: float, found: np.ndarray) -> Row:
    independent, field, pairs, contacts, area = found.T
    return Row(
        h,
        contacts.mean(),
        independent.mean(),
        field.mean(),
        pairs.mean(),
        float(np.sqrt(np.mean((independent / pairs - 1) ** 2))),
        float(np.sqrt(np.mean((field / pairs - 1) ** 2))),
        float(np.mean(field / pairs - 1)),
        area.mean(),
        area.std(ddof=1) / math.sqrt(len(area)),
    )


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--surfaces", type=int, default=16, help="how many a row (16)")
    parser.add_argument("--asperities", type=int, default=300, help="of each surface (300)")
    parser.add_argument("--seed", type=int, default=5, help="of heights and places (5)")
    asked = parser.parse_args()
    for reference in ("body", "mean-plane"):
        print(f"\n{reference}: N = {asked.asperities}, eta R sigma = {CROWDING}, {asked.surfaces} surfaces")
        print("   h  contacts  independent (error)    mean field (error, bias)   pairs   area at equal load")
        for x in study(reference, asked.surfaces, asked.asperities, asked.seed):
            print(
                f"{x.h:4.1f} {x.contacts:9.1f} {x.independent:12.4g} ({x.error_independent:6.1%})"
                f" {x.field:12.4g} ({x.error_field:5.1%}, {x.bias_field:+5.1%})"
                f" {x.pairs:9.4g}   {x.area:.4f} +- {x.area_error:.4f}"
            )


if __name__ == "__main__":
    main()

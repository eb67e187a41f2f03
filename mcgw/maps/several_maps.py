"""Several maps of one surface as one fit, whose sub-areas are the maps."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from scipy.special import chdtrc, ndtr, stdtrit

from analytic import SpectralMoments
from analytic.arrays import Array
from mcgw.maps.estimates import SUMMITS, Estimate, Roughness, Visible
from mcgw.maps.fit import Fit
from mcgw.maps.summit_sums import Summits
from mcgw.maps.waves import Spread, Uncertain, Waves, uncertain

_MOMENTS = ("m0", "m2", "m4")


def pooled(fits: Sequence[Fit], names: Sequence[str]) -> Fit:
    """Return one fit of several maps of a surface, without cautions.

    Moments are means over the whole area, densities count all summits. An error is that of the single maps
    taken together, or what the maps scatter if that is more: each map sees its own long waves alone.

    Parameters
    ----------
    fits : sequence of Fit
        Of two maps or more, prepared alike.
    names : sequence of str
        Of the maps, for notes and tables.
    """
    first, areas = fits[0], np.array([fit.area for fit in fits])
    weights = areas / areas.sum()
    m0, m2, m4 = np.array([[getattr(fit.moments, x) for x in _MOMENTS] for fit in fits]).T
    moments = SpectralMoments(*(float(weights @ m) for m in (m0, m2, m4)))
    cubes = weights * (m0 / moments.m0) ** 1.5
    skewness, errors = np.array([fit.skewness for fit in fits]).T
    a, q, sk, ku = np.array([fit.roughness for fit in fits]).T
    rms = math.sqrt(weights @ q**2)
    rough = weights @ np.transpose([a, sk * (q / rms) ** 3, ku * (q / rms) ** 4])
    listed = [fit.listed for fit in fits]
    points = np.array([x.area / x.sums[0].sum() for x in listed])  # area of each
    sums = [x.sums.sum(axis=1) * size for x, size in zip(listed, points / points[0], strict=True)]
    visible = [fit.visible for fit in fits if fit.visible is not None]
    waves, squares = [fit.waves for fit in fits], [[*fit.mean_squares.values()] for fit in fits]
    return replace(
        first,
        moments=moments,
        numbers={
            x: _of_all(getattr(moments, x), [fit.numbers[x] for fit in fits], weights) for x in first.numbers
        },
        estimates={
            x: _estimate(x, fits, weights, moments)
            for x in first.estimates
            if all(x in fit.estimates for fit in fits)
        },
        skewness=(float(cubes @ skewness), float(np.linalg.norm(cubes * errors))),
        listed=replace(
            Summits.together(listed, np.transpose(sums)),
            tile=np.repeat(np.arange(len(fits)), [x.heights.size for x in listed]),
        ),
        visible=Visible(*(weights @ visible).tolist()) if len(visible) == len(fits) else None,
        mean_squares=dict(zip(first.mean_squares, (weights @ squares).tolist(), strict=True)),
        waves=Waves(
            {x: _together([each.spreads[x] for each in waves], weights) for x in waves[0].spreads},
            sum(each.independent for each in waves),
            np.tensordot(weights**2, [each.covariance for each in waves], 1),
        ),
        roughness=Roughness(float(rough[0]), rms, float(rough[1]), float(rough[2])),
        maps=tuple(names),
        notes=tuple(f"{name}: {line}" for name, fit in zip(names, fits, strict=True) for line in fit.notes),
        cautions=(),
    )


def _together(each: Sequence[Spread], weights: Array) -> Spread:
    """Errors and arms of independent maps taken together."""
    return Spread(*np.linalg.norm(weights[:, None] * each, axis=0).tolist())


def _of_all(value: float, each: Sequence[Uncertain], weights: Array) -> Uncertain:
    """Return a value of all maps with its error: that of each map, or of their scatter if that is larger.

    The scatter is of logarithms, widened as Student's t asks for so few maps: two errors hold 95 %.
    """
    logs, n = np.log([x.value for x in each]), len(each)
    between = math.sqrt(n / (n - 1) * float(np.sum(weights**2 * (logs - weights @ logs) ** 2)))
    between *= float(stdtrit(n - 1, ndtr(2.0))) / 2
    arms = [Spread(x.relative, math.log(x.value / x.low), math.log(x.high / x.value)) for x in each]
    return uncertain(value, value * between, _together(arms, weights))


def disagreement(fits: Sequence[Fit]) -> Iterator[tuple[str, float]]:
    """Tell what differs between the maps by more than its errors, once in 1000 by chance, and the factor."""
    words = {"m0": "heights", "m2": "slopes", "m4": "curvatures"}
    for name, word in words.items():
        each = [fit.numbers[name] for fit in fits]
        logs, certain = np.log([x.value for x in each]), 1 / np.array([x.relative for x in each]) ** 2
        chi_square = float(certain @ (logs - np.average(logs, weights=certain)) ** 2)
        if chdtrc(len(each) - 1, chi_square) < 1e-3 / len(words):
            yield word, math.exp(np.ptp(logs))


def _estimate(method: str, fits: Sequence[Fit], weights: Array, moments: SpectralMoments) -> Estimate:
    """Density, radius and spread by one method: from pooled moments, or of all summits of all maps."""
    found = [fit.estimates[method] for fit in fits]
    if method == "moments":
        values = [getattr(moments, x) for x in SUMMITS]
    else:
        eta, radius, sigma = np.array([[getattr(e, x).value for x in SUMMITS] for e in found]).T
        density = float(weights @ eta)
        shares, levels = weights * eta / density, np.array([fit.mean_summit for fit in fits])
        variance = float(shares @ (sigma**2 + (levels - shares @ levels) ** 2))
        values = [density, 1 / float(shares @ (1 / radius)), math.sqrt(variance)]
    each = ([getattr(e, x) for e in found] for x in SUMMITS)
    return Estimate(*(_of_all(value, x, weights) for value, x in zip(values, each, strict=True)))

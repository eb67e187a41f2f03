"""Several maps of one surface as one fit, whose sub-areas are the maps."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from scipy.special import chdtrc, ndtr, stdtrit

from analytic import SpectralMoments
from analytic.arrays import Array
from mcgw.formats.table import Column, Table
from mcgw.maps.estimates import SUMMITS, Estimate, Roughness
from mcgw.maps.fit import Fit
from mcgw.maps.hidden_caps import Visible
from mcgw.maps.summits import Summits
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

    def mean(of: Callable[[Fit], Sequence[float]]) -> list[float]:
        """Return means over the area of several numbers of each fit."""
        return [float(x) for x in weights @ np.array([of(fit) for fit in fits])]

    moments = SpectralMoments(*mean(lambda fit: [getattr(fit.moments, x) for x in _MOMENTS]))
    cubes = weights * [(fit.moments.m0 / moments.m0) ** 1.5 for fit in fits]
    skewness, errors = np.array([fit.skewness for fit in fits]).T
    all_visible = [fit.visible for fit in fits if fit.visible is not None]
    visible = Visible(*(weights @ all_visible).tolist()) if len(all_visible) == len(fits) else None
    methods = [x for x in first.estimates if all(x in fit.estimates for fit in fits)]
    return replace(
        first,
        moments=moments,
        numbers={
            x: _of_all(getattr(moments, x), [fit.numbers[x] for fit in fits], weights) for x in first.numbers
        },
        estimates={x: _estimate(x, fits, weights, moments) for x in methods},
        skewness=(float(cubes @ skewness), float(np.linalg.norm(cubes * errors))),
        listed=_listed(fits),
        mean_summit=float(
            np.average([fit.mean_summit for fit in fits], weights=[fit.summits.size for fit in fits])
        ),
        area=float(areas.sum()),
        visible=visible,
        mean_squares=dict(
            zip(first.mean_squares, mean(lambda fit: [*fit.mean_squares.values()]), strict=True)
        ),
        waves=Waves(
            {x: _together([fit.waves.spreads[x] for fit in fits], weights) for x in first.waves.spreads},
            sum(fit.waves.independent for fit in fits),
            np.tensordot(weights**2, [fit.waves.covariance for fit in fits], 1),
        ),
        tiles=_tiles(fits, names),
        roughness=Roughness.of(*mean(lambda fit: fit.roughness.means)),
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


def _listed(fits: Sequence[Fit]) -> Summits:
    """Summits of one map after the other; heights are relative to the mean of all."""
    listed = [fit.listed for fit in fits]
    heights = np.concatenate([fit.summits + fit.mean_summit for fit in fits])
    return Summits(
        np.concatenate([x.x for x in listed]),
        np.concatenate([x.y for x in listed]),
        heights - heights.mean(),
        np.concatenate([x.curvatures for x in listed], axis=1),
        np.repeat(np.arange(len(fits)), [x.heights.size for x in listed]),
        sum(x.unresolved for x in listed),
    )


def _tiles(fits: Sequence[Fit], names: Sequence[str]) -> Table:
    """Return a row for each map: its summits as counted, and its moments."""
    by = "summits" if all("summits" in fit.estimates for fit in fits) else "moments"
    found = {x: [getattr(fit.estimates[by], x).value for fit in fits] for x in SUMMITS}
    units = {"eta": "1/m^2", "radius": "m", "sigma": "m", "m0": "m^2", "m2": "", "m4": "1/m^2"}
    found |= {x: [getattr(fit.moments, x) for fit in fits] for x in _MOMENTS}
    return Table((
        Column("map", list(names)),
        Column("summits", np.array([fit.summits.size for fit in fits])),
        *(Column(x, np.array(values), unit=units[x]) for x, values in found.items()),
    ))  # fmt: skip

"""Fit a map from its file, in one call."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import ndtr, stdtrit

from analytic import SpectralMoments
from analytic.arrays import Array
from mcgw.machine.process import told
from mcgw.maps.estimates import SUMMITS, Estimate, Roughness, Visible
from mcgw.maps.fit import Fit, fit_prepared
from mcgw.maps.fit_cautions import cautions, cautions_of_several, profile_cautions
from mcgw.maps.heights_files import read_heights
from mcgw.maps.preparation import Preparation, Prepared, preparation_of, prepared
from mcgw.maps.profile_fit import ProfileFit, fit_profiles
from mcgw.maps.steps import Form, LinesTo, Missing, SpikesTo
from mcgw.maps.summit_sums import Summits
from mcgw.maps.topography import Profile, Topography
from mcgw.maps.waves import Spread, Uncertain, Waves, uncertain
from mcgw.scene.kinds import argument


def fit(
    heights: str | Path | Topography | Profile | Sequence[str | Path | Topography | Profile],
    *,
    cutoff: float | str | None,
    form: Form = "plane",
    missing: Missing = "auto",
    spikes: SpikesTo = "keep",
    trim: int = 0,
    long_cutoff: float | str | None = None,
    lines: LinesTo = "keep",
    parts: int = 4,
    pixel: float | str | None = None,
    unit: str | None = None,
    missing_value: float | None = None,
) -> Fit | ProfileFit:
    """Fit summit density, radius and spread to measured height maps, or to profiles of one surface.

    Parameters
    ----------
    heights : str, Path, Topography or Profile, or a list of them
        A file (.npy, .h5, text; SDF, X3P and all that SurfaceTopography reads), or a map in memory; or
        profiles: text of x and z, or any file that holds heights along a line. Of several maps of one
        surface moments are pooled by area, and what the maps scatter is in the errors.
    cutoff : float, str or None
        Shortest wavelength of the roughness (Gaussian filter, ISO 16610-61), m or text such as "5 um";
        None or "none": as measured.
    form : {"plane", "none", "quadratic", "cubic", "quartic"}, optional
        Form to remove first.
    missing : {"auto", "mask", "fill"}, optional
        Missing points are filled from the edges of their holes. ``mask`` ignores them and points next to
        them; ``fill`` uses them; ``auto`` masks them if half of the measured points remain. ``notes`` of
        the fit state what was done.
    spikes : {"keep", "remove"}, optional
        Whether to remove spikes: points far above or below their neighbours, or of extreme curvature.
    trim : int, optional
        Number of points to remove along each edge.
    long_cutoff : float, str or None, optional
        Longest wavelength of the roughness, m or text such as "80 um"; None: as measured.
    lines : {"keep", "rows", "columns"}, optional
        Whether to remove offsets between rows or columns, as from a line scan.
    parts : int, optional
        Number of sub-areas along each axis, to estimate errors; at least 2, and fewer if there are few
        summits.
    pixel : float or str, optional
        Size of a pixel, m or text such as "1 um", where the file does not tell it.
    unit : str, optional
        Of the heights, as "um", where the file does not tell it.
    missing_value : float, optional
        Number that stands for a missing point, in the unit of the file, such as -9999.

    Returns
    -------
    Fit or ProfileFit
        Estimates by all methods (one for profiles) with cautions; `mcgw.fitted_scene` makes a scene from it.

    Raises
    ------
    SceneError
        If an argument is wrong.
    ValueError
        If the file cannot be read, or the map is not usable.

    Examples
    --------
    >>> import mcgw, tempfile, numpy as np
    >>> z = np.random.default_rng(1).normal(size=(256, 256)) * 1e-6
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     np.save(f"{folder}/map.npy", z)
    ...     found = mcgw.fit(f"{folder}/map.npy", cutoff="10 um", pixel="1 um")
    >>> sorted(found.estimates)
    ['moments', 'summits']
    """
    asked = preparation_of({
        "cutoff": cutoff, "form": form, "missing": missing, "spikes": spikes, "trim": trim,
        "long_cutoff": long_cutoff, "lines": lines, "parts": parts,
    })  # fmt: skip
    size = None if pixel is None else (argument("pixel", pixel, "m"),) * 2
    if isinstance(heights, str | Path | Topography | Profile):
        heights = [heights]
    sources = [Path(each) if isinstance(each, str) else each for each in heights]
    read = partial(read_heights, pixel=size, unit=unit, missing=missing_value)
    return fit_sources(sources, read, asked)[0]


def fit_sources(
    sources: Sequence[Path | Topography | Profile],
    read: Callable[[Path], Topography | Profile],
    asked: Preparation,
    use: str = "auto",
) -> tuple[Fit | ProfileFit, Prepared | None, str]:
    """Fit maps or profiles of one surface; a file is read when its turn comes.

    Returns the fit of all, with its cautions about the estimate to `use`; the last map as prepared; and an
    assumed unit of lengths.
    """
    names = [x.name if isinstance(x, Path) else f"map {k}" for k, x in enumerate(sources, 1)]
    fits: list[Fit] = []
    lines: list[Profile] = []
    ready, assumed = None, ""
    for name, source in zip(names, sources, strict=True):
        each: list[Any] = [read(source) if isinstance(source, Path) else source]
        assumed = assumed or each[0].assumed_unit
        is_line = isinstance(each[0], Profile)
        if fits if is_line else lines:
            line, area = (name, names[0]) if is_line else (names[0], name)
            raise ValueError(f"{line}: a profile, and {area} is a map; fit them apart")
        if is_line:
            lines += each
            continue
        with told(None, "steps") as tell:
            tell(0, 3)
            ready = prepared(each.pop(), asked)  # a large map that stayed in a list would fill the memory
            tell(1, 3)
            fit = fit_prepared(ready)
            tell(2, 3)
            fits.append(replace(fit, cautions=tuple(cautions(fit, ready, use))))
            tell(3, 3)
    if lines:
        plain = Preparation(asked.cutoff, asked.form, parts=asked.parts)
        for name, value in vars(asked).items():
            if value != getattr(plain, name):
                option = f"--{name.replace('_', '-')}"
                raise ValueError(f"{option}: is for maps only; prepare the profile before")
        of_lines = fit_profiles(lines, cutoff=asked.cutoff, form=asked.form)
        warned = tuple(profile_cautions(of_lines, lines, asked.cutoff))
        return replace(of_lines, cautions=warned), None, assumed
    if len(fits) == 1:
        return fits[0], ready, assumed
    found = _pooled(fits, names)
    return replace(found, cautions=tuple(cautions_of_several(found, fits, use))), ready, assumed


# --- several maps of one surface as one fit, whose sub-areas are the maps ---


def _pooled(fits: Sequence[Fit], names: Sequence[str]) -> Fit:
    """Return one fit of several maps of a surface, without cautions.

    Moments are means over the whole area, densities count all summits. An error is that of the single maps
    taken together, or what the maps scatter if that is more: each map sees its own long waves alone.
    """
    first, areas = fits[0], np.array([fit.area for fit in fits])
    weights = areas / areas.sum()
    of_each = [[fit.moments.m0, fit.moments.m2, fit.moments.m4] for fit in fits]
    moments = SpectralMoments(*(weights @ of_each).tolist())
    cubes = [np.array(fit.skewness) * (fit.moments.m0 / moments.m0) ** 1.5 for fit in fits]
    skewness, errors = (weights[:, None] * cubes).T
    each = [fit.roughness for fit in fits]
    a, square, cube, fourth = weights @ [[r.a, r.q**2, r.sk * r.q**3, r.ku * r.q**4] for r in each]
    rms = math.sqrt(square)
    listed, waves = [fit.listed for fit in fits], [fit.waves for fit in fits]
    sums = [x.sums.sum(axis=1) * math.prod(x.pixel) / math.prod(listed[0].pixel) for x in listed]
    methods = [x for x in first.estimates if all(x in fit.estimates for fit in fits)]
    visible = [fit.visible for fit in fits if fit.visible is not None]
    squares = weights @ [[*fit.mean_squares.values()] for fit in fits]
    return replace(
        first,
        moments=moments,
        numbers={
            x: _of_all(getattr(moments, x), [fit.numbers[x] for fit in fits], weights) for x in first.numbers
        },
        estimates={x: _estimate(x, fits, weights, moments) for x in methods},
        skewness=(float(skewness.sum()), float(np.linalg.norm(errors))),
        listed=replace(
            Summits.together(listed, np.transpose(sums)),
            tile=np.repeat(np.arange(len(fits)), [x.heights.size for x in listed]),
        ),
        visible=Visible(*(weights @ visible).tolist()) if len(visible) == len(fits) else None,
        mean_squares=dict(zip(first.mean_squares, squares.tolist(), strict=True)),
        waves=Waves(
            {x: _together([each.spreads[x] for each in waves], weights) for x in waves[0].spreads},
            sum(each.independent for each in waves),
            np.tensordot(weights**2, [each.covariance for each in waves], 1),
        ),
        roughness=Roughness(float(a), rms, float(cube / rms**3), float(fourth / rms**4)),
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

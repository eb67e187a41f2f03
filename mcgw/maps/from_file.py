"""From the file of a map to its fit, in one call."""

from dataclasses import replace
from pathlib import Path

from mcgw.maps.cautions import cautions
from mcgw.maps.files import read_map
from mcgw.maps.fit import Fit, fit_prepared
from mcgw.maps.form import FORMS, Form
from mcgw.maps.preparation import (
    MISSING,
    SPIKES,
    STEP,
    Missing,
    Preparation,
    SpikesTo,
    StepTo,
    prepared,
)
from mcgw.maps.topography import Topography
from mcgw.scene.reading import argument, as_toml
from mcgw.scene.section import SceneError, Section

__all__ = ["fit"]


def fit(
    heights: str | Path | Topography,
    *,
    cutoff: float | str | None,
    form: Form = "plane",
    missing: Missing = "auto",
    spikes: SpikesTo = "keep",
    step: StepTo = "keep",
    trim: int = 0,
    long_cutoff: float | str | None = None,
    parts: int = 4,
    pixel: float | str | None = None,
    unit: str | None = None,
) -> Fit:
    """Fit summit density, radius and spread to a measured height map.

    Parameters
    ----------
    heights : str, Path or Topography
        A file (SDF, X3P, .npy, .h5, text, or whatever SurfaceTopography reads), or a map in memory.
    cutoff : float, str or None
        Shortest wavelength that counts (Gaussian filter, ISO 16610-61), m or as "5 um"; None: as measured.
    form : {"plane", "none", "quadratic", "cubic", "quartic", "sphere", "cylinder"}, optional
        What is taken off first.
    missing : {"auto", "mask", "fill"}, optional
        Missing points are filled from the edges of their holes. With ``mask`` neither they nor points whose
        neighbours are missing count; with ``fill`` all do; ``auto`` masks them while half of the measured
        points is left. ``notes`` of the fit say what was done.
    spikes : {"keep", "remove"}, optional
        Whether points that stand out of the map become missing ones.
    step : {"keep", "crop"}, optional
        Whether of two terraces only the larger one is kept.
    trim : int, optional
        Points that are left off along each edge.
    long_cutoff : float, str or None, optional
        Longest wavelength that counts, m or as "80 um"; None: as measured.
    parts : int, optional
        Sub-areas along each axis, whose differences tell the errors; at least 2, and fewer where summits
        are few.
    pixel : float or str, optional
        Size of a pixel, m or as "1 um", where the file does not tell it.
    unit : str, optional
        Of the heights, as "um", where the file does not tell it.

    Returns
    -------
    Fit
        Estimates by all methods, and the reasons not to trust them; `mcgw.fitted_scene` makes a scene of it.

    Raises
    ------
    SceneError
        If an argument is wrong.
    ValueError
        If the file cannot be read, or the map tells nothing.

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
    given = {"parts": as_toml(parts), "trim": as_toml(trim)}
    given |= {"form": form, "missing": missing, "spikes": spikes, "step": step}
    section = Section("", given, [])
    across, trimmed = section.whole("parts", least=2), section.whole("trim", least=0)
    for key, kinds in (("form", FORMS), ("missing", MISSING), ("spikes", SPIKES), ("step", STEP)):
        section.choice(key, kinds[0], kinds)
    if section.problems:
        raise SceneError(section.problems)
    short, long = (
        None if length is None else argument(name, length, "m")
        for name, length in (("cutoff", cutoff), ("long_cutoff", long_cutoff))
    )
    if not isinstance(heights, Topography):
        size = None if pixel is None else (argument("pixel", pixel, "m"),) * 2
        heights = read_map(Path(heights), pixel=size, unit=unit)
    ready = prepared(heights, Preparation(short, form, missing, spikes, step, trimmed, long))
    found = fit_prepared(ready, across=across)
    return replace(found, cautions=tuple(cautions(found, ready)))

"""From the file of a map to its fit, in one call."""

from dataclasses import replace
from pathlib import Path

from mcgw.maps.cautions import cautions
from mcgw.maps.files import read_map
from mcgw.maps.fit import Fit, fit_map
from mcgw.maps.form import FORMS, Form
from mcgw.maps.topography import Topography
from mcgw.scene.reading import argument, as_toml
from mcgw.scene.section import SceneError, Section

__all__ = ["fit"]


def fit(
    heights: str | Path | Topography,
    *,
    cutoff: float | str | None,
    form: Form = "plane",
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
    form : {"plane", "none", "quadratic"}, optional
        What is taken off first.
    parts : int, optional
        Sub-areas along each axis, whose differences tell the errors; at least 2.
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
    section = Section("", {"parts": as_toml(parts), "form": form}, [])
    across = section.whole("parts", least=2)
    section.choice("form", "plane", FORMS)
    if section.problems:
        raise SceneError(section.problems)
    limit = None if cutoff is None else argument("cutoff", cutoff, "m")
    if not isinstance(heights, Topography):
        size = None if pixel is None else (argument("pixel", pixel, "m"),) * 2
        heights = read_map(Path(heights), pixel=size, unit=unit)
    found = fit_map(heights, cutoff=limit, form=form, across=across)
    return replace(found, cautions=tuple(cautions(found, heights, limit)))

"""From the file of a map to its fit, in one call."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from mcgw.maps.fit import Fit, fit_prepared
from mcgw.maps.fit_cautions import cautions, profile_cautions
from mcgw.maps.map_files import read_map
from mcgw.maps.preparation import Prepared, preparation_of, prepared
from mcgw.maps.profile import Profile
from mcgw.maps.profile_files import holds_profile, read_profile
from mcgw.maps.profile_fit import ProfileFit, fit_profiles
from mcgw.maps.steps import Form, LinesTo, Missing, SpikesTo, StepTo
from mcgw.maps.topography import Topography
from mcgw.scene.arguments import argument

__all__ = ["fit"]


def fit(
    heights: str | Path | Topography | Profile | Sequence[str | Path | Profile],
    *,
    cutoff: float | str | None,
    form: Form = "plane",
    missing: Missing = "auto",
    spikes: SpikesTo = "keep",
    step: StepTo = "keep",
    trim: int = 0,
    long_cutoff: float | str | None = None,
    lines: LinesTo = "keep",
    parts: int = 4,
    pixel: float | str | None = None,
    unit: str | None = None,
    profile: bool = False,
) -> Fit | ProfileFit:
    """Fit summit density, radius and spread to a measured height map, or to profiles of one surface.

    Parameters
    ----------
    heights : str, Path, Topography or Profile
        A file (SDF, X3P, .npy, .h5, text, or whatever SurfaceTopography reads), or a map in memory; or
        profiles, one or a list: text of x and z, or any file that holds heights along a line.
    cutoff : float, str or None
        Shortest wavelength that counts (Gaussian filter, ISO 16610-61), m or as "5 um"; None or "none": as
        measured.
    form : {"plane", "none", "quadratic", "cubic", "quartic", "sphere", "cylinder"}, optional
        What is taken off first.
    missing : {"auto", "mask", "fill"}, optional
        Missing points are filled from the edges of their holes. With ``mask`` neither they nor points whose
        neighbours are missing count; with ``fill`` all do; ``auto`` masks them while half of the measured
        points is left. ``notes`` of the fit say what was done.
    spikes : {"keep", "remove"}, optional
        Whether points that stand out of the map, or bend unlike all others, become missing ones.
    step : {"keep", "crop"}, optional
        Whether of two terraces only the larger one is kept.
    trim : int, optional
        Points that are left off along each edge.
    long_cutoff : float, str or None, optional
        Longest wavelength that counts, m or as "80 um"; None: as measured.
    lines : {"keep", "rows", "columns"}, optional
        Whether offsets between rows, or columns, are taken off, as of a scan line by line.
    parts : int, optional
        Sub-areas along each axis, whose differences tell the errors; at least 2, and fewer where summits
        are few.
    pixel : float or str, optional
        Size of a pixel, m or as "1 um", where the file does not tell it.
    unit : str, optional
        Of the heights, as "um", where the file does not tell it.
    profile : bool, optional
        Read a file as a profile whatever its shape.

    Returns
    -------
    Fit or ProfileFit
        Estimates by all methods (of profiles there is one), and the reasons not to trust them;
        `mcgw.fitted_scene` makes a scene of it.

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
    given = {
        "cutoff": cutoff, "form": form, "missing": missing, "spikes": spikes, "step": step, "trim": trim,
        "long_cutoff": long_cutoff, "lines": lines, "parts": parts,
    }  # fmt: skip
    asked, across = preparation_of(given, lambda key, value: argument(key, value, "m"))
    length = None if pixel is None else argument("pixel", pixel, "m")
    if isinstance(heights, Topography):
        return _of_map(prepared(heights, asked), across)
    if isinstance(heights, str | Path) and not (profile or holds_profile(Path(heights))):
        square = None if length is None else (length, length)
        return _of_map(prepared(read_map(Path(heights), pixel=square, unit=unit), asked), across)
    several = [heights] if isinstance(heights, str | Path | Profile) else heights
    read = [
        p if isinstance(p, Profile) else read_profile(Path(p), spacing=length, unit=unit) for p in several
    ]
    of_profiles = fit_profiles(read, cutoff=asked.cutoff, form=form)
    return replace(of_profiles, cautions=tuple(profile_cautions(of_profiles, read, asked.cutoff)))


def _of_map(ready: Prepared, across: int) -> Fit:
    """With what speaks against it."""
    found = fit_prepared(ready, across=across)
    return replace(found, cautions=tuple(cautions(found, ready)))

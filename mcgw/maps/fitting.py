"""Fit a map from its file, in one call."""

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from functools import partial
from pathlib import Path

from mcgw.machine.progress import stages
from mcgw.maps.fit import Fit, fit_prepared
from mcgw.maps.fit_cautions import cautions, cautions_of_several, profile_cautions
from mcgw.maps.map_files import read_map
from mcgw.maps.preparation import Preparation, Prepared, preparation_of, prepared
from mcgw.maps.profile import Profile
from mcgw.maps.profile_files import holds_profile, read_profile
from mcgw.maps.profile_fit import ProfileFit, fit_profiles
from mcgw.maps.several_maps import pooled
from mcgw.maps.steps import Form, LinesTo, Missing, SpikesTo
from mcgw.maps.topography import Topography
from mcgw.scene.arguments import argument


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
    profile: bool = False,
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
    profile : bool, optional
        Read a file as a profile whatever its shape.
    missing_value : float, optional
        Number that stands for a missing point of a map, in the unit of the file, such as -9999.

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
    given = {
        "cutoff": cutoff, "form": form, "missing": missing, "spikes": spikes, "trim": trim,
        "long_cutoff": long_cutoff, "lines": lines, "parts": parts,
    }  # fmt: skip
    asked, across = preparation_of(given, lambda key, value: argument(key, value, "m"))
    length = None if pixel is None else argument("pixel", pixel, "m")
    if isinstance(heights, str | Path | Topography | Profile):
        heights = [heights]
    sources = [Path(each) if isinstance(each, str) else each for each in heights]
    if are_profiles(sources, profile=profile):
        of_lines = [each for each in sources if not isinstance(each, Topography)]
        return fit_lines(of_lines, asked, spacing=length, unit=unit)[0]
    maps = [each for each in sources if not isinstance(each, Profile)]
    return fit_maps(maps, asked, across, pixel=length, unit=unit, missing=missing_value)[0]


def are_profiles(sources: Sequence[Path | Topography | Profile], *, profile: bool = False) -> bool:
    """Whether sources are profiles, files by their shape unless they are to be read as a `profile`.

    Raises
    ------
    ValueError
        If some are profiles and some maps.
    """
    kinds = [
        profile or holds_profile(each) if isinstance(each, Path) else isinstance(each, Profile)
        for each in sources
    ]
    if any(kinds) and not all(kinds):
        line, area = (
            str(sources[k]) if isinstance(sources[k], Path) else f"number {k + 1}"
            for k in (kinds.index(True), kinds.index(False))
        )
        raise ValueError(f"{line}: a profile, and {area} is a map; fit them apart")
    return all(kinds)


def fit_maps(
    sources: Sequence[Path | Topography],
    asked: Preparation,
    across: int,
    *,
    pixel: float | None = None,
    unit: str | None = None,
    missing: float | None = None,
    use: str = "auto",
) -> tuple[Fit, Prepared]:
    """Fit maps of one surface; return the fit of all, with its cautions, and the first map as prepared."""
    size = None if pixel is None else (pixel, pixel)
    read = partial(read_map, pixel=size, unit=unit, missing=missing)
    fit, first = _fit_map(sources[0], read, asked, across, use)
    if len(sources) == 1:
        return fit, first
    fits = [fit, *(_fit_map(source, read, asked, across, use)[0] for source in sources[1:])]
    names = [x.name if isinstance(x, Path) else f"map {k}" for k, x in enumerate(sources, 1)]
    found = pooled(fits, names)
    return replace(found, cautions=tuple(cautions_of_several(found, fits, use))), first


def _fit_map(
    source: Path | Topography, read: Callable[[Path], Topography], asked: Preparation, across: int, use: str
) -> tuple[Fit, Prepared]:
    """Fit a map; return the fit, its cautions for the estimate to `use`, and the prepared map."""
    with stages(4) as done:
        raw = [source if isinstance(source, Topography) else read(source)]
        done()
        ready = prepared(raw.pop(), asked)  # the raw map is not kept: large ones fill the memory
        done()
        found = fit_prepared(ready, across=across)
        done()
        found = replace(found, cautions=tuple(cautions(found, ready, use)))
        done()
    return found, ready


def fit_lines(
    sources: Sequence[Path | Profile], asked: Preparation, *, spacing: float | None, unit: str | None
) -> tuple[ProfileFit, list[Profile]]:
    """Fit profiles from files or memory; return the fit, its cautions and the profiles.

    Raises
    ------
    ValueError
        If a step is asked for that maps alone have, or a profile cannot be read or fitted.
    """
    plain = Preparation(asked.cutoff, asked.form)
    for field in fields(asked):
        if getattr(asked, field.name) != getattr(plain, field.name):
            raise ValueError(
                f"--{field.name.replace('_', '-')}: is for maps only; prepare the profile before"
            )
    profiles = [p if isinstance(p, Profile) else read_profile(p, spacing=spacing, unit=unit) for p in sources]
    found = fit_profiles(profiles, cutoff=asked.cutoff, form=asked.form)
    return replace(found, cautions=tuple(profile_cautions(found, profiles, asked.cutoff))), profiles

"""The table [heights] of a scene: which height law, and what it needs."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import (
    ExponentialHeights,
    Gaussian,
    HeightLaw,
    HeightTable,
    MeasuredHeights,
    Nayak,
    ScipyHeights,
    Weibull,
)
from mcgw.formats.named_files import open_npy, read_text
from mcgw.scene.section import SceneError, Section

__all__ = ["LAWS", "heights_law", "heights_table", "read_heights"]

# Laws without parameters.
_PLAIN: dict[str, HeightLaw] = {
    "gaussian": Gaussian(),
    "exponential": ExponentialHeights(),
}
LAWS = (*_PLAIN, "weibull", "nayak", "table", "scipy")
_KNOWN = (*map(type, _PLAIN.values()), Weibull, Nayak, HeightTable, MeasuredHeights, ScipyHeights)
_MOST_BYTES = 2**28


def heights_law(section: Section, folder: Path) -> HeightLaw:
    """Read the height law; mistakes are noted in the section, and give the Gaussian one."""
    name = section.choice("law", "gaussian", LAWS)
    match name:
        case "weibull":
            return _weibull(section)
        case "nayak":
            return _nayak(section)
        case "table":
            return _table(section, folder)
        case "scipy":
            return _scipy(section)
    return _PLAIN[name]


def _weibull(section: Section) -> HeightLaw:
    shape = section.number("shape")
    try:
        return Weibull(shape)
    except ValueError:
        if np.isfinite(shape):
            section.fail("shape", shape, "give a number from 1 to 100 (3.6 has no skewness)")
        return Gaussian()


def _nayak(section: Section) -> HeightLaw:
    alpha = section.number("alpha")
    try:
        return Nayak(alpha)
    except ValueError:
        if np.isfinite(alpha):
            section.fail("alpha", alpha, "give a number from 1.501 to 1e12, m0 m4/m2^2 of the surface")
        return Gaussian()


def _table(section: Section, folder: Path) -> HeightLaw:
    """Heights in the scene or in a file, to be resampled or added up; or points of their distribution."""
    keys = ("file", "heights", "s", "share", "resample")
    file, heights, s, share, resample = (section.take(key) for key in keys)
    key = "file" if file is not None else "heights" if heights is not None else "s"
    if resample not in (None, True, False):
        section.fail("resample", resample, "say true or false")
    try:
        if key == "s":
            return HeightTable(s or (), share or ())
        sample = read_heights(folder / str(file)) if heights is None else heights
        return HeightTable.of(sample) if resample is not False else MeasuredHeights(sample)
    except (TypeError, ValueError) as error:
        advice = "give heights (a list), a file of them, or points s and share"
        section.fail(key, {"file": file, "heights": heights, "s": s}[key], f"{advice}; {error}")
        return Gaussian()


def read_heights(path: Path) -> NDArray[np.float64]:
    """Heights from ``.npy`` or text with one a line (# begins a comment), in any unit; shape (heights,).

    Raises
    ------
    ValueError
        If the file cannot be read, is longer than 256 MB, or does not hold numbers; nothing of what stands
        there is quoted.
    """
    if path.suffix == ".npy":
        array = open_npy(path)
        if array.nbytes > _MOST_BYTES:
            raise ValueError(f"{path}: longer than {_MOST_BYTES} bytes; give a part of these heights")
        return np.asarray(array, dtype=np.float64).ravel()
    lines = read_text(path, _MOST_BYTES).splitlines()
    try:
        return np.loadtxt(lines, dtype=np.float64, delimiter=",", ndmin=1).ravel()
    except ValueError:
        raise ValueError(
            f"{path}: give one height a line, or equally many on each, parted by commas"
        ) from None


def _scipy(section: Section) -> HeightLaw:
    before, name, shapes = len(section.problems), section.text("name", "norm"), section.take("shapes")
    if len(section.problems) > before:
        return Gaussian()
    shapes = {} if shapes is None else shapes
    import scipy.stats  # takes half a second, which other scenes need not wait

    distribution = getattr(scipy.stats, name, None)
    if not isinstance(distribution, scipy.stats.rv_continuous):
        section.fail("name", name, 'give a continuous distribution of scipy.stats, as "gamma"')
        return Gaussian()
    try:
        return ScipyHeights(distribution(**{key: float(value) for key, value in dict(shapes).items()}))
    except (TypeError, ValueError) as error:
        wanted = distribution.shapes or "none"
        section.fail("shapes", shapes, f"give its shapes ({wanted}), as {{a = 4.0}}; {error}")
        return Gaussian()


def heights_table(heights: HeightLaw, file: str | None = None) -> dict[str, Any]:
    """The table [heights] of a height law, read again the same; measured heights by the name of their file.

    Raises
    ------
    SceneError
        If it is a class of the user.
    """
    for known, plain in _PLAIN.items():
        if type(heights) is type(plain):
            return {"law": known}
    match heights:
        case _ if type(heights) not in _KNOWN:  # a class made of one may do more
            pass
        case Weibull():
            return {"law": "weibull", "shape": float(heights.shape)}
        case Nayak():
            return {"law": "nayak", "alpha": float(heights.alpha)}
        case HeightTable():
            return {"law": "table", "s": list(heights.s), "share": list(heights.share)}
        case MeasuredHeights():
            held = {"heights": list(heights.heights)} if file is None else {"file": file}
            return {"law": "table", **held, "resample": False}
        case ScipyHeights():
            import scipy.stats  # as above

            dist = getattr(heights.distribution, "dist", None)
            name = getattr(dist, "name", None)
            if name and type(dist) is type(getattr(scipy.stats, name, None)):
                return {"law": "scipy", "name": name, "shapes": heights.shapes}
    own = getattr(getattr(heights, "distribution", None), "dist", heights)
    raise SceneError(
        [
            f"heights: {type(own).__name__} is a Python class that no file can hold; give a distribution of "
            "scipy.stats, or points of it as a HeightTable"
        ]
    )

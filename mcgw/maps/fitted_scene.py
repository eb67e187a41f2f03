"""The scene of a fit, and its file as a person reads it: four digits, natural units, nothing by default."""

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import tomli_w

from analytic import HeightTable, MeasuredHeights, MeasuredRadii, Nayak, SpectralMoments, Surface
from mcgw.formats.files import together, whole_file
from mcgw.formats.units import parse
from mcgw.maps.fit import Fit
from mcgw.maps.profile_fit import ProfileFit
from mcgw.maps.waves import log_derivatives
from mcgw.scene.contact import Contact
from mcgw.scene.ensemble import Sampling
from mcgw.scene.fields import LeftOut
from mcgw.scene.keys import KEYS
from mcgw.scene.kinds import argument
from mcgw.scene.laws import evenly
from mcgw.scene.measured import MOMENTS, SUMMITS, Fitted, Uncertainty
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_document
from mcgw.scene.surface import Spectral

Heights = Literal["gaussian", "nayak", "table", "measured", "summits"]
_EQUAL = 1e-3  # of the standard deviation of the map: summits that differ less are equally high
_FITTED = ("load", "area", "stiffness", "contacts", "conductance")  # wanted quantities of a fitted scene
_NATURAL = {  # units of a scene that a person reads, and the numbers for which one is chosen
    "m": (" um", " nm", " mm"),
    "m^2": (" mm^2", " um^2", " cm^2"),
    "1/m^2": ("/mm^2", "/um^2"),
    "Pa": (" GPa", " MPa"),
}
_LEAST, _MOST = 0.01, 1e4


def fitted_scene(
    fit: Fit | ProfileFit,
    *,
    use: str = "auto",
    heights: Heights = "gaussian",
    E_star: float | str = "100 GPa",
    title: str = "",
    **changes: Any,
) -> Scene:
    """Make a scene of a fit.

    Parameters
    ----------
    fit : Fit or ProfileFit
        With the requested estimate; profiles have only one.
    use : {"auto", "moments", "summits", "caps"}
        Which estimate; ``auto`` is `Fit.best`, and with heights of their own the counted summits. With
        measured heights sigma is that of the heights.
    heights : {"gaussian", "nayak", "table", "measured", "summits"}
        Law of the heights; ``nayak`` is that of the isotropic Gaussian surface with the map's moments, whose
        summits have radii of their own; ``measured`` makes an ensemble of the one surface there is, and so
        does ``summits``, each with its own height and radius.
    E_star : float or str
        Composite modulus, which does not follow from a map, Pa or text such as "78.6 GPa".
    title : str
        For people.
    **changes
        Other arguments of the scene, such as a grading, a film, or a larger nominal_area with more
        summits: see `mcgw.Scene.replace`.

    Returns
    -------
    Scene
        On the area of the map, if no other is given.

    Raises
    ------
    ValueError
        If the fit has no such estimate, a parameter makes no surface, or summits as they were measured are
        to lie on another area.
    SceneError, TypeError
        As from `mcgw.Scene.replace`.

    Examples
    --------
    >>> import mcgw, tempfile, numpy as np
    >>> z = np.random.default_rng(1).normal(size=(256, 256)) * 1e-6
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     np.save(f"{folder}/map.npy", z)
    ...     found = mcgw.fit(f"{folder}/map.npy", cutoff="10 um", pixel="1 um")
    >>> scene = mcgw.fitted_scene(found, E_star="70 GPa", grading=mcgw.Exponential(2.0))
    >>> scene.surface.E_star, scene.grading.gamma
    (70000000000.0, 2.0)
    """
    modulus = argument("E_star", E_star, "Pa")
    if heights in ("measured", "summits") and changes.get("nominal_area") is not None:
        raise ValueError(
            f'nominal_area = {changes["nominal_area"]!r}: heights = "{heights}" uses the measured '
            'summits on the area of the map; leave it out, or use heights = "table"'
        )
    by_heights = "moments" if isinstance(fit, ProfileFit) or heights == "nayak" else "summits"
    if use == "auto":
        use = fit.best if isinstance(fit, Fit) and heights == "gaussian" else by_heights
    if isinstance(fit, ProfileFit) and (use == "caps" or heights not in ("gaussian", "nayak")):
        raise ValueError(
            f'use = "{use}", heights = "{heights}": profiles do not show summits, only '
            'moments; use heights = "gaussian" or "nayak"'
        )
    if heights == "nayak" and use != "moments":
        raise ValueError(f'use = "{use}": heights = "nayak" follow from the "moments"')
    if heights not in ("nayak", "summits") and use not in fit.estimates:
        raise ValueError(
            f"use = {use!r}: this map has no such estimate; give one of {', '.join(fit.estimates)}"
        )
    if isinstance(fit, Fit) and use != "moments" and use in fit.estimates and fit.summits.size > 1:
        spread = float(np.ptp(fit.summits))
        if spread < _EQUAL * math.sqrt(fit.numbers["m0"].value):
            raise ValueError(
                f"all {fit.summits.size} summits are equally high, within {spread:.2g} m: a regular texture "
                "has no distribution of summit heights; give sigma, radius and eta of its asperities in a "
                "scene"
            )
    if heights == "nayak":
        scene = scene_of_moments(fit.moments, fit.area, modulus, title)
    elif isinstance(fit, Fit) and heights != "gaussian":
        scene = _of_summits(fit, use, heights, modulus, title)
    else:  # profiles stand for a square of their length
        found = fit.estimates[use]
        surface = Surface(found.sigma.value, found.radius.value, found.eta.value, fit.area, modulus)
        scene = _scene(surface, title)
    more = {"fitted": _known(fit), "uncertainty": _uncertainty(fit, use, heights)}
    return scene.replace(**{**more, **changes})


def _uncertainty(fit: Fit | ProfileFit, use: str, heights: Heights) -> Uncertainty | None:
    """Return the standard errors of the parameters taken from the fit; measured summits have none.

    Their correlations are those of the moments over maps, whatever the estimate.
    """
    if heights in ("measured", "summits"):
        return None
    names, told = (SUMMITS, vars(fit.estimates[use])) if heights != "nayak" else (MOMENTS, fit.numbers)
    of_moments = fit.covariance if isinstance(fit, ProfileFit) else fit.waves.covariance
    by = log_derivatives(fit.moments)
    rows = np.array([by[name] for name in names])
    return Uncertainty.correlated(names, [told[x].relative for x in names], rows @ of_moments @ rows.T)


def _known(fit: Fit | ProfileFit) -> Fitted:
    """Results of the fit besides the summits of the scene."""
    m, heights = fit.moments, fit.roughness
    known = m.m0, m.m2, m.m4, heights.sk, heights.ku
    if isinstance(fit, ProfileFit):
        counted, expected = fit.peaks
        agreement = max(counted, expected) / min(counted, expected) if counted > 0 else None
        return Fitted(*known, 2 / fit.numbers["m0"].relative ** 2, agreement, cautions=fit.cautions)
    return Fitted(*known, fit.waves.independent, fit.agreement, fit.lay, fit.area, fit.cautions)


def scene_of_moments(moments: SpectralMoments, area: float, modulus: float, title: str) -> Scene:
    """Return the scene of an isotropic Gaussian surface, each summit with its own radius."""
    return _scene(Spectral(moments, moments.surface(area, modulus)), title)


def _of_summits(fit: Fit, use: str, heights: Heights, modulus: float, title: str) -> Scene:
    """With the heights of the summits: drawn from their table, or as measured, with their radii."""
    z, law = fit.summits, MeasuredHeights(fit.summits)
    eta = z.size / fit.area  # summits between pixels have no heights
    more: dict[str, Any] = {"heights": law, "ensemble": Sampling(1, z.size, sampler="direct")}
    if heights == "summits":
        radius = float(1 / np.mean(1 / fit.radii))
        more["summits"] = MeasuredRadii(law, fit.radii / radius)
    else:
        radius = fit.estimates[use].radius.value
        if heights == "table":
            eta, more = fit.estimates[use].eta.value, {"heights": HeightTable.of(z)}
        elif use != "summits":
            raise ValueError(f'use = "{use}": measured heights as they are need use = "summits"')
    return _scene(Surface(float(z.std()), radius, eta, fit.area, modulus), title, **more)


def _scene(surface: Surface | Spectral, title: str, **more: Any) -> Scene:
    separations, contact = np.linspace(0, 3, 31).round(1), Contact(quantities=_FITTED)
    return Scene(surface, separations=separations, title=title, contact=contact, seed=1, **more)


def heights_beside(path: Path) -> Path:
    """Path of the file of summit heights."""
    return path.with_name(f"{path.stem}.heights.npy")


def write_scene(scene: Scene, path: Path, measured: Fit | None, comments: list[str]) -> list[Path]:
    """Write a scene from `fitted_scene` with comments above it; returns the files that were written.

    The summit heights of a fit that is `measured` go to a file beside the scene, which names it in place
    of a list. Numbers that nobody gave are left out: N follows when somebody writes another area.
    """
    text = "".join(f"# {line}\n" for line in comments) + "\n"
    beside = heights_beside(path)
    document = scene_document(scene, heights_file=None if measured is None else beside.name)
    if isinstance(scene.seed, LeftOut):
        del document["ensemble"]["seed"]
    if isinstance(scene.heights, Nayak) and document.get("summits") == {"curvature": "random"}:
        m = SpectralMoments.with_alpha(scene.heights.alpha, scene.surface)  # summits follow from it
        surface = {key: value for key, value in document["surface"].items() if key not in SUMMITS}
        surface = {"m0": m.m0, "m2": m.m2, "m4": m.m4, **surface}
        document = document | {"surface": surface, "heights": {}, "summits": {}}
    document = _readable(document)
    text += _in_few_lines(tomli_w.dumps(document), scene.separations)
    with together(), whole_file(path) as unfinished:
        unfinished.write_text(text, encoding="utf-8")
        if measured is None:
            return [path]
        with whole_file(beside) as numbers, open(numbers, "wb") as file:
            np.save(file, measured.summits)
    return [path, beside]


def _readable(document: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of a scene as a person writes them: four digits, natural units, no defaults."""
    found: dict[str, Any] = {"title": document["title"]}
    for name, keys in document.items():
        if isinstance(keys, dict):
            rows = KEYS[name]
            found[name] = {
                key: _shortened(value, rows[key].kind.unit if key in rows else "")
                for key, value in keys.items()
                if key not in rows or value != rows[key].default
            }
    return {name: value for name, value in found.items() if value or name == "title"}


def _shortened(value: Any, unit: str) -> Any:
    """Return a number with four digits, and with a unit in which it has few; of a table, each."""
    if isinstance(value, dict):
        return {key: _shortened(each, "") for key, each in value.items()}
    if not isinstance(value, float):
        return value
    for name in _NATURAL.get(unit, ()):
        if _LEAST <= (size := value / parse(f"1{name}", unit)) < _MOST:
            return f"{size:.4g}{name}"
    return float(f"{value:.4g}")


def _in_few_lines(text: str, separations: Sequence[float]) -> str:
    """TOML text with its short lists on one line each, and even separations as a range."""

    def short(found: re.Match[str]) -> str:
        line = re.sub(r",? *\n *(?=\])|(?<=\[)\n *", "", found[0])
        line = re.sub(r" *\n *", " ", line)
        return line if len(line) <= 110 else found[0]  # characters of a list in a scene

    start, stop, num = separations[0], separations[-1], len(separations)
    if num > 1 and evenly(start, stop, num) == tuple(separations):
        of_range = f"separations = {{start = {start!r}, stop = {stop!r}, num = {num}}}"
        text = re.sub(r"^separations = \[[^\]]*\]", of_range, text, flags=re.MULTILINE)
    return re.sub(r"^\w+ = \[\n(?: .*\n)*\]", short, text, flags=re.MULTILINE)

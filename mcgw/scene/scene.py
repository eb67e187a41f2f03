"""What is asked: surface, grading, contact and ensemble, checked before anything is computed.

A scene with nothing left open: numbers in place of functions, and the sampler that drew it.
"""

import dataclasses
from collections.abc import Mapping
from copy import copy
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from analytic import MeasuredRadii, extent, is_data, resolved
from analytic.arrays import hold
from analytic.laws import ContactLaw, Layer
from mcgw.formats.sheet import Sheet, Shown
from mcgw.scene.fields import Fields, LeftOut
from mcgw.scene.in_words import sheet_of
from mcgw.scene.keys import SURFACE_UNITS
from mcgw.scene.mistakes import mistakes
from mcgw.scene.plausible import perhaps_other_units, takes_hours, warn_of_units
from mcgw.scene.promises import promise_of
from mcgw.scene.reading import of_arguments
from mcgw.scene.section import SceneError, nearest
from mcgw.scene.surface import Surface as GivenSurface
from mcgw.scene.values import documented, values_of_scene

if TYPE_CHECKING:
    from mcgw.validity.model_error import Validity

_SURFACES, _MOST_SURFACES = 1000, 10**9  # where n_surfaces is left out; where rel_err is to decide
_LOOKED_AT, _BEYOND = 4001, 1.1  # heights for the stiffest; and how much farther series reach
_FARTHEST = 1e12  # penetrations over the first one, which few formulas are meant for

AnyScene = TypeVar("AnyScene", bound=Fields)


@documented
@values_of_scene
class Scene(Fields, Shown):
    """Everything that determines an ensemble.

    Parameters
    ----------
    surface : Surface or Spectral
        A `mcgw.Surface`, or a `mcgw.SpectralSurface`, which also determines the heights of the summits.
    separations : array_like
        Reduced separations d/sigma, in any order, repeated or not: an array, a list, or one number.
    datum : {"summits", "surface"}, optional
        Mean plane from which `separations` are measured; the scene converts them to that of the summits.
    title : str, optional
        Title of figures and reports.
    grading : Grading or callable, optional
        E*(s)/E*, or any function of an array of heights s, such as ``lambda s: 1 + 0.3*np.tanh(s)``; the
        program finds its kinks and jumps, or `mcgw.Custom` declares them. Default: homogeneous.
    negative : {"error", "clip", "allow"}, optional
        What to do if the grading makes the modulus of a contacting asperity negative.
    heights : HeightLaw or frozen distribution of scipy.stats, optional
        Distribution of the reduced heights; mean and scale of a SciPy distribution have no effect.
        Default: Gaussian.
    curvature : {"random", "mean"}, RandomCurvature or MeasuredRadii, optional
        Whether each summit of an isotropic Gaussian surface has its own radius, which needs the heights
        of `mcgw.Nayak`. Default: "random" for a surface given by its spectrum, otherwise "mean". Or
        measured radii, which come with their measured heights.
    law : ContactLaw or dict, optional
        Contact law of an asperity, such as `mcgw.KogutEtsion(hardness=1.2e9)`; or its keys in a scene
        file, ``{"law": "kogut-etsion", "hardness": "1.2 GPa"}``. Default: Hertz's.
    unload_from : float or "loop", optional
        Smallest separation reached before unloading, d/sigma; "loop": the smallest of `separations`.
        Every quantity then also has an unloading branch, such as ``load_unloading``.
    film : Film, optional
        Resistivity of the bodies, and resistance of a film on the spots: `mcgw.Film`. Adds the quantity
        "conductance_si". Default: none.
    layer : Layer, optional
        Layer of any thickness on the first body: `mcgw.Layer`; becomes a part of `film`.
    interaction : Interaction, {"body", "mean-plane"} or dict, optional
        Asperity interaction: `mcgw.Interaction`, its reference alone, or its keys in a scene file. Adds
        "nominal_separation", and puts stiffness and conductance in series with
        the half-space. Default: asperities are independent.
    joint : Joint, str or dict, optional
        Gas in the gap of a thermal joint: `mcgw.Joint`, its gas alone, or its keys in a scene file; needs
        the conductivities of a `film`. Adds "gap_conductance" and "joint_conductance", W/(m^2 K).
        Default: spots only, as in vacuum.
    quantities : sequence of str, optional
        Quantities to compute: names of `analytic.QUANTITIES` and `analytic.LAW_QUANTITIES`. Default: load,
        area, stiffness, contacts.
    fitted : Fitted or dict, optional
        Properties of the fitted map, from `mcgw.fitted_scene`; or its keys in a scene file.
        It does not affect results: `validity` uses it to state the error of the model.

    Raises
    ------
    SceneError
        With one line for each mistake, as for a scene file.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
    >>> mcgw.Scene(surface, separations=[0, 2, 4], grading=mcgw.Exponential(2.0), seed=1)
    Scene
      surface      sigma = 1.37e-06 m, radius = 1.3e-05 m, eta = 3e+08 1/m^2
                   nominal_area = 0.0001 m^2, E_star = 7.86e+10 Pa
      grading      Exponential(gamma=2.0)
      heights      Gaussian()
      separations  3 from 0 to 4 (d/sigma)
      quantities   load, area, stiffness, contacts
      ensemble     1000 surfaces of 30000 asperities (fixed), seed 1, sampler auto
    """

    def __post_init__(self, datum: str | None, layer: Layer | None) -> None:
        """Arguments are read by their names, as files by keys."""
        self._made_of(of_arguments(**vars(self), datum=datum, layer=layer))

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> "Scene":
        """Return the scene of values that were read, checked as any other."""
        scene = object.__new__(cls)
        scene._made_of(values)
        return scene

    def _made_of(self, values: Mapping[str, Any]) -> None:
        """Give what was left out its value, and refuse values that do not go together."""
        hold(self, **values)
        listed = self.curvature if self.as_measured and isinstance(self.curvature, MeasuredRadii) else None
        number = len(listed.ratios) if listed else round(min(self.surface.n_asperities, 2.0**62))
        most = _SURFACES if self.rel_err is None else _MOST_SURFACES
        for key, value in (("n_asperities", number), ("n_surfaces", 1 if listed else most)):
            if isinstance(getattr(self, key), LeftOut):  # now, or in the scene that this one was made of
                hold(self, **{key: LeftOut(value)})
        if problems := mistakes(self):
            raise SceneError(problems)
        if not (self.law.is_data and is_data(self.grading)):
            in_numbers(self)  # a function that no series resolves is a mistake as well
        warn_of_units([*perhaps_other_units(self), *takes_hours(self)])

    def replace(self, **changes: Any) -> "Scene":
        """Return the scene with other values; fields that were left out follow from them.

        Parameters
        ----------
        **changes
            Fields of the scene or of its surface, each as `Scene` and `mcgw.Surface` take it; None leaves
            a field out.

        Returns
        -------
        Scene
            Checked anew.

        Raises
        ------
        TypeError
            If there is no such field.
        SceneError
            If a value is wrong.

        Examples
        --------
        >>> import mcgw
        >>> surface = mcgw.Surface("1 um", "10 um", "300/mm^2", "1 cm^2", "80 GPa")
        >>> scene = mcgw.Scene(surface, separations=1.0)
        >>> scene.n_asperities, scene.replace(nominal_area="10 cm^2").n_asperities
        (30000, 300000)
        """
        fields = (*(each.name for each in dataclasses.fields(self)), *SURFACE_UNITS)
        for key in changes:
            if key not in fields:
                meant = nearest(key, fields).rstrip() or f"it has {', '.join(fields)}"
                raise TypeError(f"a scene has no {key!r}; {meant}")
        of_surface = {key: changes.pop(key) for key in SURFACE_UNITS if key in changes}
        if of_surface:
            surface = changes.get("surface", self.surface)
            changes["surface"] = GivenSurface(**{x: getattr(surface, x) for x in SURFACE_UNITS} | of_surface)
        return dataclasses.replace(self, **changes) if changes else self

    def with_surfaces(self, n: int) -> "Scene":
        """Return the scene with another number of surfaces, on which nothing else hangs: not checked anew."""
        scene = copy(self)
        hold(scene, n_surfaces=n)
        return scene

    def sheet(self) -> Sheet:
        """Return the scene as shown to people."""
        return sheet_of(self)

    def validity(self, separations: ArrayLike | None = None) -> "Validity":
        """Return the expected error of this model against elasticity, for area, gap, stiffness and load.

        Parameters
        ----------
        separations : array_like, optional
            Reduced separations, d/sigma. Default: those of the scene, or 64 of them.

        Returns
        -------
        Validity
            Errors against boundary elements, with where they were measured; nan where they were not.

        Examples
        --------
        >>> import mcgw
        >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
        >>> bool(mcgw.Scene(surface, separations=[0.0, 1.0]).validity().error["area"][0] < 0.1)
        True
        """
        from mcgw.validity.lookup import validity_of  # reads a table, which not every scene needs

        return validity_of(self, separations)


def storable(scene: AnyScene) -> AnyScene:
    """The scene with its grading and contact law resolved, unless a file holds them as they are.

    All samplers draw with this one, so that in memory, in a file, and resumed from there, a scene has
    the same bits. A Python function becomes an `analytic.PiecewiseSeries` over all heights that count.

    Raises
    ------
    SceneError
        If the grading cannot be resolved, as one that is noisy.
    """
    if scene.law.is_data and is_data(scene.grading):
        return scene
    return _in_other_words(scene, **in_numbers(scene))


def _in_other_words(scene: AnyScene, **changes: Any) -> AnyScene:
    """The scene with values that say the same: not checked anew, which may take as long as drawing it."""
    same = object.__new__(type(scene))
    hold(same, **{each.name: getattr(scene, each.name) for each in dataclasses.fields(scene)} | changes)
    return same


def in_numbers(scene: Fields) -> dict[str, Any]:
    """What of a scene a file does not hold as it is, resolved; raises as `storable`."""
    changes: dict[str, Any] = {} if scene.law.is_data else {"law": _resolved_law(scene)}
    if is_data(scene.grading):
        return changes
    try:
        return changes | {"grading": resolved(scene.grading, *_extent(scene))}
    except ValueError as error:
        raise SceneError([str(error)]) from None


def _extent(scene: Fields) -> tuple[float, float]:
    """Lowest and highest height that count; asperities may have felt lower separations than those asked."""
    asked = scene.separations
    if scene.lowest < min(asked):
        asked = (*asked, scene.lowest)
    low, high = extent(scene.grading, scene.heights, asked)
    return low, high


def _resolved_law(scene: Fields) -> ContactLaw:
    """The series of a law up to the deepest penetration of the stiffest asperity."""
    low, high = _extent(scene)
    deepest = high - min(scene.lowest, low if scene.unload_from is None else scene.unload_from)
    s = np.linspace(low, high, _LOOKED_AT)
    stiff = np.abs(scene.modulus(s))
    stiffest, where = float(stiff.max()), float(s[stiff.argmax()])
    with np.errstate(over="ignore"):
        farthest = _BEYOND * deepest * np.square(stiffest)  # penetration over that of a modulus of 1
    try:
        if np.isinf(farthest):
            raise ValueError("no series reaches that far")
        return scene.law.as_data(float(farthest))
    except ValueError as error:
        reason = str(error)
        if farthest > _FARTHEST:
            reason = (
                f"E*(s)/E* reaches {stiffest:.3g} at s = {where:.4g}, where no series of the law is accurate"
                "; give a grading that is less steep, or a law of the package"
            )
        raise SceneError([f"contact.law = {type(scene.law).__name__}: {reason}"]) from None


def drawn_by(scene: AnyScene, sampler: str) -> AnyScene:
    """The scene that says by which sampler it was drawn, where it left the choice to ``auto``."""
    if sampler != scene.sampler and scene.accuracy and promise_of(sampler).spends:
        return scene  # its crowds follow from what may be spent
    return scene if sampler == scene.sampler else _in_other_words(scene, sampler=sampler)

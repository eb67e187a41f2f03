"""What is asked: surface, grading, contact and ensemble, checked before anything is computed.

A scene with nothing left open: numbers in place of functions, and the sampler that drew it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from copy import copy
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.random import Generator, SeedSequence
from numpy.typing import ArrayLike

from analytic import Exponential, Grading, Homogeneous, Interaction, MeasuredRadii, RandomCurvature, Surface
from analytic.laws import ContactLaw
from analytic.quadrature import extent
from analytic.resolution import resolved
from mcgw.formats.table import Shown, Table
from mcgw.scene.contact import Contact, Joint, interaction_mistakes, law_mistakes
from mcgw.scene.ensemble import Sampling, promise_of
from mcgw.scene.fields import Fields, LeftOut
from mcgw.scene.laws import LAWS, Graded
from mcgw.scene.measured import MOMENTS, Fitted
from mcgw.scene.reading import of_arguments
from mcgw.scene.section import SceneError
from mcgw.scene.surface import (
    Spectral,
    perhaps_other_units,
    scale_mistakes,
    surface_in_other_units,
    warn_of_units,
)
from mcgw.scene.writing import sheet_of

if TYPE_CHECKING:
    from mcgw.validity.model_error import Validity

_SURFACES, _MOST_SURFACES = 1000, 10**9  # where n_surfaces is left out; where rel_err is to decide
_LOOKED_AT, _BEYOND = 4001, 1.1  # heights for the stiffest; and how much farther series reach
_VAST = 1e200  # a modulus, over E*, of which sums over a usual surface may overflow
_FARTHEST = 1e12  # penetrations over the first one, which few formulas are meant for


@dataclasses.dataclass(frozen=True, init=False, repr=False)
class Scene(Fields, Shown):
    """Everything that determines an ensemble.

    Parameters
    ----------
    surface : Surface or Spectral
        A `mcgw.Surface`, or a `mcgw.SpectralSurface`, which also determines the heights of the summits.
    separations : array_like
        Reduced separations d/sigma, in any order, repeated or not: an array, a list, or one number.
    title : str, optional
        Title of figures and reports.
    grading : Grading, callable or Graded, optional
        E*(s)/E*, or any function of an array of heights s, such as ``lambda s: 1 + 0.3*np.tanh(s)``; the
        program finds its kinks and jumps, or `mcgw.Custom` declares them. `mcgw.Graded` also says what to
        do where it is negative. Default: homogeneous.
    heights : HeightLaw or frozen distribution of scipy.stats, optional
        Distribution of the reduced heights; mean and scale of a SciPy distribution have no effect.
        Default: Gaussian.
    contact : Contact or dict, optional
        Law of the contacts, quantities to compute, and unloading: `mcgw.Contact`.
    summits : {"random", "mean"}, RandomCurvature or MeasuredRadii, optional
        Whether each summit of an isotropic Gaussian surface has its own radius, which needs the heights
        of `mcgw.Nayak`. Default: "random" for a surface given by its spectrum, otherwise "mean". Or
        measured radii, which come with their measured heights.
    interaction : Interaction, {"body", "mean-plane"} or dict, optional
        Asperity interaction: `mcgw.Interaction`, or its reference alone. Adds "nominal_separation", and
        puts stiffness and conductance in series with the half-space. Default: asperities are independent.
    joint : Joint or dict, optional
        Conduction through the bodies, a film or layer, and gas: `mcgw.Joint`.
    ensemble : Sampling or dict, optional
        How many surfaces, of how many asperities, and how they are drawn: `mcgw.Sampling`.
    fitted : Fitted or dict, optional
        Properties of the fitted map, from `mcgw.fitted_scene`. It does not affect results: `validity` uses
        it to state the error of the model.
    law : ContactLaw, str or dict, optional
        That of `contact`, alone.
    n_surfaces : int, optional
        That of `ensemble`, alone: number of surfaces. Default: 1000.
    seed : int, Generator or SeedSequence, optional
        That of `ensemble`, alone. Default: a random one, which is recorded.

    Raises
    ------
    SceneError
        With one line for each mistake, as for a scene file, whose keys are those of the parts.

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

    def __init__(
        self,
        surface: Surface | Spectral,
        *,
        separations: ArrayLike,
        title: str = "",
        grading: Grading | Callable[[Any], Any] | Graded | None = None,
        heights: Any = None,
        contact: Contact | Mapping[str, Any] | None = None,
        summits: RandomCurvature | MeasuredRadii | Literal["random", "mean"] | None = None,
        interaction: Interaction | str | Mapping[str, Any] | None = None,
        joint: Joint | Mapping[str, Any] | None = None,
        ensemble: Sampling | Mapping[str, Any] | None = None,
        fitted: Fitted | Mapping[str, Any] | None = None,
        law: ContactLaw | str | Mapping[str, Any] | None = None,
        n_surfaces: int | None = None,
        seed: int | Generator | SeedSequence | None = None,
    ) -> None:
        given = {key: x for key, x in locals().items() if key != "self" and x is not None}
        vars(self).update(vars(Scene.of(of_arguments(given))))

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Scene:
        """Return the scene of values that were read; refuse those that do not go together."""
        scene = object.__new__(cls)
        vars(scene).update(values)
        summits = scene.summits
        listed = summits if isinstance(summits, MeasuredRadii) and scene.as_measured else None
        number = len(listed.ratios) if listed else round(min(scene.surface.n_asperities, 2.0**62))
        most = _SURFACES if scene.rel_err is None else _MOST_SURFACES
        for key, value in (("n_asperities", number), ("n_surfaces", 1 if listed else most)):
            if isinstance(getattr(scene, key), LeftOut):  # now, or in the scene that this one was made of
                vars(scene.ensemble)[key] = LeftOut(value)
        _refuse_mistakes(scene)
        storable(scene)  # a function that no series resolves is a mistake as well
        warn_of_units([*perhaps_other_units(scene), *scene.ensemble.cautions(scene)])
        return scene

    def replace(self, **changes: Any) -> Scene:
        """Return the scene with other values; numbers that were left out follow from them.

        Parameters
        ----------
        **changes
            Parameters of the scene, or fields of its surface and parts by their own names, each as
            `mcgw.Surface`, `Scene` and its parts take it; None leaves a field out.

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
        >>> scene.n_asperities, scene.replace(nominal_area="10 cm^2", count="poisson").n_asperities
        (30000, 300000)
        """
        parts = {each.name: getattr(self, each.name) for each in dataclasses.fields(self)}
        if isinstance(changes.get("grading"), Graded | Mapping):
            del parts["negative"]
        surface = changes.get("surface")
        if isinstance(surface, Spectral) or (isinstance(surface, Mapping) and surface.keys() & set(MOMENTS)):
            del parts["heights"], parts["summits"]  # they follow from the moments
        return Scene.of(of_arguments(parts | changes)) if changes else self

    def drawn_by(self, sampler: str) -> Scene:
        """Return the scene that says by which sampler it was drawn, where it left the choice to ``auto``."""
        if self.accuracy and not promise_of(sampler).one_by_one:
            return self  # its crowds follow from what may be spent
        return with_sampling(self, sampler=sampler)

    def sheet(self) -> Table:
        """Return the scene as shown to people."""
        return sheet_of(self)

    def validity(self, separations: ArrayLike | None = None) -> Validity:
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


def _refuse_mistakes(scene: Scene) -> None:
    """Ask its parts, later ones only where the earlier ones find nothing."""
    usual = not surface_in_other_units(scene.surface)  # next to which no product leaves double precision
    checks = [] if usual else [scale_mistakes]
    if not scene.hertzian:
        checks.append(law_mistakes)
    if scene.joint.gas is not None:
        checks.append(scene.joint.mistakes)
    if scene.interaction is not None:
        checks.append(interaction_mistakes)
    grading, fine = scene.grading, isinstance(scene.grading, Homogeneous)
    if usual and type(grading) is Exponential and grading.smooth:
        fine = all(0 <= end < _VAST for end in grading.ends(scene.lowest))
    if scene.law.name == "custom" or not fine:
        from mcgw.scene.moduli import modulus_mistakes  # for those scenes alone

        checks.append(modulus_mistakes)
    found = [*scene.contact.mistakes(scene), *scene.ensemble.mistakes(scene)]
    for check in checks:
        found = found or list(check(scene))
    if found:
        raise SceneError(found)


def with_sampling(scene: Scene, **changes: Any) -> Scene:
    """Return the scene drawn in another way, on which nothing else hangs: not checked anew."""
    scene = copy(scene)
    vars(scene)["ensemble"] = dataclasses.replace(scene.ensemble, **changes)
    return scene


def storable(scene: Scene) -> Scene:
    """Return the scene with its grading and contact law resolved, unless a file holds them as they are.

    All samplers draw with this one, so that in memory, in a file, and resumed from there, a scene has
    the same bits. A Python function becomes an `analytic.PiecewiseSeries` over all heights that count; raises
    SceneError if it cannot be resolved, as one that is noisy.
    """
    is_data = type(scene.grading) in LAWS["grading"].values()  # a class made of one may do more
    if scene.law.is_data and is_data:
        return scene
    # Asperities may have felt lower separations than those asked.
    low, high = extent(scene.grading, scene.heights, (*scene.separations, scene.lowest))
    high = max(high, scene.highest)  # as `moduli` asks of series
    parts = {each.name: getattr(scene, each.name) for each in dataclasses.fields(scene)}
    if not scene.law.is_data:
        parts["contact"] = dataclasses.replace(scene.contact, law=_resolved_law(scene, low, high))
    if not is_data:
        try:
            parts["grading"] = resolved(scene.grading, low, high)
        except ValueError as error:
            raise SceneError([str(error)]) from None
    same = object.__new__(Scene)  # not checked anew, which may take long
    vars(same).update(parts)
    return same


def _resolved_law(scene: Scene, low: float, high: float) -> ContactLaw:
    """Return the series of a law up to the deepest penetration of the stiffest asperity."""
    s = np.linspace(low, high, _LOOKED_AT)
    stiff = np.abs(scene.modulus(s))
    where, stiffest = s[stiff.argmax()], stiff.max()
    with np.errstate(over="ignore"):  # penetration over that of a modulus of 1
        farthest = float(_BEYOND * (high - min(scene.lowest, low)) * np.square(stiffest))
    try:
        if np.isinf(farthest):
            raise ValueError("no series reaches that far")
        return scene.law.as_data(farthest)  # type: ignore[attr-defined,no-any-return]
    except ValueError as error:
        steep = (
            f"E*(s)/E* reaches {stiffest:.3g} at s = {where:.4g}, where no series of the law is accurate; "
            "give a grading that is less steep, or a law of the package"
        )
        reason = steep if farthest > _FARTHEST else error
        raise SceneError([f"contact.law = {type(scene.law).__name__}: {reason}"]) from None

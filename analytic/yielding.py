"""Whether asperities stay elastic: first yield, by hardness, of contacts that an elastic law describes.

A contact yields where its greatest pressure reaches K H, at ``delta_c = (pi K H/(2 E*))^2 R`` with
``K = 0.454 + 0.41 nu``. Source: L. Kogut, I. Etsion, J. Appl. Mech. 69 (2002) 657, with K as W. R. Chang,
I. Etsion, D. B. Bogy, J. Tribol. 110 (1988) 50 give it [mem: K recalled].
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.interacting import InteractingModel
from analytic.laws.elastic_plastic_laws import KogutEtsion
from analytic.model import Model
from analytic.surface import Surface

POISSON = 0.3  # of the body that yields, where nobody gives it


def critical_penetration(surface: Surface, hardness: float, poisson: float = POISSON) -> float:
    """Return the penetration at which a summit of the surface yields, m.

    Parameters
    ----------
    surface : Surface
        With the radius R and the modulus E*.
    hardness : float
        H of the softer body, Pa.
    poisson : float, optional
        Its Poisson's ratio.

    Raises
    ------
    ValueError
        If a number is out of range.

    Examples
    --------
    >>> aluminium = Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=80e9)
    >>> round(critical_penetration(aluminium, 1.2e9, 0.33) * 1e9, 3)  # nm
    1.928
    """
    return KogutEtsion(hardness=hardness, poisson=poisson).reduced_on(surface) * surface.sigma


def summit_plasticity_index(surface: Surface, hardness: float, poisson: float = POISSON) -> float:
    """Return the plasticity index of the summits, ``psi = sqrt(sigma/delta_c)``.

    Below about 0.6 hardly any contact yields, above 1 most do, whatever the load.

    Parameters
    ----------
    surface, hardness, poisson
        As for `critical_penetration`.

    Notes
    -----
    Source: J. A. Greenwood, J. B. P. Williamson, Proc. R. Soc. Lond. A 295 (1966) 300, whose
    ``(E*/H) sqrt(sigma/R)`` is this times pi K/2, about 0.9; as here W. R. Chang, I. Etsion, D. B. Bogy,
    J. Tribol. 109 (1987) 257 [mem: recalled].

    Examples
    --------
    >>> steel = Surface(sigma=1e-7, radius=1e-4, eta=1e9, nominal_area=1e-6, E_star=110e9)
    >>> round(summit_plasticity_index(steel, 7e9), 3)
    0.548
    """
    return math.sqrt(surface.sigma / critical_penetration(surface, hardness, poisson))


def yielding_share(model: Model, h: ArrayLike, hardness: float, poisson: float = POISSON) -> Array:
    """Return the share of the contacts that are past first yield, in the shape of `h`.

    Parameters
    ----------
    model : Model
        The surface, under any law: a contact counts if its penetration exceeds that at which Hertz's contact
        of its own modulus E*(s) and radius yields.
    h : array_like
        Reduced separations; `Model.separation_at` finds that of a load.
    hardness, poisson
        As for `critical_penetration`.

    Returns
    -------
    ndarray
        From 0 to 1; nan where nothing touches.

    Examples
    --------
    >>> import analytic
    >>> surface = Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=80e9)
    >>> model = analytic.Model(surface, heights=analytic.ExponentialHeights())
    >>> float(yielding_share(model, 1.0, 1.2e9).round(6))  # exp(-delta_c/sigma)
    0.998153
    """
    law = KogutEtsion(hardness=hardness, poisson=poisson)
    if isinstance(model, InteractingModel):
        model = model.alone  # what asperities feel under their own law
    yielding = replace(model, law=law, unload_from=None, film=None)
    return np.asarray(1 - yielding.share(0, h))

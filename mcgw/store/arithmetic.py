"""On what the numbers of a scene depend besides the scene: versions, and for some the kind of processor.

Sums, products, quotients and roots are rounded alike by every processor, and the samplers, height laws and
gradings of this package are made of them. A distribution of scipy.stats, a function of the user, the powers
of contact laws and the generators behind ``direct`` call exponentials and logarithms of NumPy and of the C
library, whose last digits differ from one kind of processor to another. Then the kind is told by what these
give here.
"""

import hashlib
import math
from functools import cache

import numpy as np
from scipy import special

from analytic import (
    Clipped,
    Exponential,
    ExponentialHeights,
    Gaussian,
    HeightTable,
    Homogeneous,
    MeasuredHeights,
    PiecewiseSeries,
    Table,
)
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene
from mcgw.store.provenance import versions

__all__ = ["KIND", "depends_on_processor", "drawn_with", "kind_of_processor"]

KIND = ", processor "  # stands between the versions and the kind

_HEIGHTS = (Gaussian, ExponentialHeights, HeightTable, MeasuredHeights)
_GRADINGS = (Homogeneous, Exponential, Table, PiecewiseSeries)
_POINTS = 4096  # one value in a thousand differs between kinds


def depends_on_processor(scene: Scene, sampler: str) -> bool:
    """Whether the last digits of what a sampler draws may differ from one kind of processor to another."""
    modulus = scene.modulus
    if isinstance(modulus, Clipped) and isinstance(modulus.grading, Exponential | PiecewiseSeries):
        modulus = modulus.grading
    own = isinstance(scene.heights, _HEIGHTS) and isinstance(modulus, _GRADINGS)
    drawn_alike = promise_of(sampler).same_on_all_processors or scene.as_measured
    return not (own and drawn_alike and scene.hertzian)


@cache
def kind_of_processor() -> str:
    """Eight digits that are the same where NumPy, SciPy and the C library round alike."""
    x = (np.arange(_POINTS) + 0.5) / 64
    matrix = 1 / (1 + np.arange(20) + np.arange(20)[:, None])
    values = [
        *(f(x) for f in (np.exp, np.expm1, np.log, np.log1p, np.sin, np.tanh, special.ndtr, special.gammaln)),
        x**1.7,
        special.gammainc(2.5, x),
        matrix @ matrix,
        np.array([(math.exp(v), math.log(v), math.log1p(v), math.pow(v, 1.7)) for v in x.tolist()]),
    ]
    return hashlib.sha256(b"".join(np.ascontiguousarray(v).tobytes() for v in values)).hexdigest()[:8]


def drawn_with(scene: Scene, sampler: str) -> str:
    """Versions of the packages that draw and, where the numbers depend on it, the kind of processor."""
    known = versions(of_draws=True)
    return f"{known}{KIND}{kind_of_processor()}" if depends_on_processor(scene, sampler) else known

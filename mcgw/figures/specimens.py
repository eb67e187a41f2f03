"""Between which values most surfaces lie: by the exact law of each, without a draw."""

import numpy as np

from analytic import Hertz
from analytic.arrays import Array
from mcgw.scene.scene import Scene


def exact_ends(scene: Scene, name: str, share: float) -> Array | None:
    """Ends between which this share of all surfaces lies at each separation, shape (2, separations).

    None where no law is known, or where laws take a while: under others than Hertz's, with listed summits or
    with radii of their own.
    """
    if not isinstance(scene.law, Hertz) or scene.curvature is not None or scene.as_measured:
        return None
    try:
        laws = [scene.theory.distribution(name, h) for h in scene.separations]
        return np.array([law.interval(share) for law in laws]).T
    except (KeyError, ValueError):
        return None

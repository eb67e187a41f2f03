"""When an ensemble is large enough: decided from its own means and variances, at fixed numbers of surfaces.

The numbers at which one looks depend on nothing but the limit, and the sums are taken over groups of 64
surfaces in their order: so the number of surfaces drawn is the same for any block size and any number of
threads (unless time ends the run).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import norm
from scipy.stats import t as student

from mcgw.sampling.counts import GROUP
from mcgw.scene import Scene

__all__ = ["CONFIDENCE", "Decision", "Running", "checkpoints", "decide", "upper_contacts", "z_of"]

Array = NDArray[np.float64]

CONFIDENCE = 0.95
_STEP = 16  # the next look is at 17/16 of the surfaces there are: what is drawn too much is at most 6 %


@dataclass(frozen=True)
class Decision:
    """Whether to go on.

    Parameters
    ----------
    go_on : bool
        False: the ensemble is large enough, or as large as it may be.
    why : str
        The mean that is known least well, or why it is not waited for.
    """

    go_on: bool
    why: str


@dataclass(frozen=True)
class Running:
    """Means and squared deviations so far; rows of surfaces are taken in by groups, in their order.

    Parameters
    ----------
    n : int
        Surfaces taken in.
    mean, squares : ndarray
        Mean, and sum of the squared deviations from it, shape (quantities * separations,).
    rest : ndarray
        Rows that wait until their group is full.
    """

    n: int
    mean: Array
    squares: Array
    rest: Array

    @classmethod
    def empty(cls, columns: int) -> "Running":
        """Before the first surface."""
        return cls(0, np.zeros(columns), np.zeros(columns), np.empty((0, columns)))

    def add(self, scene: Scene, sums: Mapping[str, NDArray[Any]]) -> "Running":
        """Take in the next surfaces, each quantity of shape (surfaces, separations)."""
        new = np.concatenate([np.asarray(sums[name], dtype=np.float64) for name in scene.quantities], axis=1)
        rows = np.concatenate([self.rest, new])
        n, mean, squares = self.n, self.mean, self.squares
        full = len(rows) - len(rows) % GROUP
        for start in range(0, full, GROUP):
            group = rows[start : start + GROUP]
            own = group.mean(axis=0)
            shift = own - mean
            squares = squares + ((group - own) ** 2).sum(axis=0) + shift**2 * (n * GROUP / (n + GROUP))
            mean = mean + shift * (GROUP / (n + GROUP))
            n += GROUP
        return Running(n, mean, squares, rows[full:])


def checkpoints(limit: int) -> Iterator[int]:
    """Numbers of surfaces at which one looks: multiples of 64, the last one is `limit`."""
    n = GROUP
    while n < limit:
        yield n
        n += max(n // (_STEP * GROUP), 1) * GROUP
    yield limit


def decide(scene: Scene, running: Running) -> Decision:
    """Judge whether every mean is known as well as the scene asks for.

    A mean is known to ``rel_err`` if its 95 % interval reaches no farther than that share of it. A mean
    of zero is not. A separation that nothing has reached is waited for only while it could still be
    known in time: if at most ``3/n`` contacts a surface are to be expected, so many are not enough.

    Parameters
    ----------
    scene : Scene
        With `rel_err`; its `n_surfaces` is the limit.
    running : Running
        Of the surfaces so far.

    Returns
    -------
    Decision
        A pure function of both.
    """
    n, wanted = running.n, scene.rel_err
    if wanted is None or n < 2:
        return Decision(n < scene.n_surfaces, f"{n} surfaces")
    silent = running.mean == 0
    with np.errstate(divide="ignore", invalid="ignore"):
        half = student.ppf((1 + CONFIDENCE) / 2, n - 1) * np.sqrt(running.squares / (n - 1) / n)
        width = np.where(silent, 0.0, half / np.abs(running.mean))
    # Where all surfaces agree, all that is known is that one asperity in n N/3 may still differ.
    width = np.where((running.squares == 0) & ~silent, upper_contacts(n) / scene.n_asperities, width)
    worst = int(np.argmax(width))
    name, h = (
        scene.quantities[worst // len(scene.separations)],
        scene.separations[worst % len(scene.separations)],
    )
    why = f"{name} at d/sigma = {h:g} is known to {width[worst]:.2g} of itself"
    hopeless = upper_contacts(n) * scene.n_surfaces < (z_of() / wanted) ** 2
    waiting = bool(width[worst] > wanted) or bool(silent.any() and not hopeless)
    if n >= scene.n_surfaces:
        return Decision(False, f"{n} surfaces are the most allowed; {why}")
    if silent.all():
        why = f"no contact in {n} surfaces"
    return Decision(waiting, why)


def upper_contacts(n: int) -> float:
    """Upper limit (95 %) of the mean number of contacts a surface, if `n` surfaces had none: 3.0/n.

    Exact for a Poisson number of contacts, ``exp(-n limit) = 0.05``; for a fixed number of asperities it
    is the safe side by a share 1.5/(n N).
    """
    return float(-np.log(1 - CONFIDENCE) / n)


def z_of(level: float = CONFIDENCE) -> float:
    """Half-width of a two-sided interval of this level, in standard errors."""
    return float(norm.ppf((1 + level) / 2))

"""Points of a sweep that share their surfaces, and those of them whose sums must be computed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from mcgw.sampling.shared import on_common_cells, to_be_shared
from mcgw.scene.scene import Scene
from mcgw.sweeps.exponentials import between_two

__all__ = ["Group", "Mixture", "groups_of"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
_Item = TypeVar("_Item")


@dataclass(frozen=True)
class Mixture:
    """A point as a weighted mean of some that are computed.

    Parameters
    ----------
    scenes : ndarray of int
        Which of them.
    weights : ndarray
        Of what the modulus enters; anything else is the same for all of them.
    """

    scenes: Ints
    weights: Array

    def of(self, quantity: str) -> tuple[Ints, Array]:
        """For one quantity."""
        if len(self.scenes) == 1 or quantity_of(quantity).modulus:
            return self.scenes, self.weights
        return self.scenes[:1], np.ones(1)


@dataclass(frozen=True)
class Group:
    """Points that share their surfaces.

    Parameters
    ----------
    numbers : tuple of int
        Which points of the sweep.
    scenes : tuple of Scene
        Theirs, on common cells.
    computed : tuple of int
        Those whose sums are computed for every surface.
    mixtures : tuple of Mixture
        All points by these.
    """

    numbers: tuple[int, ...]
    scenes: tuple[Scene, ...]
    computed: tuple[int, ...]
    mixtures: tuple[Mixture, ...]


def groups_of(scenes: Sequence[Scene]) -> list[Group]:
    """Group the scenes of a sweep."""
    keys = [to_be_shared(scene) for scene in scenes]
    together = _alike(range(len(scenes)), lambda i: (i,) if keys[i] is None else keys[i])
    return [_group(members, [scenes[i] for i in members]) for members in together]


def _group(numbers: list[int], scenes: list[Scene]) -> Group:
    scenes = on_common_cells(scenes) if len(scenes) > 1 else scenes
    computed: list[int] = []
    mixtures: dict[int, Mixture] = {}
    for members in _alike(range(len(scenes)), lambda i: _but_grading(scenes[i])):
        first, one = len(computed), np.ones(1)
        if (found := between_two([scenes[i] for i in members])) is None:
            computed += members
            mixtures |= {i: Mixture(np.array([first + k]), one) for k, i in enumerate(members)}
            continue
        two, weights = found
        computed += [members[k] for k in two]
        mixtures |= {i: _mixture(first, pair) for i, pair in zip(members, weights, strict=True)}
    in_order = tuple(mixtures[i] for i in range(len(scenes)))
    return Group(tuple(numbers), tuple(scenes), tuple(computed), in_order)


def _mixture(first: int, weights: Array) -> Mixture:
    """Of two scenes, without one that does not count."""
    some = np.flatnonzero(weights)
    return Mixture(first + some, weights[some])


def _but_grading(scene: Scene) -> tuple[Any, ...]:
    return tuple(getattr(scene, f.name) for f in fields(scene) if f.name not in ("grading", "title"))


def _alike(items: Sequence[_Item], key: Callable[[_Item], Any]) -> list[list[_Item]]:
    """Items with equal keys together; keys need not have a hash."""
    keys: list[Any] = []
    found: list[list[_Item]] = []
    for item in items:
        this = key(item)
        at = next((i for i in range(len(keys) - 1, -1, -1) if keys[i] == this), None)
        if at is None:
            keys.append(this)
            found.append([item])
        else:
            found[at].append(item)
    return found

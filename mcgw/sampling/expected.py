"""What the sampler of a scene will have, and about how long it takes, before anything is compiled.

Cells are cut where their moments cost the least (`mcgw.sampling.spacing`), so both are known before any law
is resolved on a cell. Cells that a grading with kinks takes besides are not counted.
"""

from dataclasses import dataclass

import numpy as np

from analytic import MeasuredHeights, quantity_of
from analytic.arrays import Array, Ints
from mcgw.sampling.spacing import edges_before_grading, expected_orders, price
from mcgw.sampling.stretches import begins_and_breaks
from mcgw.scene.ensemble import PROMISES
from mcgw.scene.scene import Scene

# Seconds of one thread, within a factor of two on machines of the last years: of a surface, an asperity in a
# cell, a moment under Hertz's law and under others, one by one an asperity and a value of it under both, and
# of NumPy's generator.
_SURFACE, _INSIDE, _MOMENT, _OF_LAW = 2e-6, 1e-9, 1.1e-8, 2.5e-8
_ALONE, _VALUE, _VALUE_OF_LAW, _GENERATOR = 1.2e-7, 1.9e-9, 3.5e-8, 3e-4
_RADIUS, _DRAWS_WITH_RADIUS = 10, 6  # times an asperity with the radius of all


@dataclass(frozen=True)
class Expected:
    """What a surface takes."""

    name: str  # of the sampler
    cells: int  # about how many; 0 for samplers without cells
    moments: int  # alike
    draws: float  # numbers drawn
    seconds: float  # of one thread, within a factor of two or so


def name_of(scene: Scene) -> str:
    """Return the exact sampler that a scene asks for; `accuracy` may buy another one than ``cells``.

    For ``auto`` the first that fits: cells, unless most of them would be empty (`runs/bench/auto.py`).
    """
    if scene.sampler != "auto":
        return scene.sampler
    most = min(5 + len(scene.separations) / 20, 20)
    few = scene.touching < most
    names = ("tail", "cells", "direct") if few else ("cells", "tail", "direct")
    # Where two of these meet, each summit has breaks of its own.
    breaks = (scene.summits is not None) + (not scene.hertzian)
    listed = isinstance(scene.heights, MeasuredHeights)
    promises = ((name, PROMISES[name]) for name in names)
    return next(x for x, p in promises if (p.own_laws or breaks < 2) and not (p.needs_density and listed))


def expected(scene: Scene) -> Expected:
    """Return what the sampler of a scene is expected to have and to take."""
    name, touching = name_of(scene), float(scene.touching)
    if name in ("direct", "tail"):
        draws = float(scene.n_asperities) if name == "direct" else touching
        begin = _GENERATOR if name == "direct" else _SURFACE
        return Expected(name, 0, 0, draws, begin + _alone(scene, touching))
    return _in_cells(name, scene)


def _in_cells(name: str, scene: Scene) -> Expected:
    edges = edges_before_grading(scene, split=name == "cells")
    inside = scene.n_asperities * -np.diff(scene.heights.sf(edges)) if edges.size else np.empty(0)
    outside = max(scene.touching - float(inside.sum()), 0.0)
    plain, rooted = _orders(scene, edges)
    moments, own = int(plain.sum() + rooted.sum()) * _families(scene), scene.summits is not None
    draws = float(inside.sum()) * (_DRAWS_WITH_RADIUS if own else 1) * (moments > 0)
    seconds = _SURFACE + moments * (_MOMENT if scene.hertzian else _OF_LAW) + _alone(scene, outside)
    if name == "aggregate":
        draws = min(draws, float(moments))
    elif moments:
        seconds += float((inside * price(plain, rooted)).sum()) * _INSIDE * (_RADIUS if own else 1)
    return Expected(name, inside.size, moments, outside + draws, seconds)


def _orders(scene: Scene, edges: Array) -> tuple[Ints, Ints]:
    """Moments of each cell, for all quantities that have one power of the radius."""
    if not edges.size:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    begins = np.array(scene.all_separations)
    if not scene.hertzian:
        begins, _ = begins_and_breaks(scene, float(edges[0]), float(edges[-1]))
    return expected_orders(scene.heights, scene.n_asperities, begins, edges)


def _families(scene: Scene) -> int:
    """Powers of the radius by which moments are kept apart; 0 where contacts are only counted."""
    powers = {quantity_of(name).radius for name in scene.quantities if not quantity_of(name).counts}
    return len(powers) if scene.summits is not None else min(len(powers), 1)


def _alone(scene: Scene, asperities: float) -> float:
    """Seconds that asperities take which are drawn and added up one by one."""
    drawn = _ALONE * (1 if scene.summits is None else _RADIUS)
    return asperities * (drawn + scene.width * (_VALUE if scene.hertzian else _VALUE_OF_LAW))

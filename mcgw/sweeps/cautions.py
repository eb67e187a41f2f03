"""The cautions of all points of a sweep, each said once: of how many points."""

import re
from collections.abc import Iterator

from mcgw.scene.cautions import cautions
from mcgw.sweeps.sweep import Sweep

__all__ = ["sweep_cautions"]

_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def sweep_cautions(sweep: Sweep) -> list[str]:
    """What a reader should know of the scenes, a line each: the most common first.

    Cautions that differ in their numbers alone are one, with those of the first point that has it.
    """
    points = list(sweep.axes.points())
    found: dict[str, list[tuple[int, str]]] = {}
    for i in range(len(points)):
        for line in cautions(sweep.scenes[i]):
            found.setdefault(_NUMBER.sub("#", line), []).append((i, line))
    return list(_told(sweep, sorted(found.values(), key=len, reverse=True)))


def _told(sweep: Sweep, found: list[list[tuple[int, str]]]) -> Iterator[str]:
    points = list(sweep.axes.points())
    for some in found:
        first, line = some[0]
        alike = len({text for _, text in some}) == 1
        where = "" if alike else f" (numbers of {sweep.axes.text(points[first])})"
        yield f"{len({i for i, _ in some})} of {len(points)} points: {line}{where}"

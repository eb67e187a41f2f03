"""Python calls side by side in threads, for work that lasts less than a millisecond.

The caller does the first share itself. If it waited, the system would wake its helpers on the one core
that has just come free, one after the other, and move them to another core only milliseconds later.
"""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import chain
from typing import TypeVar

import numpy as np
from numba import get_num_threads

__all__ = ["in_threads"]

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")


def in_threads(call: Callable[[_Item], _Result], items: Sequence[_Item]) -> list[_Result]:
    """Call for every item, on as many threads as the compiled loops may use.

    Parameters
    ----------
    call : callable
        Lets go of Python's lock while it computes.
    items : sequence
        Shared out in runs of equal length.

    Returns
    -------
    list
        Results in the order of the items.
    """

    def run(places: Iterable[int]) -> list[_Result]:
        return [call(items[i]) for i in places]

    own, *others = np.array_split(np.arange(len(items)), min(get_num_threads(), max(len(items), 1)))
    if not others:
        return run(own)
    with ThreadPoolExecutor(len(others)) as pool:
        theirs = [pool.submit(run, places) for places in others]
        return list(chain(run(own), *(one.result() for one in theirs)))

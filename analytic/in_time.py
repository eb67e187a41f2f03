"""A call that is given up when it takes too long, whatever it is lost in."""

import sys
from collections.abc import Callable
from time import thread_time
from types import FrameType
from typing import Any, TypeVar

__all__ = ["in_time"]

T = TypeVar("T")


def in_time(seconds: float, call: Callable[[], T], problem: str) -> T:
    """Result of a call that takes no more than so many seconds of this thread's own CPU time.

    Looks at the clock at each Python function that the call enters. So it does not depend on what else
    the machine does, and works in any thread; only a single compiled function cannot be interrupted. No
    bound under a profiler.

    Parameters
    ----------
    seconds : float
        Bound.
    call : callable
        Takes no arguments.
    problem : str
        What to say if it takes longer.

    Returns
    -------
    object
        What the call returns.

    Raises
    ------
    ValueError
        With `problem`, if it takes longer.
    """
    if sys.getprofile() is not None:  # a profiler at work would be thrown out: whoever runs it sees the time
        return call()
    end = thread_time() + seconds

    def look(frame: FrameType, event: str, arg: Any) -> None:  # noqa: ARG001 - the interpreter's own form
        if thread_time() > end:
            raise ValueError(problem)

    sys.setprofile(look)
    try:
        return call()
    finally:
        sys.setprofile(None)

"""The keyword of the height law: ``heights=`` now, ``law=`` in versions 0.1 and 0.2."""

import warnings
from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, TypeVar

__all__ = ["takes_heights"]

P = ParamSpec("P")
R = TypeVar("R")


def takes_heights(function: Callable[P, R]) -> Callable[P, R]:
    """Let ``law=`` still pass as ``heights=``, with a DeprecationWarning."""

    @wraps(function)
    def with_old_name(*args: Any, **kwargs: Any) -> R:
        if "law" in kwargs:
            warnings.warn(
                f"{function.__name__}: the law of the heights is now heights=, not law=",
                DeprecationWarning,
                stacklevel=2,
            )
            law = kwargs.pop("law")
            if law is not None:
                kwargs["heights"] = law
        return function(*args, **kwargs)

    return with_old_name

"""Results kept for the next call with the same arguments, if these can never change."""

from collections.abc import Callable
from functools import lru_cache, wraps
from typing import Any, TypeVar

__all__ = ["kept"]

_Result = TypeVar("_Result")


def kept(most: int) -> Callable[[Callable[..., _Result]], Callable[..., _Result]]:
    """As `functools.lru_cache`, for numbers, bytes and frozen dataclasses; for others there is no memory.

    A height law of somebody's own may be any object, and may have changed since the last call.
    """

    def decorate(function: Callable[..., _Result]) -> Callable[..., _Result]:
        remembered = lru_cache(maxsize=most)(function)

        @wraps(function)
        def call(*arguments: Any) -> _Result:
            return (remembered if all(map(_never_changes, arguments)) else function)(*arguments)

        call.cache_clear = remembered.cache_clear  # type: ignore[attr-defined]
        return call

    return decorate


def _never_changes(argument: Any) -> bool:
    facts = getattr(type(argument), "__dataclass_params__", None)
    if not (facts.frozen if facts else isinstance(argument, int | float | bytes)):
        return False
    try:
        hash(argument)
    except TypeError:  # it holds an array
        return False
    return True

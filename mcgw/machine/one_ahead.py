"""An iterator that works on the next item while the last one is used."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import islice
from typing import TypeVar

__all__ = ["one_ahead"]

_Item = TypeVar("_Item")


def one_ahead(items: Iterator[_Item]) -> Iterator[_Item]:
    """The same items in the same order, each made by a thread of its own while the one before it is used.

    An error comes where its item would have come.
    """
    with ThreadPoolExecutor(1, thread_name_prefix="mcgw-ahead") as thread:
        coming = thread.submit(_next, items)
        while found := coming.result():
            coming = thread.submit(_next, items)
            yield from found


def _next(items: Iterator[_Item]) -> list[_Item]:
    """The next item in a list, which is empty at the end."""
    return list(islice(items, 1))

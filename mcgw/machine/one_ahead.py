"""An iterator that works on the next item while the last one is used."""

from collections.abc import Generator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from itertools import islice
from typing import TypeVar

__all__ = ["Items", "one_ahead"]

_Item = TypeVar("_Item")
Items = Generator[_Item, None, None]


def one_ahead(items: Items[_Item]) -> Items[_Item]:
    """The same items in the same order, each made by a thread of its own while the one before it is used.

    An error comes where its item would have come. What makes the items is closed together with this.
    """
    with closing(items), ThreadPoolExecutor(1, thread_name_prefix="mcgw-ahead") as thread:
        coming = thread.submit(_next, items)
        while found := coming.result():
            coming = thread.submit(_next, items)
            yield from found


def _next(items: Items[_Item]) -> list[_Item]:
    """The next item in a list, which is empty at the end."""
    return list(islice(items, 1))

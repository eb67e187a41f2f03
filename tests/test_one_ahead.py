"""The next item is made while the last one is used; order and errors are as without."""

import threading

import pytest

from mcgw.machine.one_ahead import one_ahead


def test_items_and_order_are_the_same():
    assert list(one_ahead(i for i in range(100))) == list(range(100))
    assert list(one_ahead(i for i in [])) == []
    assert list(one_ahead(i for i in [None, (), 0])) == [None, (), 0]


def test_the_next_one_is_made_meanwhile():
    """The second item is there although nobody asked for it: without, this would wait for ever."""
    made = threading.Event()

    def items():
        yield 1
        made.set()
        yield 2

    for _ in one_ahead(items()):
        assert made.wait(timeout=30)


def test_no_more_than_one_is_made_ahead():
    made = []
    ahead = one_ahead(made.append(i) or i for i in range(10))
    next(ahead)
    next(ahead)
    ahead.close()  # waits for the one in hand
    assert len(made) == 3


def test_an_error_comes_where_its_item_would_have():
    def items():
        yield 1
        raise OSError("gone")

    ahead = one_ahead(items())
    assert next(ahead) == 1
    with pytest.raises(OSError, match="gone"):
        next(ahead)


def test_what_makes_the_items_is_closed_with_it():
    ended = []

    def items():
        try:
            yield from range(10)
        finally:
            ended.append(True)

    ahead = one_ahead(items())
    next(ahead)
    ahead.close()
    assert ended

"""Docstrings of public functions and methods begin with a verb."""

import inspect
import re

import pytest

import analytic
import mcgw

VERBS = {
    "Clip", "Compare", "Convert", "Draw", "Find", "Fit", "Make", "Measure", "Merge", "Open", "Read", "Refuse",
    "Return", "Test", "Write",
}  # fmt: skip


def public():
    """Name and docstring of every public function, and of every public method that a public class defines."""
    for package in (mcgw, analytic):
        for name in getattr(package, "__all__", dir(package)):
            thing = getattr(package, name)
            if inspect.isfunction(thing):
                yield f"{package.__name__}.{name}", thing.__doc__
            elif inspect.isclass(thing):
                for method, function in vars(thing).items():
                    function = getattr(function, "__func__", function)
                    if inspect.isfunction(function) and not method.startswith("_"):
                        yield f"{package.__name__}.{name}.{method}", function.__doc__


def without_verb(found):
    return [name for name, doc in found if doc and re.match(r"\s*(\S*)", doc)[1] not in VERBS]


def test_they_begin_with_a_verb():
    found = dict(public())
    assert len(found) > 150
    assert without_verb(found.items()) == []


@pytest.mark.parametrize("doc", ["The load.", "As `mean`.", "``-t``.", "\n    Mean of a quantity."])
def test_others_would_be_seen(doc):
    assert without_verb([("x", doc)]) == ["x"]

"""How many functions the simplest scene enters, in how many files: fewer steps, and none that others need.

Counted after a first call, so that nothing is prepared for the first time; comprehensions are part of the
function that they stand in. A feature that another scene asks for adds nothing here; these numbers only fall.
"""

import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from oracles.inside import typeset

import mcgw

PACKAGES = [Path(mcgw.__file__).parent, Path(mcgw.__file__).parents[1] / "analytic"]
SURFACE = mcgw.Surface(sigma="1.37 um", radius="13 um", eta=3e8, nominal_area="1 cm^2", E_star="78.6 GPa")


def scene():
    """That of the README."""
    return mcgw.Scene(SURFACE, separations=np.linspace(0, 4, 41), grading=mcgw.Exponential(2.0), seed=1)


def entered(call):
    """Functions of the product that a call enters, by file and line."""
    found = set()

    def note(frame, event, _):
        code = frame.f_code
        if event == "call" and not code.co_name.startswith("<"):
            found.add((code.co_filename, code.co_firstlineno, code.co_name))

    before = sys.getprofile()
    threading.setprofile(note)
    sys.setprofile(note)
    try:
        call()
    finally:
        sys.setprofile(before)
        threading.setprofile(None)
    return {one for one in found if any(Path(one[0]).is_relative_to(folder) for folder in PACKAGES)}


@pytest.mark.parametrize(
    ("name", "functions", "files"),
    [("Scene", 40, 11), ("simulate", 96, 23), ("run", 143, 31), ("compare", 105, 21)],
)
def test_the_simplest_scene_takes_few_steps(name, functions, files, tmp_path):
    asked = scene()
    ensemble = mcgw.simulate(asked)
    calls = {
        "Scene": lambda _: scene(),
        "simulate": lambda _: mcgw.simulate(asked),
        "run": lambda path: mcgw.run(asked, path),
        "compare": lambda _: mcgw.compare(ensemble),
    }
    calls[name](tmp_path / "first.h5")
    found = entered(lambda: calls[name](tmp_path / "counted.h5"))
    assert len(found) <= functions
    assert len({file for file, *_ in found}) <= files


def test_steps_of_other_threads_are_counted_and_none_of_other_packages():
    def call():
        thread = threading.Thread(target=typeset, args=("",))
        thread.start()
        thread.join()

    assert {name for *_, name in entered(call)} == {"typeset"}

"""Benches (`runs/bench`): the history of their ratios, and the script that they are measured against."""

import importlib
import re
import sys
from datetime import date
from pathlib import Path

import numpy as np
import pytest

import analytic

FOLDER = Path(__file__).parents[2] / "runs" / "bench"
NAMES = sorted(path.stem for path in FOLDER.glob("*.py"))
HERE, ELSEWHERE = "this one (2 cores)", "another (64 cores)"


@pytest.fixture(scope="module")
def benches():
    """Every file of the folder, imported as `history.py` imports them."""
    before = set(sys.modules)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(FOLDER))
        yield {name: importlib.import_module(name) for name in NAMES}
    for name in set(NAMES) - before:
        del sys.modules[name]


def about(version, machine=HERE):
    return {"version": version, "date": "2025-11-22", "machine": machine}


def test_every_bench_with_ratios_is_in_the_history(benches):
    assert {name for name, module in benches.items() if hasattr(module, "ratios")} == set(
        benches["history"].BENCHES
    )


def test_the_history_is_one_line_for_a_version_and_a_machine(benches):
    records = benches["records"]
    lines = records.read(records.HISTORY)
    for line in lines:
        assert re.fullmatch(r"\d+\.\d+\.\d+", line["version"])
        assert re.search(r"\(\d+ cores\)$", line["machine"])
        assert date.fromisoformat(line["date"])
        assert all(0 < value < np.inf for value in records.last([line], None).values())
    assert len({(line["version"], line["machine"]) for line in lines}) == len(lines)


def test_lines_there_and_back(benches, tmp_path):
    records = benches["records"]
    path = tmp_path / "history.csv"
    lines = records.written(records.read(path), about("0.5.0"), {"x, 0.05 / y": 1 / 3})
    lines = records.written(lines, about("0.5.0", ELSEWHERE), {"x, 0.05 / y": 7.0})
    lines = records.written(lines, about("0.6.0"), {"z / y": 2.0})
    records.write(lines, path)
    assert len(path.read_text().splitlines()) == 4
    assert records.last(records.read(path), HERE) == {"x, 0.05 / y": 0.3333, "z / y": 2.0}
    assert records.last(records.read(path), ELSEWHERE) == {"x, 0.05 / y": 7.0}
    (line,) = records.written(lines[-1:], about("0.6.0"), {"z / y": 3.0})  # a version is one line
    assert records.last([line], HERE) == {"z / y": 3.0}


def test_the_script_answers_the_same_question(benches):
    """Means of 4000 surfaces against theory: 5 standard errors (false alarm 1e-5), and gamma = 2, not 1."""
    h, asperities, surfaces = (0.0, 1.0, 2.0), 100, 4000
    drawn = benches["scenes"].numpy_script(asperities, h, surfaces) / asperities
    mean, error = drawn.mean(axis=0), drawn.std(axis=0) / np.sqrt(surfaces)

    def off(grading):
        expected = [
            analytic.fn(1.5, h, grading),
            analytic.fn(1, h),
            analytic.fn(0.5, h, grading),
            analytic.fn(0, h),
        ]
        return np.abs((mean - np.stack(expected, axis=1)) / error).max()

    assert off(benches["scenes"].S1.grading) < 5
    assert off(None) > 20

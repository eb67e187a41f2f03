"""Files that go to SurfaceTopography: what it takes of memory, or crashes on, harms nobody."""

import numpy as np
import pytest

from mcgw.machine.memory import peak_growth
from mcgw.maps.map_files import read_map

STAND_IN = """
import os
from pathlib import Path
import numpy as np

class Channel:
    dim, unit, is_periodic, physical_sizes = 2, "um", False, (3.0, 1.0)

    def __init__(self, path, columns, rows):
        self.path, self.nb_grid_pts = path, (columns, rows)
        self.pixel_size = tuple(length / n for length, n in zip(self.physical_sizes, self.nb_grid_pts))
        self.default_channel = self

    def topography(self):
        self.path.with_name("read").touch()
        return self

    def heights(self):
        return np.arange(6.0).reshape(self.nb_grid_pts)

def open_topography(path):
    path = Path(path)
    words = path.read_text().split()
    if words[0] == "greedy":
        np.ones(2**28)
    if words[0] == "crash":
        os.abort()
    return Channel(path, int(words[0]), int(words[1]))
"""


@pytest.fixture
def foreign(tmp_path, monkeypatch):
    """A library that does what a file asks for."""
    (tmp_path / "SurfaceTopography.py").write_text(STAND_IN)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))

    def write(text):
        (tmp_path / "map.plu").write_text(text)
        return tmp_path / "map.plu"

    return write


def test_a_map_comes_back_as_it_was_read(foreign):
    found = read_map(foreign("3 2"))
    assert found.heights == pytest.approx(1e-6 * np.array([[0, 2, 4], [1, 3, 5]]))
    assert found.pixel == pytest.approx((1e-6, 0.5e-6))
    assert found.heights.flags["C_CONTIGUOUS"]


def test_what_a_file_cannot_hold_is_never_read(foreign, tmp_path):
    """Ten bytes that declare 1.2e9 points, and 8e6, which are a map's number, but not of ten bytes."""
    with pytest.raises(ValueError, match=r"40000 x 30000 points: more than the"):
        read_map(foreign("40000 30000"))
    with pytest.raises(ValueError, match=r"4000 x 2000 points: more than \d+ bytes hold of a map"):
        read_map(foreign("4000 2000"))
    assert not (tmp_path / "read").exists()


@pytest.mark.parametrize("word", ["0x10", "[nan]", "1.2e-\x00"])
def test_a_matrix_with_a_damaged_number_is_shown_to_no_other_program(word, foreign, tmp_path):
    """One may take it for something else; this one reads five heights, a height and a map of 3 x 2."""
    path = foreign(f"3 2 1 1 1\n1 2 {word} 3 3").rename(tmp_path / "map.txt")
    with pytest.raises(ValueError, match=r"map\.txt: line 2: could not convert string to float"):
        read_map(path)
    assert not (tmp_path / "read").exists()


@pytest.mark.parametrize(
    ("what", "told"),
    [("greedy", "may take 1024 MiB of memory, and it asks for more"), ("crash", "crashed with SIGABRT")],
)
def test_greed_and_crashes_are_one_line(what, told, foreign):
    def read():
        with pytest.raises(ValueError, match=told) as refused:
            read_map(foreign(what))
        assert len(str(refused.value).splitlines()) == 1

    assert not peak_growth(read) > 2**28

"""Files that go to SurfaceTopography: what it takes of memory, or crashes on, harms nobody."""

import os
import sys
import zipfile

import h5py
import numpy as np
import pytest
from oracles import surface_topography

from mcgw.maps import Topography, foreign as library, read_heights, read_map


@pytest.fixture
def foreign(tmp_path, monkeypatch):
    """A library that does what a file asks for."""
    monkeypatch.setitem(sys.modules, "SurfaceTopography", surface_topography)

    def write(text):
        (tmp_path / "map.plu").write_text(text)
        return tmp_path / "map.plu"

    return write


def test_a_map_without_a_pixel_takes_one_and_keeps_its_holes(foreign):
    """What it does not tell is given, or assumed; masked points and nan are missing."""
    path = foreign("bare 3 2")
    with pytest.raises(ValueError, match=r"map\.plu: does not give the size of a pixel; give --pixel"):
        read_map(path, unit="nm")
    found = read_map(path, pixel=(2e-6, 3e-6), unit="nm")
    expected = 1e-9 * np.array([[0, 2, np.nan], [np.nan, 3, 5]])
    assert found.heights == pytest.approx(expected, nan_ok=True, rel=1e-14)
    assert (found.pixel, found.periodic, found.assumed_unit) == ((2e-6, 3e-6), True, "")
    assert read_map(path, pixel=(1e3, 1e3)).assumed_unit == "m"
    with pytest.raises(ValueError, match=r"map\.plu: gives the size of a pixel; leave --pixel out"):
        read_map(foreign("3 2"), pixel=(1e-6, 1e-6))
    with pytest.raises(ValueError, match="heights are in um as the file says, not in nm"):
        read_map(foreign("3 2"), unit="nm")
    assert not read_map(foreign("3 2"), unit="um").periodic


def test_heights_along_a_line_are_a_profile_and_no_map(foreign):
    """The gap in them is filled along a straight line."""
    path = foreign("line 12 1")
    found = read_heights(path, unit="um")
    x = np.arange(12.0) / 2
    assert found.heights == pytest.approx(1e-6 * np.where(x == 2, (1.5**2 + 2.5**2) / 2, x * x), rel=1e-12)
    assert (found.spacing, found.filled) == (pytest.approx(0.5e-6), 1)
    with pytest.raises(ValueError, match="is a profile along a line; a map has rows and columns"):
        read_map(path)
    with pytest.raises(ValueError, match="gives x in um; leave --pixel out"):
        read_heights(path, pixel=(1e-6, 1e-6))
    assert isinstance(read_heights(foreign("3 2")), Topography)
    assert read_heights(foreign("unknown 12 1"), unit="um").spacing == pytest.approx(0.5e-6)


def test_what_the_library_refuses_is_one_line(foreign):
    for what, told in (
        ("silent", r"map\.plu: SurfaceTopography cannot read it: ValueError$"),
        ("greedy", r"map\.plu: needs more memory than there is$"),
        ("deep", r"SurfaceTopography cannot read it: maximum recursion depth exceeded"),
        ("current", r"map\.plu: holds no heights: its channels are I in nA$"),
    ):
        with pytest.raises(ValueError, match=told) as refused:
            read_map(foreign(what))
        assert len(str(refused.value).splitlines()) == 1
    path = foreign("silent")
    path.write_bytes(b"points 1,5\xff")
    with pytest.raises(ValueError, match=r"SurfaceTopography cannot read it: .*codec can't decode"):
        read_map(path)


def test_without_the_library_its_name_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(library, "find_spec", lambda name: None)
    for name in ("map.sdf", "map.x3p", "map.plu"):
        (tmp_path / name).write_bytes(b"bISO-1.0")
        with pytest.raises(
            ValueError, match=rf"{name}: \.\w+ is read by SurfaceTopography, which is not ins"
        ):
            read_map(tmp_path / name)


def test_what_our_readers_refuse_is_shown_to_the_library_where_it_says_its_pixel(foreign, tmp_path):
    """Of another format under an ending of ours; of two refusals both are told."""
    for name in ("map.h5", "map.sdf"):
        found = read_map(foreign("3 2").rename(tmp_path / name))
        assert found.heights == pytest.approx(1e-6 * np.array([[0, 2, 4], [1, 3, 5]]))
        assert found.pixel == pytest.approx((1e-6, 0.5e-6))
        assert found.heights.flags["C_CONTIGUOUS"]
    with pytest.raises(
        ValueError, match=r"map\.h5: is not a valid HDF5 file; SurfaceTopography cannot read it: Val"
    ):
        read_map(foreign("silent").rename(tmp_path / "map.h5"))
    with pytest.raises(ValueError, match=r"^\S*map\.dat: line 1: could not convert"):
        read_map(foreign("silent").rename(tmp_path / "map.dat"))
    path = foreign("bare 3 2").rename(tmp_path / "map.dat")
    for pixel in (None, (1e-6, 1e-6)):
        with pytest.raises(ValueError, match=r"^\S*map\.dat: line 1: could not convert"):
            read_map(path, pixel=pixel)


def test_three_columns_may_be_points_of_another_program(foreign, tmp_path):
    path = foreign("3 2 1\n1 2 x").rename(tmp_path / "map.txt")
    assert read_map(path).heights == pytest.approx(1e-6 * np.array([[0, 2, 4], [1, 3, 5]]))
    with pytest.raises(ValueError, match="gives the size of a pixel; leave --pixel out"):
        read_map(path, pixel=(1e-6, 1e-6))


def test_what_a_file_cannot_hold_is_never_read(foreign, tmp_path):
    """Ten bytes that declare 1.2e9 points, and 8e6, which are a map's number, but not of ten bytes."""
    with pytest.raises(ValueError, match=r"40000 x 30000 points: more than the"):
        read_map(foreign("40000 30000"))
    with pytest.raises(ValueError, match=r"4000 x 2000 points: more than \d+ bytes hold of a map"):
        read_map(foreign("4000 2000"))
    assert not (tmp_path / "read").exists()


def test_a_text_of_more_than_64_mebibytes_is_not_taken_in(foreign):
    path = foreign("3 2 " * 20)
    os.truncate(path, 2**26)
    assert read_map(path).heights.shape == (2, 3)
    os.truncate(path, 2**26 + 1)
    with pytest.raises(ValueError, match=r"map\.plu: a text longer than 67108864 bytes; save it as .npy"):
        read_map(path)


def test_hdf5_and_archives_of_others_pass_the_gate_first(foreign, tmp_path):
    with h5py.File(tmp_path / "m.nc", "w") as file:
        file["height"] = h5py.ExternalLink("other.h5", "height")
    with zipfile.ZipFile(tmp_path / "m.x3p", "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("data.bin", bytes(10**8))
    for name, told in (("m.nc", "a link to another file"), ("m.x3p", "unpacks to 100000000")):
        with pytest.raises(ValueError, match=told):
            read_map(tmp_path / name)


@pytest.mark.parametrize("word", ["0x10", "[nan]", "1.2e-\x00"])
def test_a_matrix_with_a_damaged_number_is_shown_to_no_other_program(word, foreign, tmp_path):
    """One may take it for something else; this one reads a map of 3 x 2."""
    path = foreign(f"3 2 1 1\n1 2 {word} 3").rename(tmp_path / "map.txt")
    with pytest.raises(ValueError, match=r"map\.txt: line 2: could not convert string to float"):
        read_map(path)
    assert not (tmp_path / "read").exists()

"""Files that SurfaceTopography reads: what they hold, and that what they ask for or crash on harms nobody."""

import os
import re
import struct
import sys
import zipfile

import h5py
import numpy as np
import pytest
from oracles import surface_topography

from mcgw.maps import Topography, read_heights, read_map

NM = np.array([[1, 2, 3, 4], [4, np.nan, 6, 7], [7, 8, 9, 10], [5, 3, 2, 0]])  # what each holds, nm
PIXEL = (1.5e-6, 4e-6)
# The code of a type of numbers, and its mark of a missing point.
SDF = {
    "<i2": (5, -(2**15)), "<f4": (3, np.finfo("f4").min), "<f8": (7, np.finfo("f8").min),
    "<u2": (1, 2**16 - 1),
}  # fmt: skip


def written(path, kind, nm):
    """SDF as ISO 25178-71 describes it, X3P by the library itself."""
    rows, columns = nm.shape
    if kind == "x3p":
        library = pytest.importorskip("SurfaceTopography")
        library.Topography(1e-9 * nm.T, (columns * PIXEL[0], rows * PIXEL[1]), unit="m").to_x3p(str(path))
    else:
        code, mark = SDF[kind]
        head = b"bISO-1.0", b"", b"", b"", columns, rows, *PIXEL, 1e-9, 0, 0, code, 0
        raw = np.where(np.isnan(nm), mark, nm).astype(kind).tobytes()
        path.write_bytes(struct.pack("<8s10s12s12sHHddddBBB", *head) + raw)
    return path


@pytest.mark.parametrize("kind", [*SDF, "x3p"])
@pytest.mark.filterwarnings("ignore")
def test_heights_pixel_and_missing_points(kind, tmp_path):
    """In single precision where the file has no more."""
    pytest.importorskip("SurfaceTopography")
    nm = np.nan_to_num(NM) if kind == "x3p" else NM
    found = read_map(written(tmp_path / f"map.{kind if kind in 'x3p' else 'sdf'}", kind, nm))
    assert found.heights == pytest.approx(1e-9 * nm, nan_ok=True, rel=1e-6)
    assert found.pixel == pytest.approx(PIXEL, rel=1e-9)
    assert (found.missing, found.assumed_unit) == (np.isnan(nm).sum(), "")


@pytest.mark.parametrize("kind", ["<f8", "x3p"])
@pytest.mark.parametrize("upright", [False, True])
@pytest.mark.filterwarnings("ignore")
def test_a_single_row_or_column_is_a_profile(kind, upright, tmp_path):
    pytest.importorskip("SurfaceTopography")
    nm = np.arange(20.0)[None] ** 2
    path = written(tmp_path / f"line.{'x3p' if kind == 'x3p' else 'sdf'}", kind, nm.T if upright else nm)
    found = read_heights(path)
    assert found.heights == pytest.approx(1e-9 * nm[0], rel=1e-6)
    assert (found.spacing, found.filled) == (pytest.approx(PIXEL[int(upright)], rel=1e-9), 0)


# --- a library that does what a file asks for -----------------------------------------------------------


@pytest.fixture
def foreign(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "SurfaceTopography", surface_topography)

    def write(text, name="map.plu"):
        (tmp_path / name).write_text(text)
        return tmp_path / name

    return write


def test_a_map_without_a_pixel_takes_one_and_keeps_its_holes(foreign):
    """What it does not tell is given, or assumed; masked points and nan are missing."""
    path = foreign("bare 3 2")
    found = read_map(path, pixel=(2e-6, 3e-6), unit="nm")
    expected = 1e-9 * np.array([[0, 2, np.nan], [np.nan, 3, 5]])
    assert found.heights == pytest.approx(expected, nan_ok=True, rel=1e-14)
    assert (found.pixel, found.periodic, found.assumed_unit) == ((2e-6, 3e-6), True, "")
    assert read_map(path, pixel=(1e3, 1e3)).assumed_unit == "m"
    assert not read_map(foreign("3 2"), unit="um").periodic


@pytest.mark.parametrize(
    ("name", "text"), [("map.h5", "3 2"), ("map.sdf", "3 2"), ("map.txt", "3 2 1\n1 2 x")]
)
def test_what_our_readers_refuse_is_shown_to_the_library(name, text, foreign):
    """Of another format under an ending of ours; three columns may be points of another program."""
    found = read_map(foreign(text, name))
    assert found.heights == pytest.approx(1e-6 * np.array([[0, 2, 4], [1, 3, 5]]))
    assert found.heights.flags["C_CONTIGUOUS"]
    assert found.pixel == pytest.approx((1e-6, 0.5e-6))


@pytest.mark.parametrize("kind", ["line", "unknown"])
def test_heights_along_a_line_are_a_profile(kind, foreign):
    """The gap in them is filled along a straight line."""
    found = read_heights(foreign(f"{kind} 12 1"), unit="um")
    x = np.arange(12.0) / 2
    assert found.heights == pytest.approx(1e-6 * np.where(x == 2, (1.5**2 + 2.5**2) / 2, x * x), rel=1e-12)
    assert (found.spacing, found.filled) == (pytest.approx(0.5e-6), 1)
    assert isinstance(read_heights(foreign("3 2")), Topography)


GIVEN = {"pixel": (1e-6, 1e-6)}
NO_NUMBER = r"^\S*map\.{}: line {}: could not convert string to float"
REFUSED = [
    ("map.plu", "bare 3 2", {}, r"map\.plu: does not give the size of a pixel; give --pixel"),
    ("map.plu", "3 2", GIVEN, r"map\.plu: gives the size of a pixel; leave --pixel out"),
    ("map.plu", "3 2", {"unit": "nm"}, "heights are in um as the file says, not in nm"),
    ("map.plu", "silent", {}, r"map\.plu: SurfaceTopography cannot read it: ValueError$"),
    ("map.plu", "greedy", {}, r"map\.plu: needs more memory than there is$"),
    ("map.plu", "deep", {}, "SurfaceTopography cannot read it: maximum recursion depth exceeded"),
    ("map.plu", "current", {}, r"map\.plu: holds no heights: its channels are I in nA$"),
    # ten bytes that declare 1.2e9 points, and 8e6, which are a map's number, but not of ten bytes
    ("map.plu", "40000 30000", {}, "40000 x 30000 points: more than the"),
    ("map.plu", "4000 2000", {}, r"4000 x 2000 points: more than \d+ bytes hold of a map"),
    ("map.h5", "silent", {}, r"map\.h5: is not a valid HDF5 file; SurfaceTopography cannot read it: Val"),
    ("map.dat", "silent", {}, NO_NUMBER.format("dat", 1)),
    # a matrix with a damaged number is shown to no other program: this one reads a map of 3 x 2
    ("map.txt", "3 2 1 1\n1 2 0x10 3", {}, NO_NUMBER.format("txt", 2)),
    ("map.txt", "3 2 1 1\n1 2 1.2e-\x00 3", {}, NO_NUMBER.format("txt", 2)),
    ("map.plu", "line 12 1", {}, "is a profile along a line; a map has rows and columns"),
    ("map.plu", "line 12 1", GIVEN, "gives x in um; leave --pixel out"),
]


@pytest.mark.parametrize(("name", "text", "given", "told"), REFUSED)
def test_what_is_refused_is_one_line(name, text, given, told, foreign, tmp_path):
    """Before its heights are read, where a file cannot hold so many, or has a damaged number."""
    with pytest.raises(ValueError, match=told) as refused:
        read_map(foreign(text, name), **given)
    assert "\n" not in str(refused.value)
    assert not (tmp_path / "read").exists() or not re.search("points: more|could not convert", told)


def test_without_the_library_its_name_is_told(tmp_path, missing):
    missing("SurfaceTopography")
    (tmp_path / "map.sdf").write_bytes(b"bISO-1.0")
    with pytest.raises(ValueError, match=r"map\.sdf: \.sdf is read by SurfaceTopography, which is not inst"):
        read_map(tmp_path / "map.sdf")


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
    with zipfile.ZipFile(tmp_path / "m.x3p", "w") as file:
        file.writestr("main.xml", "<!DOCTYPE a><a/>")
    for name, told in (("m.nc", "a link to another file"), ("m.x3p", "declares entities")):
        with pytest.raises(ValueError, match=told):
            read_map(tmp_path / name)

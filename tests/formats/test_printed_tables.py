"""Tables and sheets as such, small ones whose text was written by hand; and files as such."""

import os
import stat

import h5py
import numpy as np
import pytest
from oracles.inside import Column, Table, check_output, open_npy, opened, write_whole

LOAD = Column("load", [12.3456, 0.0, np.nan], unit="N", error=[0.0123, 0.5, 1.0])
HIGH = Column("high", [13.0, 2.5, np.nan], unit="N", form=".3g", between=" to ")
PLACE, KIND = Column("h", [0.5, 1.0, 20.0], "d/sigma"), Column("kind", ["a", "bc", ""])
SMALL = Table((PLACE, LOAD, HIGH, KIND), "Of loads")


def test_a_table_is_aligned_and_shows_each_number_to_its_error():
    """The first column and texts to the left; second digits of errors, but for 0 and where none is known."""
    assert SMALL.text().splitlines() == [
        "Of loads",
        "  d/sigma      load (N)  kind",
        "  0.5      12.346 to 13  a",
        "  1            0 to 2.5  bc",
        "  20                nan",
    ]
    assert repr(SMALL) == SMALL.text()
    plain = Column("x", [0.123456789, np.nan, 7.0, 7.0, 7.0], error=[0.0, 1.0, np.inf, np.nan, 20.0])
    assert plain.cells() == ["0.123457", "nan", "7", "7", "7"]
    signed = Column("x", [1.23456, -0.056789, 123.456], error=[0.01, 1e-9, 0.02])
    assert signed.cells() == ["1.235", "-0.056789", "123.456"]
    together = Table((Column("x", [1.0]), Column("e", [0.5], between=" +- ")))
    assert together.cells() == [["x", "1 +- 0.5"]]
    bare = Table((Column("share", [0.25], unit="1"), Column("area", [2.0], unit="m^2")))
    assert bare.text() == "  share  area (m^2)\n  0.25            2"


def test_a_table_of_a_page_has_the_cells_of_a_terminal_typeset():
    mixed = Table((
        Column("x", [1.5, np.nan], unit="m", form=".2g", missing="-9"),
        Column("e", [0.25, np.nan], unit="m", form=".2g", between=" +- "),
        Column("y", [3e-7, 1.0], unit="m", form="g"),
        Column("<z>", ["&", "m^2"])
    ))  # fmt: skip
    assert mixed.html() == (
        "<table><thead><tr><th>x (m)</th><th>y (m)</th><th>&lt;z&gt;</th></tr></thead><tbody>"
        "<tr><td>1.5 ± 0.25</td><td>3×10⁻⁷</td><td>&amp;</td></tr>"
        "<tr><td>−9</td><td>1</td><td>m²</td></tr></tbody></table>"
    )
    assert Table(()).html() == ""


def test_a_file_of_a_table_has_all_digits(tmp_path):
    kinds = Table((
        Column("i", [1, np.int64(-2)]), Column("t", ["a,b", "c"]),
        Column("x", [0.1, np.float64(1e-300)], unit="N"), Column("e", [1 / 3, 2.0], unit="1", between=" +- ")
    ))  # fmt: skip
    kinds.write(str(tmp_path / "t.csv"))
    lines = (tmp_path / "t.csv").read_bytes().decode().removesuffix("\n").split("\n")
    assert lines == ["i,t,x (N),e", f'1,"a,b",0.1,{1 / 3!r}', "-2,c,1e-300,2.0"]
    assert list(kinds.to_dataframe()["e"]) == [1 / 3, 2.0]


# --- files as such ------------------------------------------------------------------------------------------


def test_a_file_is_on_the_disk_before_its_name(tmp_path, monkeypatch):
    """Its contents, then the folder's names; everybody may read it, its owner alone may write."""
    flushed, fsync = [], os.fsync

    def noted(fd):
        flushed.append((os.fstat(fd).st_ino, (tmp_path / "a").exists()))
        fsync(fd)

    monkeypatch.setattr(os, "fsync", noted)
    before = os.umask(0)
    try:
        write_whole(tmp_path / "a", b"onetwo")
    finally:
        os.umask(before)
    made = (tmp_path / "a").stat()
    assert flushed == [(made.st_ino, False), (tmp_path.stat().st_ino, True)]
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"onetwo"]
    assert stat.S_IMODE(made.st_mode) == 0o644


def test_the_longest_name_can_be_written(tmp_path):
    """Bytes count."""
    longest = tmp_path / ("x" * 196 + ".csv")
    check_output(longest)
    write_whole(longest, b"1")
    for name in ("x" * 197 + ".csv", "é" * 100 + "x", "..", "a\x07.csv"):
        with pytest.raises(Exception, match="is not a valid file name"):
            check_output(tmp_path / name)


def test_a_disk_without_locks_is_read_without_one(monkeypatch):
    """And what is refused for another reason is not tried again."""
    asked, told = [], ["unable to lock file, errno = 37", "no such file"]

    def opens(path, mode, **more):
        asked.append(more)
        if not more:
            raise OSError(told[path])
        return "a file"

    monkeypatch.setattr(h5py, "File", opens)
    assert opened(0) == "a file"
    with pytest.raises(OSError, match="no such file"):
        opened(1)
    assert asked == [{}, {"locking": False}, {}]


def test_arrays_of_either_version_are_mapped(tmp_path):
    """As Python 2 wrote them too; not one that is cut short."""
    path, z = tmp_path / "a.npy", np.arange(6.0).reshape(2, 3)
    head = b"{'descr': '<f8', 'fortran_order': True, 'shape': (2L, 3L), }\n"
    path.write_bytes(b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head + z.T.tobytes())
    np.testing.assert_array_equal(open_npy(path), z)
    for version in ((1, 0), (2, 0), (3, 0)):
        with open(path, "wb") as file:
            np.lib.format.write_array(file, z, version=version)
        np.testing.assert_array_equal(open_npy(path), z)
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(ValueError, match="is not a valid"):
        open_npy(path)
    for other in (z > 1, z.astype(complex), z.astype(str)):
        np.save(path, other)
        with pytest.raises(ValueError, match="its values are not real numbers"):
            open_npy(path)

"""Tables and sheets as such, small ones whose text was written by hand; and files as such."""

import os
import stat

import h5py
import numpy as np
import pytest
from oracles.inside import (
    Column,
    Table,
    alive,
    check_output,
    digits_of,
    evenly,
    listed,
    open_npy,
    opened,
    parse,
    stacked,
    temporary_beside,
    typeset,
    write_whole,
)

LOAD = Column(
    "load", [12.3456, 0.0, np.nan], unit="N", error=[0.0123, 0.5, 1.0],
    beside=Column("high", [13.0, 2.5, np.nan], unit="N", form=".3g"), between=" to ",
)  # fmt: skip
SMALL = Table((Column("h", [0.5, 1.0, 20.0], "d/sigma"), LOAD, Column("kind", ["a", "bc", ""])), "Of loads")


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
    plain = Column("x", [0.123456789, np.nan, 7.0, 7.0, 7.0], error=[0.0, 1.0, np.inf, np.nan, 0.2])
    assert plain.cells() == ["0.123457", "nan", "7", "7", "7"]
    assert Column("x", [1.23456, 2.0], error=0.01).cells() == ["1.235", "2"]
    assert Column("x", [1.0], beside=Column("e", [0.5])).cells() == ["1 +- 0.5"]
    bare = Table((Column("share", [0.25], unit="1"), Column("area", [2.0], unit="m^2")))
    assert bare.text() == "  share  area (m^2)\n  0.25            2"
    assert (SMALL.unit, bare.unit, Table((Column("x", []),)).unit) == ("N", "1", "")
    assert [column.textual for column in (*SMALL.columns, Column("x", []))] == [False, False, True, False]


def test_numbers_of_a_page_are_typeset():
    assert typeset("gap/sigma 1e-05 x-1 -2 ... 3e+12") == "gap/σ 1×10⁻⁵ x-1 −2 … 3×10¹²"


def test_rows_and_columns_are_picked_from_a_table():
    assert evenly(20, 9).tolist() == [0, 2, 5, 7, 10, 12, 14, 17, 19]
    assert evenly(3, 9).tolist() == [0, 1, 2]
    long = Table((Column("n", list(range(20))),))
    assert long.rows().columns[0].values == evenly(20, 9).tolist()
    assert long.rows(2).columns[0].values == [0, 19]
    part = SMALL.at([1, 0]).only("kind", "load")
    assert part.text().splitlines() == [
        "Of loads",
        "  kind      load (N)",
        "  bc        0 to 2.5",
        "  a     12.346 to 13",
    ]
    assert [column.name for column in SMALL.flat] == ["h", "load", "high", "kind"]
    assert (len(SMALL), len(part), len(Table(()))) == (3, 2, 0)


def test_a_table_of_a_page_has_the_cells_of_a_terminal_typeset():
    assert SMALL.html() == (
        "<table><thead><tr><th>d/σ</th><th>load (N)</th><th>kind</th></tr></thead><tbody>"
        "<tr><td>0.5</td><td>12.346 to 13</td><td>a</td></tr>"
        "<tr><td>1</td><td>0 to 2.5</td><td>bc</td></tr>"
        "<tr><td>20</td><td>nan</td><td></td></tr></tbody></table>"
    )
    mixed = Table((
        Column("x", [1.5, -2.5, np.nan], unit="m", form=".2g", missing="-9",
               beside=Column("e", [0.25, 0.5, np.nan], unit="m", form=".2g")),
        Column("y", [3e-7, 1.0, 2.0], unit="m", form="g"),
        Column("<z>", ["&", "-3", "m^2"]),
    ))  # fmt: skip
    cells = [row.split("</td><td>") for row in mixed.html().split("<tr><td>")[1:]]
    assert [row[0] for row in cells] == ["1.5 ± 0.25", "−2.5 ± 0.5", "−9"]
    assert [row[1] for row in cells] == ["3×10⁻⁷", "1", "2"]
    assert [row[2].partition("</td>")[0] for row in cells] == ["&amp;", "−3", "m²"]
    assert "<th>&lt;z&gt;</th>" in mixed.html()
    assert Table(()).html() == ""


def test_a_file_of_a_table_has_all_digits(tmp_path):
    kinds = Table((
        Column("i", [1, np.int64(-2)]), Column("t", ["a,b", "c"]),
        Column("x", [0.1, np.float64(1e-300)], unit="N", beside=Column("e", [1 / 3, 2.0], unit="1")),
    ))  # fmt: skip
    kinds.write(str(tmp_path / "t.csv"))
    lines = (tmp_path / "t.csv").read_bytes().decode().removesuffix("\n").split("\n")
    assert lines == ["i,t,x (N),e", f'1,"a,b",0.1,{1 / 3!r}', "-2,c,1e-300,2.0"]
    assert list(kinds.to_dataframe()["e"]) == [1 / 3, 2.0]


@pytest.mark.parametrize(("x", "error", "digits"), [
    (123.4, 0.012, 6), (123.4, 0.12, 5), (0.05, 0.001, 3), (-0.05, 0.001, 3), (1.0, 5.0, 2), (1.0, 20.0, 2),
    (1.0, 1e-4, 6), (1.0, 1e-5, 7), (1.0, 1e-9, 7),
])  # fmt: skip
def test_digits_end_with_the_second_one_of_the_error(x, error, digits):
    assert digits_of(x, error) == digits


def test_tables_under_each_other_keep_what_is_beside_their_columns():
    one, two = SMALL.only("load"), SMALL.at([0]).only("load")
    both = stacked({"a": one, "b": two}, "who", "the one")
    assert both.columns[0].words == "the one"
    assert [list(c.values) for c in both.flat[:2]] == [["a"] * 3 + ["b"], ["N"] * 4]
    np.testing.assert_array_equal(both.flat[3].values, [13.0, 2.5, np.nan, 13.0])
    np.testing.assert_array_equal(both.flat[2].error, [0.0123, 0.5, 1.0, 0.0123])
    assert both.flat[3].unit == "N"


def test_a_sheet_is_its_title_its_facts_and_its_table():
    assert list(listed([("a", "x"), ("long", "y")])) == ["  a     x", "  long  y"]
    assert list(listed([("a", "x")], 6)) == ["  a       x"]
    few = Table((Column("n", [1]),))
    whole = few.under("One\ntwo", [("a", "x" * 100), ("long", "<y>")])
    assert whole.text() == f"One\\ntwo\n  a     {'x' * 85}...\n  long  <y>\n  n\n  1"
    facts = f"<tr><th>a</th><td>{'x' * 85}...</td></tr><tr><th>long</th><td>&lt;y&gt;</td></tr>"
    assert whole._repr_html_() == f"<b>One\\ntwo</b><table>{facts}</table>{few.html()}"
    alone = Table((), "t")
    assert (alone.text(), alone._repr_html_()) == ("t", "<b>t</b>")


@pytest.mark.parametrize("length", [60, 61])
def test_a_long_text_is_shortened_where_it_is_no_number(length):
    text = "x" * length
    with pytest.raises(ValueError, match="give a number > 0") as told:
        parse(text, "m")
    shown = text if length == 60 else "x" * 57 + "..."
    assert str(told.value).startswith(f"'{shown}': ")
    assert parse(f"1{' ' * 997}m", "m") == 1


# --- files as such ------------------------------------------------------------------------------------------


def test_a_file_is_on_the_disk_before_its_name_and_nothing_is_left_beside_it(tmp_path, monkeypatch):
    """Its contents, then the folder's names; everybody may read it, its owner alone may write."""
    flushed, fsync = [], os.fsync

    def noted(fd):
        flushed.append((os.fstat(fd).st_ino, sorted(p.name for p in tmp_path.iterdir())))
        fsync(fd)

    monkeypatch.setattr(os, "fsync", noted)
    before = os.umask(0)
    try:
        for expected in (None, "anything"):
            flushed.clear()
            write_whole(tmp_path / "a", [b"one", b"two"], expected=expected)
            (own, beside), (folder, names) = flushed
            made = (tmp_path / "a").stat()
            assert (own, folder) == (made.st_ino, tmp_path.stat().st_ino)
            assert names == ["a"]
            assert beside != names
            assert (tmp_path / "a").read_bytes() == b"onetwo"
            assert stat.S_IMODE(made.st_mode) == 0o644
    finally:
        os.umask(before)


def test_the_longest_name_can_be_written_and_leftovers_of_the_living_stay(tmp_path):
    longest = tmp_path / ("x" * 196 + ".csv")
    check_output(longest)
    write_whole(longest, [b"1"])
    with pytest.raises(Exception, match="is not a valid file name"):
        check_output(tmp_path / ("x" * 197 + ".csv"))
    with pytest.raises(Exception, match="is not a valid file name"):
        check_output(tmp_path / ("é" * 100 + "x"))  # bytes count
    for name in ("..", "a\x07.csv"):
        with pytest.raises(Exception, match="is not a valid file name"):
            check_output(tmp_path / name)
    mine = temporary_beside(tmp_path / "a.csv")
    odd = mine.with_name(mine.name.replace(f"-{os.getpid()}-", "-some-"))
    assert mine.name.startswith(".a.csv.")
    odd.touch()
    mine.touch()
    check_output(tmp_path / "a.csv")
    assert mine.exists()
    assert odd.exists()
    assert (alive(os.getpid()), alive(10**30)) == (True, True)  # of what cannot be asked, nothing is removed


@pytest.mark.parametrize("told", ["unable to lock file, errno = 37", "no such file"])
def test_a_disk_without_locks_is_read_without_one(told, monkeypatch):
    asked = []

    def opens(path, mode, **more):
        asked.append((path, mode, more))
        if not more:
            raise OSError(told)
        return "a file"

    monkeypatch.setattr(h5py, "File", opens)
    if "lock" in told:
        assert opened("x.h5") == "a file"
        assert asked == [("x.h5", "r", {}), ("x.h5", "r", {"locking": False})]
    else:
        with pytest.raises(OSError, match=told):
            opened("x.h5")
        assert len(asked) == 1


def test_arrays_of_either_version_are_mapped(tmp_path):
    z = np.arange(6.0).reshape(2, 3)
    for version in ((1, 0), (2, 0)):
        with open(tmp_path / "a.npy", "wb") as file:
            np.lib.format.write_array(file, z, version=version)
        np.testing.assert_array_equal(open_npy(tmp_path / "a.npy"), z)
    head = b"{'descr': '<f8', 'fortran_order': True, 'shape': (2L, 3L), }"  # as Python 2 wrote it
    data = b"\x93NUMPY\x01\x00" + len(head + b"\n").to_bytes(2, "little") + head + b"\n" + z.T.tobytes()
    (tmp_path / "a.npy").write_bytes(data)
    np.testing.assert_array_equal(open_npy(tmp_path / "a.npy"), z)
    for other in (z > 1, z.astype(complex), z.astype(str)):
        np.save(tmp_path / "a.npy", other)
        with pytest.raises(ValueError, match="its values are not real numbers"):
            open_npy(tmp_path / "a.npy")
    with open(tmp_path / "a.npy", "wb") as file:
        np.lib.format.write_array(file, z, version=(3, 0))
    with pytest.raises(ValueError, match="is not a valid"):
        open_npy(tmp_path / "a.npy")

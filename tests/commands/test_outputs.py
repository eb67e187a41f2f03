"""What commands may write: never what they read, never an ensemble, never half a file."""

import errno
import os
import shutil
import stat
import subprocess
import sys
from contextlib import chdir
from functools import partial

import h5py
import pytest
from oracles.inside import whole_file, write_whole
from oracles.overwrites import CASES, attempt, contents, prepare, ways
from oracles.said import without_notes

import mcgw
from mcgw.cli import main
from mcgw.errors import in_one_line
from mcgw.figures import panels

pytestmark = pytest.mark.usefixtures("no_pressures")


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("inputs")
    prepare(folder)
    return folder


@pytest.fixture
def here(inputs, tmp_path):
    """A folder of its own with all inputs, as the current one."""
    shutil.copytree(inputs, tmp_path / "here")
    with chdir(tmp_path / "here"):
        yield tmp_path / "here"


def told(capsys, words):
    """The one line that a command ends with."""
    capsys.readouterr()
    assert main(words.split()) == 2
    err = without_notes(capsys.readouterr().err)
    assert len(err.splitlines()) == 1, err
    return err


# Each command with one of the names that its output may have; every name with some of them.
OVERWRITES = [(case, ways(case)[i % len(ways(case))]) for i, case in enumerate(CASES)]


@pytest.mark.parametrize(("case", "way"), OVERWRITES)
def test_no_command_writes_over_what_it_reads(case, way, here, capsys):
    assert attempt(case, way) == (2, [])
    *notes, last = capsys.readouterr().err.splitlines()
    assert "is an input" in last
    assert not any(line.startswith("mcgw: ") for line in notes)


PLACES = [
    ("run scene.toml -o x.csv", "an ensemble is written there, whose name ends in .h5, .hdf5"),
    ("run scene.toml --shard 1/2 -o x.csv", "an ensemble"),
    ("merge x.csv", "an ensemble"),
    ("compare e.h5 -o x.h5", "a figure is written there, whose name ends in .eps"),
    ("report e.h5 -o x.h5", "a web page"),
    ("export e.h5 --to calculix -o x.csv", "a table for calculix is written there, whose name ends in .inp"),
    ("surface scene.toml -o x.tiff", "a map is written there, whose name ends in .npy"),
    ("fit map.npy --cutoff none -o x.h5", "a scene"),
    ("compare e.h5 -o a.svg --csv a.svg", "is also the output of -o"),
    ("show e.h5 --digest --csv a.csv", "leave out the other option"),
    ("compare e.h5 -o e.h5.parts/a.png", "is the folder of the run that makes e.h5"),
    ("show e.h5 --csv a.h5.parts/shards/x.csv", "is the folder of a run"),
    ("surface plain.toml -o a.h5", "a run that makes this file is not finished"),
    ("compare e.h5 -o map.npy/a.png", "map.npy/a.png: cannot be written"),
    ("converge scene.toml -o e.h5", "e.h5/scene-converge.png: cannot be written"),
    ("figures -o e.h5", "cannot be written"),
    ("show e.h5 --csv .", "a table is written there"),
    *((f"{words} -o whole.{end}", "is an ensemble of mcgw, which this would replace") for words, end in (
        ("export e.h5 --to comsol", "txt"), ("surface plain.toml", "h5"), ("init", "toml"))),
    ("show e.h5 --csv cut.csv", "is an ensemble of mcgw, which this would replace"),
    ("show e.h5 --csv other.csv", "is an HDF5 file, which this would replace"),
]  # fmt: skip


@pytest.mark.parametrize(("words", "message"), PLACES)
def test_places_and_endings_that_will_not_do(words, message, here, capsys):
    (here / "a.h5.parts").mkdir()
    (here / "a.h5.parts" / "lock.db").touch()
    for name in ("whole.txt", "whole.h5", "whole.toml"):
        shutil.copy("e.h5", name)
    (here / "cut.csv").write_bytes((here / "e.h5").read_bytes()[:-100])
    with h5py.File("other.csv", "w") as file:
        file["x"] = [1.0]
    before = contents()
    assert message in told(capsys, words)
    assert contents() == before


WRITE = [
    ("run plain.toml -o OUT", ".h5"),
    ("compare e.h5 -o OUT", ".png"),
    ("report e.h5 -o OUT", ".html"),
    ("export e.h5 --to moose -o OUT", ".csv"),
    ("show e.h5 --csv OUT", ".csv"),
    ("solve plain.toml --pressure 1MPa --csv OUT", ".csv"),
    ("surface plain.toml --shape 16 -o OUT", ".npy"),
    ("init -o OUT", ".toml"),
]


@pytest.mark.usefixtures("blank_figures")
@pytest.mark.parametrize(("words", "ending"), WRITE)
def test_a_disk_that_fails_leaves_the_older_file(words, ending, here, monkeypatch, capsys):
    """Bit by bit, and nothing lies beside it. Folders are made; something else in the way is one line."""
    out = here / "new" / "deeper" / f"x{ending}"
    if ending not in (".h5", ".toml"):
        out.parent.mkdir(parents=True)
        out.write_bytes(b"old")

    def fail(fd):
        raise OSError(28, "No space left on device")

    before, words = contents(), words.replace("OUT", str(out)).split()
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", fail)
        assert main(words) in (1, 2)
    assert contents() == before
    assert main(words) == 0
    assert out.is_file()
    assert out not in before or out.read_bytes() != b"old"
    assert not list(out.parent.glob(".*"))
    out.unlink()
    out.mkdir() if len(ending) % 2 else os.mkfifo(out)
    assert "is not a regular file" in told(capsys, " ".join(words))


@pytest.mark.parametrize("links", [True, False])
def test_a_name_taken_meanwhile_is_left_alone(tmp_path, links, monkeypatch):
    """On a disk without hard links as well."""

    def none(*names):
        raise PermissionError(1, "Operation not permitted")

    if not links:
        monkeypatch.setattr(os, "link", none)
    write_whole(tmp_path / "a", b"x", expected=None)
    with pytest.raises(FileExistsError, match=r"another file|exists"):
        write_whole(tmp_path / "a", b"y", expected=None)
    assert [p.name for p in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_bytes() == b"x"


def test_leftovers_of_the_dead_go_with_the_next_output(here):
    """Those of the living stay, and of whom nobody can ask."""
    with subprocess.Popen([sys.executable, "-c", ""]) as dead:
        pass
    with whole_file(here / "x.csv") as mine:
        pids = (dead.pid, "some", 10**30)
        theirs, *odd = (mine.with_name(mine.name.replace(f"-{os.getpid()}-", f"-{x}-")) for x in pids)
        for path in (mine, theirs, *odd):
            path.touch()
        assert theirs != mine
        assert main(["show", "e.h5", "--csv", "x.csv"]) == 0
        assert [path.exists() for path in (mine, theirs, *odd)] == [True, False, True, True]


def test_a_disk_that_does_not_flush_folders_is_no_error(tmp_path, make_scene, monkeypatch):
    """As some of FUSE, CIFS and 9p; a file that cannot be flushed is one."""
    real = os.fsync

    def no_folders(fd, code=errno.EINVAL):
        if stat.S_ISDIR(os.fstat(fd).st_mode):
            raise OSError(code, os.strerror(code))
        real(fd)

    for number, code in enumerate((errno.EINVAL, errno.ENOTSUP)):
        monkeypatch.setattr(os, "fsync", partial(no_folders, code=code))
        assert mcgw.run(make_scene(n_surfaces=20), tmp_path / f"{number}.h5").n_surfaces == 20
    monkeypatch.setattr(os, "fsync", partial(no_folders, code=errno.EIO))
    with pytest.raises(mcgw.RunError, match="Input/output error"):
        mcgw.run(make_scene(n_surfaces=20), tmp_path / "2.h5")


def test_a_replaced_file_keeps_its_mode_and_a_read_only_one_is_refused(here, capsys):
    """Before anything is drawn; what needs no writing is done as ever."""
    run, more = (f"run scene.toml -o r.h5 --set ensemble.n_surfaces={n}" for n in (30, 60))
    export = "export scene.toml --to abaqus --points 3 -o x.inp"
    for mode in (0o640, 0o444):
        for name, words, again in (("r.h5", run, more), ("x.inp", export, export)):
            (here / name).unlink(missing_ok=True)
            assert main(words.split()) == 0
            (here / name).chmod(mode)
            before = contents()
            if mode == 0o640:
                assert main(again.split()) == 0
                assert stat.S_IMODE((here / name).stat().st_mode) == mode
                continue
            assert f"{name}: is read-only" in told(capsys, again)
            assert words is export or main(words.split()) == 0
            assert contents() == before


def test_a_full_disk_names_the_file(tmp_path, monkeypatch):
    """Whatever is written whole."""

    with pytest.raises(OSError, match="No space left") as error, whole_file(tmp_path / "a.csv"):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    assert error.value.filename == str(tmp_path / "a.csv")
    assert in_one_line(error.value) == f"{tmp_path / 'a.csv'}: No space left on device"
    assert in_one_line(OSError(errno.ENOSPC, "full")).startswith("compiled loops (NUMBA_CACHE_DIR)")
    assert in_one_line(OSError("no number")) == "no number"


@pytest.mark.usefixtures("blank_figures", "without_caps")
@pytest.mark.parametrize(
    ("words", "first"),
    [
        ("fit map.npy --cutoff none --pixel 1um --summits s.csv --tiles t.csv --picture p.png -o f.toml", 0),
        ("figures --only figure-1 figure-2 --csv -o drawn", 1),
    ],
    ids=["fit", "figures"],
)
def test_a_command_that_fails_at_its_last_output_leaves_none(words, first, here, monkeypatch, capsys):
    """The scene, tables and figures written before are not there."""
    whole, calls, before = panels.save, [], contents()

    def fails(*arguments, **more):
        calls.append(arguments)
        if len(calls) > first:
            raise OSError(28, "No space left on device", "last")
        return whole(*arguments, **more)

    monkeypatch.setattr(panels, "save", fails)
    assert main(words.split()) != 0
    assert "last" in capsys.readouterr().err
    assert contents() == before

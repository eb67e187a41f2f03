"""Commands as processes: closed streams, full disks, files that never end are one line and an end."""

import errno
import gzip
import os
import signal
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.stats
from oracles.inside import Plan
from oracles.said import call as call_here, without_notes

import analytic
import mcgw
from mcgw.machine.terminal import one_line, plain_text

ROOT = Path(__file__).parents[2]
SCENE = (ROOT / "runs" / "quick.toml").read_text()
ENV = os.environ | {"PYTHONPATH": str(ROOT)}


def call(words, folder, *, redirect="", env=None, seconds=60):
    """A command through a shell, in a process that is stopped if it hangs."""
    line = f"exec {sys.executable} -m mcgw {words} {redirect}"
    return subprocess.run(
        ["bash", "-c", line], cwd=folder, env=ENV | (env or {}), capture_output=True, text=True,
        timeout=seconds, check=False,
    )  # fmt: skip


def calls(commands, folder):
    """Many commands in this process; an error if one of them hangs."""

    def late(*_):
        raise TimeoutError

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(60)
    try:
        return [call_here(*words.split(), cwd=folder) for words in commands]
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def put(folder, text=SCENE, name="s.toml", **changes):
    """A scene in the folder, lines of some keys replaced."""
    lines = text.splitlines()
    for key, value in changes.items():
        at = [i for i, line in enumerate(lines) if line.startswith(f"{key} ")]
        lines[at[0]] = f"{key} = {value}"
    (folder / name).write_text("\n".join(lines) + "\n")


def refused(done, message, lines=1):
    """Exit code 2 and so many lines, one of which says this; no traceback."""
    assert done.returncode == 2, done.stderr
    assert message in done.stderr, done.stderr
    assert len(without_notes(done.stderr).splitlines()) == lines, done.stderr
    assert all(len(line) < 400 for line in done.stderr.splitlines())


SLOW = pytest.mark.slow


def test_a_child_answers_as_this_process_does(tmp_path):
    """What other tests see in this process: exit code, output and errors of the entry point."""
    for words in ("run absent.toml", "merge --help"):
        ours, theirs = call_here(*words.split(), cwd=tmp_path), call(words, tmp_path)
        said = (theirs.returncode, theirs.stdout, theirs.stderr)
        assert said == (ours.returncode, ours.stdout, ours.stderr), words


@pytest.mark.parametrize(
    "redirect", [pytest.param("2>&-", marks=SLOW), pytest.param(">&-", marks=SLOW), "<&- >&- 2>&-"]
)
def test_a_run_with_closed_streams_makes_its_file(redirect, tmp_path):
    put(tmp_path, n_surfaces=20)
    done = call("run s.toml -o e.h5", tmp_path, redirect=redirect)
    assert done.returncode == 0, done.stderr
    there = mcgw.open_ensemble(tmp_path / "e.h5")
    np.testing.assert_array_equal(there.load, mcgw.simulate(there.scene).load)
    with h5py.File(tmp_path / "e.h5") as data:
        assert (data.attrs["filetype"], tuple(data.attrs["format"])) == (b"mcgw-results", (4, 0))
        assert {"seed", "sampler", "versions", "commit", "date", "cpu", "wall_seconds"} <= set(data.attrs)
        units = {name: data[name].attrs["units"].decode() for name in there.scene.quantities}
        kinds = {name: data[name].dtype for name in there.scene.quantities}
    assert units == {"load": "N", "area": "m^2", "stiffness": "N/m", "contacts": "1", "conductance": "m"}
    assert {name for name, kind in kinds.items() if kind == "<i8"} == {"contacts"}
    assert "Traceback" not in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["e.h5", "s.toml"]


@pytest.mark.slow
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")
def test_a_full_standard_output_is_named(tmp_path):
    put(tmp_path)
    done = call("show --plan s.toml", tmp_path, redirect=">/dev/full")
    assert done.returncode == 1
    assert without_notes(done.stderr) == "mcgw: standard output: No space left on device"


def test_without_compiled_loops_it_is_said(tmp_path):
    put(tmp_path)
    done = call("run s.toml -o e.h5", tmp_path, env={"NUMBA_DISABLE_JIT": "1"})
    refused(done, "NUMBA_DISABLE_JIT is set")
    assert "unset it" in done.stderr
    assert not (tmp_path / "e.h5").exists()


def test_a_long_run_says_so_before_it_begins_and_a_short_one_does_not(tmp_path, monkeypatch):
    put(tmp_path)
    done = call_here("run", "s.toml", "-o", "e.h5", cwd=tmp_path)
    assert (done.returncode, "about" in done.stderr) == (0, False)

    def none(*_):
        raise OSError(errno.ENOSPC, "drawn")

    monkeypatch.setattr(Plan, "draw", none)
    put(tmp_path, n_surfaces="1000000000", n_asperities="1000000000")
    said = call_here("run", "s.toml", "-o", "f.h5", cwd=tmp_path).stderr.splitlines()
    (line,) = (line for line in said if "on this machine" in line)
    assert line.startswith("mcgw: note: 1e+09 surfaces of 1e+09 asperities: about ")
    assert " years on this machine (5e+17 draws)" in line


EVIL = "\\u001b]0;owned\\u0007\\u001b[31mred\\r$x_{\\u202e\\nverdict: agrees"


def test_titles_cannot_steer_the_terminal(tmp_path):
    put(tmp_path, title=f'"{EVIL}"', n_surfaces=20)
    lines = ["run s.toml -o e.h5", "show --plan s.toml", "show e.h5", "show --scene e.h5"]
    shown = calls(lines, tmp_path)
    for done in shown:
        assert done.returncode == 0, done.stderr
        for line in (done.stdout + done.stderr).splitlines():
            assert line.isprintable(), line
        assert "verdict: agrees" not in done.stdout.splitlines()
    assert mcgw.scene_from(shown[-1].stdout) == mcgw.load_scene(tmp_path / "s.toml")


@pytest.mark.slow
def test_titles_are_plain_text_in_figures_and_pages(tmp_path):
    put(tmp_path, title=f'"{EVIL}"', n_surfaces=20)
    for done in calls(["run s.toml -o e.h5", "compare e.h5 -o e.svg", "report e.h5 -o e.html"], tmp_path):
        assert done.returncode == 0, done.stderr
    for text in ((tmp_path / "e.html").read_text(), (tmp_path / "e.svg").read_text()):
        assert not {"\x1b", "\x07", "\u202e"} & set(text)
        assert "red\\r$x_{" in text


def test_names_of_files_cannot_steer_the_terminal(tmp_path):
    done = call_here("run", os.fsdecode(b"\x1b[31mred\x9b\xff\xfe.toml"), cwd=tmp_path)
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.isprintable()
    assert line.endswith("No such file or directory")


def test_one_line_keeps_what_is_printable():
    for text in ("", "Kontakt σ = 1 µm²", "日本", "$x$ \\"):
        assert one_line(text) == text
    assert one_line("a\tb\nc\x9b\u2028\udcff") == "a\\tb\\nc\\u009b\\u2028\\udcff"
    assert one_line("\r\uffff\U00010000\U000e0001") == "\\r\\uffff\U00010000\\U000e0001"
    assert plain_text("a\tb\nc\x1b") == "a\\tb\nc\\u001b"


# --- files that a scene names ---------------------------------------------------------------------------


def passwords(path):
    path.write_text("root:secret,hash\nuser:word\n")


WRONG_FILES = {
    "fifo": (os.mkfifo, "is not a regular file"),
    "device": (lambda path: path.symlink_to("/dev/zero"), "is not a regular file"),
    "folder": (Path.mkdir, "is not a regular file"),
    "absent": (lambda path: None, "No such file"),
    "words": (passwords, "give "),
}
TABLES = {
    "grading": '[grading]\nlaw = "table"\nfile = "{}"\n[contact]',
    "heights": '[heights]\nlaw = "table"\nfile = "{}"\n[contact]',
}


def test_files_of_a_scene_that_are_none_are_refused_at_once(tmp_path):
    plain = SCENE.replace('[grading]\nlaw = "exponential"\ngamma = 1.5\n', "")
    cases = [
        (table, f"{kind}.{end}", message)
        for table, end in (("grading", "csv"), ("heights", "csv"), ("heights", "npy"))
        for kind, (_, message) in WRONG_FILES.items()
    ]
    for kind, (make, _) in WRONG_FILES.items():
        for end in ("csv", "npy"):
            make(tmp_path / f"{kind}.{end}")
    for table, name, _ in cases:
        put(tmp_path, plain.replace("[contact]", TABLES[table].format(name)), f"{table}-{name}.toml")
    found = calls([f"show --plan {table}-{name}.toml" for table, name, _ in cases], tmp_path)
    for (table, name, message), done in zip(cases, found, strict=True):
        refused(done, message)
        assert done.stderr.startswith(f"mcgw: {table}.file = '{name}': ")
        assert "secret" not in done.stderr
        assert "hash" not in done.stderr


def test_a_packed_list_of_heights_is_not_unpacked(tmp_path):
    (tmp_path / "heights.gz").write_bytes(gzip.compress(b"1.0\n" * 5_000_000, 1))
    assert (tmp_path / "heights.gz").stat().st_size < 2e5
    put(tmp_path, SCENE.replace("[contact]", TABLES["heights"].format("heights.gz")))
    (done,) = calls(["show --plan s.toml"], tmp_path)
    refused(done, "heights.gz: is not text in UTF-8")


HOSTILE = {
    "dotted key": "a" + ".a" * 20_000 + " = 1\n",
    "dotted quoted key": '"a"' + '."a"' * 10_000 + " = 1\n",
    "dotted header": "[a" + ".a" * 20_000 + "]\n",
    "spaced dots": "a" + " . a" * 10_000 + " = 1\n",
    "lists in lists": "a = " + "[" * 20_000 + "]" * 20_000 + "\n",
    "tables in tables": "a = " + "{a = " * 10_000 + "1" + "}" * 10_000 + "\n",
    "unknown keys": "".join(f"k{i} = 1\n" for i in range(10_000)),
    "quotes": 'a = "' + '\\"' * 40_000 + "\n",
    "single quotes": "a = " + "'" * 40_001 + "\n",
    "a long key": "a" * 50_000 + " = 1\n",
    "quantities": "[contact]\nquantities = [" + "'x'," * 10_000 + "]\n",
}


def test_hostile_texts_end_in_a_few_lines(tmp_path):
    for number, (kind, text) in enumerate(HOSTILE.items()):
        (tmp_path / f"{number}.toml").write_text(text + ("" if kind == "quantities" else SCENE))
    found = calls([f"show --plan {number}.toml" for number in range(len(HOSTILE))], tmp_path)
    for kind, done in zip(HOSTILE, found, strict=True):
        assert done.returncode == 2, kind
        lines = done.stderr.splitlines()
        assert 1 <= len(lines) < 40, kind
        assert all(line.startswith("mcgw: ") and len(line) < 400 for line in lines), kind


SLOW_LAWS = [
    scipy.stats.kappa4(0.1, 0.0), scipy.stats.kstwo(10), scipy.stats.studentized_range(3.0, 10.0),
]  # fmt: skip


@pytest.mark.filterwarnings("ignore")  # their integrals do not converge either
@pytest.mark.parametrize("law", SLOW_LAWS, ids=lambda law: law.dist.name)
def test_slow_laws_are_given_up_after_their_time(law, monkeypatch):
    """By a bound of a tenth of a second here; their moments take minutes."""
    monkeypatch.setattr("analytic.scipy_heights._SECONDS", 0.1)
    profile = sys.getprofile()
    with pytest.raises(
        ValueError, match=r"^\w+: mean and deviation take SciPy longer than 0\.1 s; give another"
    ):
        analytic.ScipyHeights(law)
    assert sys.getprofile() is profile
    assert analytic.ScipyHeights(scipy.stats.gamma(4.0)).support[0] == -2.0

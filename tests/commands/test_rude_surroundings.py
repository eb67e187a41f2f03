"""Commands as processes: closed streams, hostile texts and odd names are one line and an end."""

import errno
import gzip
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.stats
from oracles.inside import Plan, comparison_figure, draw
from oracles.said import call as call_here, without_notes

import analytic
import mcgw

ROOT = Path(__file__).parents[2]
SCENE = (ROOT / "runs" / "quick.toml").read_text()


def call(words, folder, redirect="", **env):
    """A command through a shell, in a process that is stopped if it hangs."""
    line = ["bash", "-c", f"exec {sys.executable} -m mcgw {words} {redirect}"]
    env = os.environ | {"PYTHONPATH": str(ROOT)} | env
    return subprocess.run(line, cwd=folder, env=env, capture_output=True, text=True, timeout=60, check=False)


def put(folder, text=SCENE, **changes):
    """A scene in the folder, lines of some keys replaced."""
    for key, value in changes.items():
        text = re.sub(rf"^{key} .*", lambda _, line=f"{key} = {value}": line, text, flags=re.MULTILINE)
    (folder / "s.toml").write_text(text)


def refused(done, message):
    """Exit code 2 and one line, which says this; no traceback."""
    assert done.returncode == 2, done.stderr
    assert message in done.stderr, done.stderr
    (line,) = without_notes(done.stderr).splitlines()
    assert len(line) < 400


def test_a_child_answers_as_this_process_does(tmp_path):
    """What other tests see in this process: exit code, output and errors of the entry point."""
    for words in ("run absent.toml", "merge --help"):
        ours, theirs = call_here(*words.split(), cwd=tmp_path), call(words, tmp_path)
        said = (theirs.returncode, theirs.stdout, theirs.stderr)
        assert said == (ours.returncode, ours.stdout, ours.stderr), words


def test_a_run_with_closed_streams_makes_its_file(tmp_path):
    put(tmp_path, n_surfaces=20)
    assert call("run s.toml -o e.h5", tmp_path, redirect="<&- >&- 2>&-").returncode == 0
    there = mcgw.open_ensemble(tmp_path / "e.h5")
    np.testing.assert_array_equal(there.load, mcgw.simulate(there.scene).load)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["e.h5", "s.toml"]


def test_without_compiled_loops_it_is_said(tmp_path):
    put(tmp_path)
    done = call("run s.toml -o e.h5", tmp_path, NUMBA_DISABLE_JIT="1")
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


EVIL = "\\u001b]0;日本\\u0007\\u001b[31mred\\r$x_{\\u202e\\u2028\\u009b\\U000e0001\\nverdict: agrees"


@pytest.mark.usefixtures("blank_figures", "no_pressures")
def test_titles_cannot_steer_the_terminal(tmp_path):
    put(tmp_path, title=f'"{EVIL}"', n_surfaces=20)
    lines = ["run s.toml -o e.h5", "show --plan s.toml", "show e.h5", "report e.h5", "show --scene e.h5"]
    shown = [call_here(*words.split(), cwd=tmp_path) for words in lines]
    for done in shown:
        assert done.returncode == 0, done.stderr
        assert all(line.isprintable() for line in (done.stdout + done.stderr).splitlines())
        assert "verdict: agrees" not in done.stdout.splitlines()
    assert mcgw.scene_from(shown[-1].stdout) == mcgw.load_scene(tmp_path / "s.toml")
    figure = draw(comparison_figure(mcgw.compare(mcgw.open_ensemble(tmp_path / "e.h5"))))
    assert r"red\r\$x_{" in figure.get_suptitle()
    page = (tmp_path / "e.html").read_text()
    assert not set("\x1b\x07\u202e\u2028\x9b\U000e0001") & set(page)
    assert "日本\\u0007\\u001b[31mred\\r$x_{" in page


def test_names_of_files_cannot_steer_the_terminal(tmp_path):
    done = call_here("run", os.fsdecode(b"\x1b[31mred\x9b\xff\xfe.toml"), cwd=tmp_path)
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.isprintable()
    assert line.endswith("No such file or directory")


TABLES = {
    "grading": '[grading]\nlaw = "table"\nfile = "{}"\n[contact]',
    "heights": '[heights]\nlaw = "table"\nfile = "{}"\n[contact]',
}


def test_what_files_hold_that_are_none_of_a_scene_is_told_to_nobody(tmp_path):
    plain = SCENE.replace('[grading]\nlaw = "exponential"\ngamma = 1.5\n', "")
    for table, name in (("grading", "a.csv"), ("heights", "b.csv"), ("heights", "c.npy")):
        (tmp_path / name).write_text("root:secret,hash\nuser:word\n")
        put(tmp_path, plain.replace("[contact]", TABLES[table].format(name)))
        done = call_here("show", "--plan", "s.toml", cwd=tmp_path)
        refused(done, f"mcgw: {table}.file = '{name}': ")
        assert not any(word in done.stderr for word in ("secret", "hash"))


def test_a_packed_list_of_heights_is_not_unpacked(tmp_path):
    (tmp_path / "heights.gz").write_bytes(gzip.compress(b"1.0\n" * 5_000_000, 1))
    assert (tmp_path / "heights.gz").stat().st_size < 2e5
    put(tmp_path, SCENE.replace("[contact]", TABLES["heights"].format("heights.gz")))
    done = call_here("show", "--plan", "s.toml", cwd=tmp_path)
    refused(done, "heights.gz: is not text in UTF-8")


HOSTILE = {
    "unknown keys": "".join(f"k{i} = 1\n" for i in range(10_000)),
    "quotes": 'a = "' + '\\"' * 40_000 + "\n",
    "a long key": "a" * 50_000 + " = 1\n",
    "quantities": "[contact]\nquantities = [" + "'x'," * 10_000 + "]\n",
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_texts_end_in_a_few_lines(kind, tmp_path):
    (tmp_path / "s.toml").write_text(HOSTILE[kind] + ("" if kind == "quantities" else SCENE))
    done = call_here("show", "--plan", "s.toml", cwd=tmp_path)
    assert done.returncode == 2
    lines = done.stderr.splitlines()
    assert 1 <= len(lines) < 40
    assert all(line.startswith("mcgw: ") and len(line) < 400 for line in lines)


def test_slow_laws_are_refused(monkeypatch):
    """Their moments would take minutes."""
    law = scipy.stats.gamma(4.0)
    assert analytic.ScipyHeights(law).support[0] == -2.0
    monkeypatch.setattr("analytic.scipy_heights._SLOW", 0.0)
    with pytest.raises(ValueError, match=r"^gamma: one density takes SciPy \d+ ms; give another"):
        analytic.ScipyHeights(law)

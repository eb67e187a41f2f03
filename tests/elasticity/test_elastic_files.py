"""The file of `mcgw.elastic`: damaged, shared, killed, and the same numbers whatever the clock says."""

import json
import os
import threading
import time
import warnings

import numpy as np
import pytest
from oracles.rough import rough

import mcgw
from mcgw.cli import main
from mcgw.elasticity import elastic as public, levels
from mcgw.elasticity.levels import LEVELS, Level, located

MAPS = [rough(np.random.default_rng(k)) for k in range(6)]
ASKED = {"pressure": 5e7, "E_star": 1e11, "solves": 4, "pilot": 4}


@pytest.fixture(autouse=True)
def cheap(monkeypatch):
    """Boundary elements that are a known multiple of what located summits say."""
    monkeypatch.setattr(public, "LEVELS", (*LEVELS[:2], Level("elastic", "stand-in", _multiple, 1.0)))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A file and the answer that goes with it."""
    path = tmp_path_factory.mktemp("solves") / "whole.jsonl"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(public, "LEVELS", (*LEVELS[:2], Level("elastic", "stand-in", _multiple, 1.0)))
        found = mcgw.elastic(MAPS, path=path, **ASKED)
    return path.read_bytes(), found.found.mean.tolist()


def _multiple(pressed):
    return {name: 1.25 * value for name, value in located(pressed).items()}


def test_clocks_do_not_matter(monkeypatch):
    """Seconds that are random numbers: once by luck, three times never."""
    plans, rng = [], np.random.default_rng(3)
    for _ in range(3):
        monkeypatch.setattr(levels.time, "process_time", lambda: float(rng.exponential(10)))
        found = mcgw.elastic(MAPS, **ASKED | {"solves": None, "rel_err": 0.2})
        plans.append((found.planned, found.found.mean.tolist(), found.found.stderr.tolist()))
    assert plans[0] == plans[1] == plans[2]


def test_first_line_holds_the_plan(whole):
    data, _ = whole
    header = json.loads(data.splitlines()[0])
    assert set(header["plan"]) == {"pilot", "rel_err", "solves", "costs", "chain", "maps", "cost", "plain"}
    assert header["plan"]["costs"] == [0.0005, 0.02, 1.0]
    assert header["plan"]["maps"][-1] == 4


def _digit(line):
    """The line with one digit of its first value changed."""
    at = line.index(b'"area": ') + 8
    return line[:at] + (b"8" if line[at : at + 1] != b"8" else b"7") + line[at + 1 :]


DAMAGE = {
    "cut": lambda x: x[:40],
    "empty": lambda x: b"",
    "spaces": lambda x: b"   ",
    "digit": _digit,
    "more seconds": lambda x: x.replace(b'"seconds": ', b'"seconds": 1'),
    "another map": lambda x: x.replace(b'"map": ', b'"map": 1'),
    "another level": lambda x: x.replace(b'"level": "', b'"level": "x'),
    "sign": lambda x: x.replace(b'"area": ', b'"area": -'),
    "nan": lambda x: b'{"level": "elastic", "map": 0, "values": {"area": NaN}, "seconds": 1}',
    "infinite": lambda x: x.replace(b'"area": ', b'"area": 1e999'),
    "no checksum": lambda x: x[: x.index(b', "check"')] + b"}",
    "other checksum": lambda x: x[:-3] + (b"0" if x[-3:-2] != b"0" else b"1") + x[-2:],
    "number": lambda x: b"17",
    "list": lambda x: b"[1, 2]",
    "text": lambda x: b'"values"',
    "null": lambda x: b"null",
    "no JSON": lambda x: b"my notes",
    "deep": lambda x: b"[" * 100_000,
    "many digits": lambda x: b"1" * 5000,
    "not UTF-8": lambda x: b"\xff\xfe" + x,
    "zeros": lambda x: bytes(len(x)),
    "comment": lambda x: b"# " + x,
    "two in one": lambda x: x + x,
    "carriage return": lambda x: x + b"\r",
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_a_damaged_line_is_named_and_solved_again(kind, whole, tmp_path):
    """Twenty-four kinds: one line said, the same bits, and a file that is whole again."""
    data, mean = whole
    lines = data.split(b"\n")
    lines[5] = DAMAGE[kind](lines[5])
    path = tmp_path / "s.jsonl"
    path.write_bytes(b"\n".join(lines))
    with pytest.warns(UserWarning, match=r"s\.jsonl: damaged or repeated lines .*: 6$") as told:
        found = mcgw.elastic(MAPS, path=path, **ASKED)
    assert len(told) == 1
    assert "\n" not in str(told[0].message)
    assert found.found.mean.tolist() == mean
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        again = mcgw.elastic(MAPS, path=path, **ASKED)
    assert again.found.mean.tolist() == mean


@pytest.mark.parametrize("kind", DAMAGE)
def test_a_damaged_first_line_is_refused(kind, whole, tmp_path):
    """It says what the others belong to: nothing is read, nothing written."""
    data, _ = whole
    first, *rest = data.split(b"\n")
    damage = DAMAGE[kind]
    head = first.replace(b'"E_star": ', b'"area": ') if kind in ("digit", "sign", "infinite") else first
    if kind in ("more seconds", "another map", "another level"):
        head = first.replace(b'"seed": 1', b'"seed": 2')
    path = tmp_path / "s.jsonl"
    path.write_bytes(b"\n".join([damage(head), *rest]))
    held = path.read_bytes()
    with pytest.raises(mcgw.StoreError, match="give another path"):
        mcgw.elastic(MAPS, path=path, **ASKED)
    assert path.read_bytes() == held
    assert [file.name for file in tmp_path.iterdir()] == ["s.jsonl"]


def test_a_line_of_another_question_does_not_pass(whole, tmp_path):
    """Its checksum is that of its own file."""
    data, mean = whole
    other = tmp_path / "other.jsonl"
    mcgw.elastic(MAPS, path=other, **ASKED | {"pressure": 6e7})
    lines = data.split(b"\n")
    lines[5] = other.read_bytes().split(b"\n")[5]
    path = tmp_path / "s.jsonl"
    path.write_bytes(b"\n".join(lines))
    with pytest.warns(UserWarning, match=": 6$"):
        assert mcgw.elastic(MAPS, path=path, **ASKED).found.mean.tolist() == mean


def test_repeated_lines_are_left_out(whole, tmp_path):
    data, mean = whole
    path = tmp_path / "s.jsonl"
    path.write_bytes(data + b"".join(data.splitlines(keepends=True)[1:9]))
    n = len(data.splitlines())
    with pytest.warns(UserWarning, match=f": {n + 1}, .*{n + 5} and 3 more$"):
        assert mcgw.elastic(MAPS, path=path, **ASKED).found.mean.tolist() == mean
    assert len(path.read_bytes().splitlines()) == n


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_what_is_no_regular_file_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    (tmp_path / "zero").symlink_to("/dev/zero")
    for name in ("pipe", "folder", "zero"):
        with pytest.raises(mcgw.StoreError, match=f"{name}: is no regular file"):
            mcgw.elastic(MAPS, path=tmp_path / name, **ASKED)


def test_a_second_writer_is_refused(whole, tmp_path, monkeypatch):
    """While one call adds its solves, another one waits a moment and says why; the file stays as it would."""
    data, mean = whole
    path, running, refused = tmp_path / "s.jsonl", threading.Event(), threading.Event()

    def solve(pressed):
        running.set()
        refused.wait(10)
        return _multiple(pressed)

    monkeypatch.setattr(public, "LEVELS", (*LEVELS[:2], Level("elastic", "stand-in", solve, 1.0)))
    answers = []
    first = threading.Thread(target=lambda: answers.append(mcgw.elastic(MAPS, path=path, **ASKED)))
    first.start()
    assert running.wait(10)
    begun = time.monotonic()
    with pytest.raises(mcgw.StoreError, match="another process adds solves to it"):
        mcgw.elastic(MAPS, path=path, **ASKED)
    assert time.monotonic() - begun < 5
    refused.set()
    first.join()
    assert answers[0].found.mean.tolist() == mean
    assert len(path.read_bytes().splitlines()) == len(data.splitlines())
    assert [file.name for file in tmp_path.iterdir()] == ["s.jsonl"]


def test_the_command_tells_damage_in_one_line(whole, tmp_path, capsys):
    scene = tmp_path / "s.toml"
    scene.write_text(
        '[surface]\nm0 = 1e-12\nm2 = 0.3\nm4 = 3e11\nnominal_area = "1600 um^2"\nE_star = 1e11\n'
        "[contact]\nseparations = [1.0]\n[ensemble]\nn_surfaces = 2\n"
    )
    out = tmp_path / "solves.jsonl"
    command = ["elastic", str(scene), "--pressure", "50MPa", "--rel-err", "0.5", "-o", str(out)]
    assert main(command) == 0
    first = capsys.readouterr().out
    out.write_bytes(out.read_bytes()[:-9])
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        assert main(command) == 0
    told = capsys.readouterr()
    assert told.out == first
    assert told.err.count("damaged or repeated lines") == 1

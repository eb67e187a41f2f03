"""The file of `mcgw.elastic`: resumed, damaged, shared, and the same numbers whatever the clock says."""

import json
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.inside import locked, parts_of
from oracles.rough import rough

import mcgw
from mcgw.cli import main
from mcgw.elasticity import levels

MAPS = [rough(np.random.default_rng(k)) for k in range(6)]
ASKED = {"pressure": 5e7, "E_star": 1e11, "solves": 4, "pilot": 4}
pytestmark = pytest.mark.usefixtures("cheap")


@pytest.fixture
def whole(tmp_path):
    """A file, its contents, and the answer that goes with it."""
    path = tmp_path / "s.jsonl"
    found = mcgw.elastic(MAPS, path=path, **ASKED)
    return path, path.read_bytes(), found.found.mean.tolist()


def test_what_is_in_the_file_is_not_solved_again(whole, monkeypatch):
    """Half of it, and all of it; progress counts up to what was planned."""
    path, data, mean = whole
    lines = data.splitlines(keepends=True)
    path.write_bytes(b"".join(lines[: len(lines) // 2]))
    assert mcgw.elastic(MAPS, path=path, **ASKED).found.mean.tolist() == mean
    rows = [json.loads(line) for line in path.read_bytes().splitlines()[1:]]
    assert len(rows) == len(lines) - 1
    monkeypatch.setattr(levels.Level, "timed", None)
    seen = []
    again = mcgw.elastic(MAPS, path=path, progress=lambda *told: seen.append(told), **ASKED)
    assert again.found.mean.tolist() == mean
    assert again.seconds == pytest.approx(sum(row["seconds"] for row in rows))
    done, planned = np.array(seen).T
    assert done[0] > 0
    assert np.all(np.diff(done) >= 0)
    assert_allclose(planned, again.planned.cost)
    assert planned[-1] / 2 < done[-1] <= planned[-1]


def _digit(line):
    """The line with one digit of its first value changed."""
    at = line.index(b'"area": ') + 8
    return line[:at] + (b"8" if line[at : at + 1] != b"8" else b"7") + line[at + 1 :]


DAMAGE = {
    "cut": lambda x: x[:40],
    "digit": _digit,
    "no checksum": lambda x: x[: x.index(b', "check"')] + b"}",
    "deep": lambda x: b"[" * 100_000,
    "not UTF-8": lambda x: b"\xff\xfe" + x,
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_a_damaged_line_is_named_and_solved_again(kind, whole):
    """One warning of one line, the same bits, and a file that is whole again."""
    path, data, mean = whole
    lines = data.split(b"\n")
    lines[5] = DAMAGE[kind](lines[5])
    path.write_bytes(b"\n".join(lines))
    with pytest.warns(UserWarning, match=r"s\.jsonl: damaged or repeated lines .*: 6$") as told:
        assert mcgw.elastic(MAPS, path=path, **ASKED).found.mean.tolist() == mean
    assert (len(told), "\n" in str(told[0].message)) == (1, False)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert mcgw.elastic(MAPS, path=path, **ASKED).found.mean.tolist() == mean


@pytest.mark.parametrize("head", [b"", b'{"seed": 1}'])
def test_another_file_stays_as_it_is(head, whole):
    path, data, _ = whole
    held = b"\n".join([head, *data.split(b"\n")[1:]])
    path.write_bytes(held)
    with pytest.raises(mcgw.StoreError, match="give another path"):
        mcgw.elastic(MAPS, path=path, **ASKED)
    assert path.read_bytes() == held
    assert [file.name for file in path.parent.iterdir()] == ["s.jsonl"]


def test_a_file_belongs_to_one_question(whole, tmp_path):
    """Of maps, of what is held, its modulus and seed; nor does a line of another one pass."""
    path, data, mean = whole
    changes = ({"pressure": 6e7}, {"E_star": 2e11}, {"seed": 2}, {"pressure": None, "separation": 1e-6})
    for change in changes:
        with pytest.raises(mcgw.StoreError, match="give another path"):
            mcgw.elastic(MAPS, path=path, **ASKED | change)
    with pytest.raises(mcgw.StoreError, match="give another path"):
        mcgw.elastic([*MAPS[:5], MAPS[0]], path=path, **ASKED)
    other = tmp_path / "other.jsonl"
    mcgw.elastic(MAPS, path=other, **ASKED | {"pressure": 6e7})
    lines = data.split(b"\n")
    lines[5] = other.read_bytes().split(b"\n")[5]
    path.write_bytes(b"\n".join(lines))
    with pytest.warns(UserWarning, match=": 6$"):
        assert mcgw.elastic(MAPS, path=path, **ASKED).found.mean.tolist() == mean


def test_repeated_lines_are_left_out(whole):
    path, data, mean = whole
    path.write_bytes(data + b"".join(data.splitlines(keepends=True)[1:9]))
    n = len(data.splitlines())
    with pytest.warns(UserWarning, match=f": {n + 1}, .*{n + 5} and 3 more$"):
        assert mcgw.elastic(MAPS, path=path, **ASKED).found.mean.tolist() == mean
    assert len(path.read_bytes().splitlines()) == n


def test_a_second_writer_is_refused(whole):
    path, data, _ = whole
    with locked(parts_of(path)), pytest.raises(mcgw.StoreError, match=r"s\.jsonl\.parts: locked by"):
        mcgw.elastic(MAPS, path=path, **ASKED)
    assert path.read_bytes() == data
    assert [file.name for file in path.parent.iterdir()] == ["s.jsonl"]


def test_the_command_resumes_and_tells_damage_in_one_line(tmp_path, capsys):
    """What is given counts, not the scene's."""
    scene, out = tmp_path / "s.toml", tmp_path / "solves.jsonl"
    scene.write_text(
        '[surface]\nm0 = 1e-12\nm2 = 0.3\nm4 = 3e11\nnominal_area = "1600 um^2"\nE_star = 1e11\n'
        "[contact]\nseparations = [1.0]\n[ensemble]\nn_surfaces = 2\n"
    )
    command = ["elastic", str(scene), "--pressure", "50MPa", "--rel-err", "0.5", "-o", str(out)]
    assert main(command) == 0
    first = capsys.readouterr()
    assert "mean_gap" in first.out
    out.write_bytes(out.read_bytes()[:-9])
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        assert main(command) == 0
    told = capsys.readouterr()
    assert told.out == first.out
    assert told.err.count("damaged or repeated lines") == 1
    out.unlink()
    assert main([*command, "--E-star", "50GPa"]) == 0
    assert json.loads(out.read_text().splitlines()[0])["E_star"] == 5e10

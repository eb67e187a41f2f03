"""What is written into another program's file, and what is shown, is what it says, whatever a stranger wrote.

A line that begins with an asterisk is a command to CalculiX and Abaqus: nothing may make one but the table.
"""

import re
from dataclasses import replace

import h5py
import numpy as np
import pytest
from oracles.new_trailer import trailer_again

import mcgw
from mcgw.cli import main
from mcgw.errors import StoreError
from mcgw.exports.curves import KINDS, Curve
from mcgw.exports.programs import PROGRAMS
from mcgw.exports.table_text import UNIT_SYSTEMS, table_text
from mcgw.formats.table import Column, Table
from mcgw.jobs.job import Job
from mcgw.store import ensembles, structure
from mcgw.store.run_folder import RunFolder

NUMBER = r"[-+]?\d\.\d{9}e[-+]\d\d"
LIVE = "x\n*STEP\r*INCLUDE, INPUT=evil.inp\u2028%\x85#\n1.0, 2.0"
ENDING = {"calculix": ".inp", "abaqus": ".inp", "moose": ".csv", "comsol": ".txt"}
# A comment, or a row of two numbers; each by its program's own manual.
LINES = {
    "calculix": rf"\*\*[ -~]{{0,130}}|{NUMBER}, {NUMBER}",
    "abaqus": rf"\*\*[ -~]{{0,254}}|{NUMBER}, {NUMBER}",
    "moose": rf"#[ -~]*|{NUMBER},{NUMBER}",
    "comsol": rf"%[ -~]*|{NUMBER} {NUMBER}",
}


def strange_lines(text, program, keyword):
    """Lines that the program would take for something else than comment, table and its one keyword."""
    lines = re.split(r"[\r\n]", text)
    return [line for line in lines if line and line != keyword and not re.fullmatch(LINES[program], line)]


@pytest.fixture
def made(make_scene, tmp_path, monkeypatch):
    """The file of an ensemble, looked at in this process."""
    monkeypatch.setattr(ensembles, "examine", lambda path: structure.describe(str(path)))
    mcgw.save(mcgw.simulate(make_scene(n_surfaces=8, title=LIVE)), tmp_path / "e.h5")
    return tmp_path / "e.h5"


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_title_is_a_comment_in_every_program(made, program, tmp_path):
    files = mcgw.export(made, tmp_path / f"t{ENDING[program]}", to=program, points=5)
    keyword = PROGRAMS[program].keywords["pressure-gap"]
    for path in files[:-1]:
        assert strange_lines(path.read_text("ascii"), program, keyword) == []
        assert path.read_text().count("STEP") == 1


@pytest.mark.parametrize("program", PROGRAMS)
def test_whatever_stands_in_a_heading_is_a_comment(program):
    curve = Curve("mean", np.array([1e-6, 2e-6, 3e-6]), np.array([3.0, 2.0, 1.0]))
    kind = KINDS["pressure-gap"]
    text = table_text(curve, kind, PROGRAMS[program], UNIT_SYSTEMS["SI"], [LIVE], LIVE)
    text = text.encode("ascii", "replace").decode()
    assert strange_lines(text, program, PROGRAMS[program].keywords["pressure-gap"]) == []


@pytest.mark.parametrize("program", PROGRAMS)
@pytest.mark.parametrize("name", ["a\n*STEP", "a\r*STEP", "*STEP", "a,b", "a b", "a'b", "\u00e9", "a" * 70])
def test_names_that_a_program_cannot_be_told_are_refused(make_scene, program, name, tmp_path, capsys):
    scene, path = make_scene(n_surfaces=8), tmp_path / f"{name}{ENDING[program]}"
    with pytest.raises(ValueError, match=r"^path = .*: \w+ includes it by name; give a name of"):
        mcgw.export(scene, path, to=program)
    assert main(["export", "none.toml", "--to", program, "-o", str(path)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["digest", "sampler", "date", "cpu", "versions", "commit"])
def test_texts_of_a_file_are_one_line_each(made, name, capsys):
    with h5py.File(made, "r+") as file:
        file.attrs[name] = "0" * 64 + "\n  complete      yes\n*STEP"
    trailer_again(made)
    with pytest.raises((StoreError, structure.RefusedError), match=f"attribute {name}: not one line of text"):
        mcgw.export(made, made.with_name("t.inp"), to="abaqus")


def test_the_digest_of_a_file_is_one(made):
    with h5py.File(made, "r+") as file:
        file.attrs["digest"] = "checked and found right"
    trailer_again(made)
    with pytest.raises(StoreError, match="its digest is invalid"):
        mcgw.open_ensemble(made)


def test_texts_of_a_run_are_one_line_each(make_scene, tmp_path):
    run = Job.of(make_scene(), tmp_path / "e.h5").record.begin()
    replace(run, date="now\n  digest  forged")._write(expected="anything")
    with pytest.raises(StoreError, match=r"run\.toml: damaged"):
        RunFolder.open(run.folder)


def test_a_comment_above_a_table_is_one_line(tmp_path):
    Table((Column("x", [1.0]),)).write(tmp_path / "t.csv", comment=LIVE)
    assert len(re.split(r"[\r\n]", (tmp_path / "t.csv").read_text("utf-8").strip())) == 3

"""The recipes of CONTRIBUTING.md, followed by the letter: a command and a figure, each in one file."""

import re
from pathlib import Path

import pytest
from oracles.said import call

import mcgw.commands
from mcgw.cli import COMMANDS, all_commands
from mcgw.figures import catalogue

ROOT = Path(mcgw.__file__).parents[1]
SCENE = """
surface = {sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11}
contact = {separations = [0.0, 1.0]}
ensemble = {n_surfaces = 20, n_asperities = 1000, seed = 5}
"""


def recipe(word):
    """The block of code in which a word stands."""
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "CONTRIBUTING.md").read_text(), flags=re.DOTALL)
    (found,) = (block for block in blocks if word in block)
    return found


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "s.toml").write_text(SCENE)
    return tmp_path


def test_a_command_is_one_file(folder, monkeypatch):
    """500 of 1000 Gaussian heights lie above 0."""
    commands = folder / "commands"
    commands.mkdir()
    (commands / "count.py").write_text(recipe("def count("))
    monkeypatch.setattr(mcgw.commands, "__path__", [*mcgw.commands.__path__, str(commands)])
    assert all_commands() == (*COMMANDS, "count")

    def said(line):
        done = call(*line.split(), cwd=folder)
        return done.returncode, done.stdout + done.stderr

    assert said("count s.toml -q") == (0, "500 contacts at d/sigma = 0\n")
    assert said("count s.toml --set ensemble.n_asperities=10 -q") == (0, "5 contacts at d/sigma = 0\n")
    assert said("count s.toml --separation 40 -q") == (1, "0 contacts at d/sigma = 40\n")
    assert said("count s.toml --csv new/a.csv -q")[0] == 0
    header, row = (folder / "new" / "a.csv").read_text().splitlines()
    assert (header, [float(x) for x in row.split(",")]) == ("separation,contacts", pytest.approx([0, 500]))
    for line, words in (
        ("count s.toml --csv s.toml", "--csv s.toml: is an input (s.toml)"),
        ("count s.toml --csv a.h5", "a table is written there, whose name ends in .csv"),
        ("count s.toml --separation x", "invalid float value"),
        ("count s.toml --seperation 2", "did you mean --separation?"),
        ("cuont s.toml", "did you mean count?"),
        ("count none.toml", "none.toml: No such file"),
    ):
        code, told = said(line)
        assert (code, words in told) == (2, True), told
    assert "d/sigma; default: 0.0" in said("count --help")[1]
    assert "example: mcgw count runs/demo.toml --separation 2" in said("count --help")[1]
    assert "count     " in said("--help")[1]
    assert "--separation" in said("completion bash")[1]


def test_a_figure_is_one_file(folder, monkeypatch):
    """The recipe stands at the end of the file; names, files and the command line follow in a new process."""
    text = Path(catalogue.__file__).read_text() + recipe("def contacts(")
    space = {"__name__": "catalogue"}
    exec(compile(text, "catalogue.py", "exec"), space)
    monkeypatch.setitem(catalogue.CATALOGUE, "contacts", space["CATALOGUE"]["contacts"])
    done = call("figures", "--scene", "s.toml", "--only", "contacts", "--csv", "-o", "new", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in (folder / "new").iterdir()) == ["contacts.csv", "contacts.png"]
    lines = (folder / "new" / "contacts.csv").read_text().splitlines()
    assert lines[1].split(",")[:4] == ["", "this scene", "line", "0.0"]
    assert float(lines[1].split(",")[4]) == pytest.approx(500)
    assert sum(",point," in line for line in lines) == 2

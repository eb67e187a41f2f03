"""Every command, snippet and proof of the documents runs; links lead somewhere."""

import argparse
import csv
import re
import runpy
import shlex
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest

import mcgw
from mcgw.cli import COMMANDS, _parser, main
from mcgw.jobs.running import run

ROOT = Path(__file__).parent.parent
PAGES = (
    "README.md",
    "runs/README.md",
    "runs/ERRATA.md",
    "runs/LAWS.md",
    "runs/ROUGHNESS.md",
)
SLOW = ("figures",)


def blocks(page, kind):
    return re.findall(rf"^```{kind}\n(.*?)^```", (ROOT / page).read_text(), flags=re.DOTALL | re.MULTILINE)


def commands(page):
    """What follows `mcgw` on each line of the shell blocks, without those that install."""
    lines = [line for block in blocks(page, "sh") for line in block.splitlines() if line.startswith("mcgw ")]
    return [shlex.split(line, comments=True)[1:] for line in lines]


def smaller(words):
    """The same command with fewer surfaces: what is tested is that it runs."""
    return [*words, "--surfaces", "20"] if words[0] == "solve" else words


@pytest.mark.usefixtures("blank_figures")
@pytest.mark.parametrize("page", ["README.md"])
def test_commands_run_in_their_order(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    found = commands(page)
    assert len(found) >= 6
    for words in found:
        if words[0] in SLOW:
            continue
        assert main(smaller(words)) == 0, words
        if words[0] == "init":
            scene = Path("mine.toml")
            scene.write_text(scene.read_text().replace("n_surfaces = 1000", "n_surfaces = 100"))
    said = capsys.readouterr().out
    made = {path.name for path in tmp_path.iterdir()}
    assert {"mine.toml", "mine.h5", "mine.png", "mine.html"} <= made
    assert all(name in said for name in made)  # each command says where its file is


@pytest.mark.slow
def test_figures_command(tmp_path, monkeypatch, capsys):
    """A minute: the whole set."""
    monkeypatch.chdir(tmp_path)
    (words,) = [words for words in commands("README.md") if words[0] == "figures"]
    assert main(words) == 0
    said = capsys.readouterr().out.split()
    assert len(said) == 3 * (6 + 11)  # of the paper, and those it lacks
    assert {Path(path).resolve() for path in said} == {p.resolve() for p in (tmp_path / "figures").iterdir()}


def test_python_of_the_readme_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (code,) = blocks("README.md", "python")
    names = {}
    exec(compile(code, "README.md", "exec"), names)
    plt.close("all")
    assert mcgw.open_ensemble("demo.h5").load.shape == names["e"].load.shape == (1000, 41)


def test_table_of_the_tutorial_is_a_grading(tmp_path):
    (table,) = blocks("docs/tutorials/own-material.md", "text")
    (tmp_path / "indents.csv").write_text(table.partition("\n")[2])
    scene = (ROOT / "mcgw" / "scene" / "presets" / "nanoindentation.toml").read_text()
    scene = re.sub(r"^(s|ratio) +=.*\n", "", scene, flags=re.MULTILINE).replace(
        '# file = "ind', 'file = "ind'
    )
    scene = mcgw.scene_from(scene, folder=tmp_path)
    assert scene.grading(np.array([0.0]))[0] == pytest.approx(1.0, rel=1e-12)
    assert scene.grading(np.array([2.5]))[0] == pytest.approx(104 / 72, rel=1e-12)  # 2 um at sigma = 0.8 um


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    text = (ROOT / page).read_text()
    for target in re.findall(r"\]\(([^)]+)\)", text):
        assert ((ROOT / page).parent / target).is_file(), target
    for name in (
        re.findall(r"`((?:bench/)?[\w.-]+\.(?:toml|py|md))`", text) if page == "runs/README.md" else []
    ):
        assert (ROOT / "runs" / name).is_file(), name


def test_errata_have_their_proofs(capsys):
    """Each row of the table is proved, and the numbers of the page are among those printed."""
    proofs = list(runpy.run_path(str(ROOT / "runs" / "errata.py"))["proofs"]())
    page = (ROOT / "runs" / "ERRATA.md").read_text()
    rows = re.findall(r"^\| (?:text after )?(\d+)", page, flags=re.MULTILINE)
    assert set(rows) == {equation for equation, *_ in proofs}
    printed = " ".join(" ".join(row) for row in proofs)
    for number in ("1.727", "0.548", "3.114", "1.550"):
        assert number in printed
        assert number in page


def test_errata_are_wrong_as_printed_and_right_as_corrected():
    """Eqs. (8), (9), (14) in numbers: what is called true equals the quadrature of Eq. (7)."""
    names = runpy.run_path(str(ROOT / "runs" / "errata.py"))
    true = names["integral"](1.5, 1.0, 1.5)
    assert true == pytest.approx(0.108021770156762, rel=1e-12)  # 50 digits, theory.md
    assert names["eq_8"](1.0, 1.5, 1e-8, -1) == pytest.approx(true, rel=1e-6)
    assert names["eq_8"](1.0, 1.5, 1e-8, +1) > 1e70
    assert names["eq_9"](1.0, 1.5, 64, np.exp(-1))[0] == pytest.approx(true, rel=1e-6)
    assert names["eq_9"](1.0, 1.5, 64, np.exp(-0.5))[1] > 0.3


@pytest.mark.usefixtures("blank_figures")
def test_csv_of_compare_is_the_ensemble(tmp_path):
    run(mcgw.load_scene(ROOT / "runs" / "quick.toml"), tmp_path / "quick.h5")
    words = [
        "compare",
        str(tmp_path / "quick.h5"),
        "-o",
        str(tmp_path / "a.svg"),
        "--csv",
        str(tmp_path / "a.csv"),
    ]
    assert main(words) == 0
    rows = list(csv.DictReader((tmp_path / "a.csv").read_text().splitlines()))
    found = [float(row["mean"]) for row in rows if row["quantity"] == "load"]
    np.testing.assert_array_equal(found, mcgw.open_ensemble(tmp_path / "quick.h5").mean("load"))


def test_csv_of_show_and_regrade(tmp_path, make_scene):
    base = run(make_scene(keep="moments"), tmp_path / "base.h5")
    assert main(["show", str(tmp_path / "base.h5"), "--csv", str(tmp_path / "means.csv")]) == 0
    rows = list(csv.DictReader((tmp_path / "means.csv").read_text().splitlines()))
    found = [float(row["std"]) for row in rows if row["quantity"] == "area"]
    np.testing.assert_array_equal(found, base.std("area"))
    words = ["regrade", str(tmp_path / "base.h5"), "--gamma", "1", "--csv", str(tmp_path / "ratios.csv")]
    assert main(words) == 0
    rows = list(csv.DictReader((tmp_path / "ratios.csv").read_text().splitlines()))
    new = mcgw.open_ensemble(tmp_path / "base.regraded.h5")
    found = [float(row["ratio"]) for row in rows if row["quantity"] == "load"]
    np.testing.assert_allclose(found, new.mean("load") / base.mean("load"), rtol=1e-14)


@pytest.fixture(scope="module")
def parsers():
    """The parser of each command, by its name."""
    (commands,) = (x for x in _parser()._actions if isinstance(x, argparse._SubParsersAction))
    return commands.choices


@pytest.mark.parametrize("command", COMMANDS)
def test_help_says_what_each_word_means(command, parsers):
    """Where the output goes if nobody says, and what stands for an option that is left out."""
    parser = parsers[command]
    for action in parser._actions:
        assert action.help, action.dest
        if action.nargs != 0 and action.default is not None and action.dest != "help":
            said = re.search(r"default: (\S+( GPa)?)", action.help)
            assert said, f"{command} {action.dest}: {action.help}"
            assert said[1].rstrip(";,") == str(action.default), f"{command} {action.dest}: {action.help}"
    outputs = [x for x in parser._actions if "-o" in x.option_strings]
    assert len(outputs) == (command not in ("show", "solve", "completion"))  # these print
    assert all(x.required or "default: " in x.help for x in outputs)


@pytest.mark.parametrize("command", COMMANDS)
def test_the_example_of_a_command_is_one(command, parsers):
    lines = parsers[command].epilog.removeprefix("example: ").split(" && ")
    for line in lines:
        program, name, *words = shlex.split(line, comments=True)
        assert program == "mcgw"
        parsers[name].parse_args(words)
    assert lines[0].startswith(f"mcgw {command}")
    assert (ROOT / "README.md").read_text().count(f"mcgw {command}") or command == "show"


def test_readme_is_short():
    """Two screens with one picture, and ten lines of Python."""
    text = (ROOT / "README.md").read_text()
    assert len(text.splitlines()) <= 110
    (picture,) = re.findall(r"!\[[^\]]{20,}\]\(([^)]+)\)", text)
    assert (ROOT / picture).stat().st_size < 200_000
    (code,) = blocks("README.md", "python")
    assert len(code.splitlines()) <= 10

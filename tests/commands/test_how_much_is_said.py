"""How much commands say: the news in five lines, nothing with -q, everything with -v."""

import re

import pytest
from conftest import draw_nothing
from oracles.said import call

from mcgw.cli import COMMANDS

pytestmark = pytest.mark.usefixtures("blank_figures")

SCENE = """
title = "Flags"
surface = {sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11}
grading = {gamma = 1.5}
contact = {separations = [0.0, 0.3, 4.0], quantities = ["load", "contacts"]}
ensemble = {n_surfaces = 70, n_asperities = 3000, seed = 5}
"""
SAID = {  # what a command says, without its tables
    "run s.toml -o e.h5": "e.h5: 70 surfaces of 3000 asperities, seed 5",
    "compare e.h5": "Monte Carlo and theory agree",
    "report e.h5": "e.html: report",
    "export e.h5 --to moose -o x.csv": "x.csv: pressure-gap",
    "sweep s.toml --over grading.gamma=1,2 -o w.h5": "w.h5: 2 scenes",
    "surface s.toml --shape 64 -o m.npy": "m.npy",
    "fit m.npy --cutoff none -o f.toml": "f.toml: sigma = ",
}


@pytest.fixture(scope="module")
def answers(tmp_path_factory):
    """Each of them quietly and plainly, in this order in one folder of each kind; one with all."""
    found = {}
    with pytest.MonkeyPatch.context() as patch:
        draw_nothing(patch)
        patch.setattr("mcgw.reports.report_figures._PRESSURES", 1)
        for option in ("-q", ""):
            folder = tmp_path_factory.mktemp("said")
            (folder / "s.toml").write_text(SCENE)
            for words in SAID:
                found[words, option] = call(*words.split(), *filter(None, [option]), cwd=folder)
        found["compare e.h5", "-v"] = call("compare", "e.h5", "-v", cwd=folder)
    return found


@pytest.mark.parametrize("words", SAID)
def test_the_news_first_in_at_most_five_lines(words, answers):
    plain = answers[words, ""]
    assert plain.returncode == 0, plain.stderr
    news = [line for line in plain.stdout.splitlines() if not line.startswith(" ")]
    assert news[0].startswith(SAID[words])
    assert len([line for line in news if not line.startswith("farthest")]) <= 5
    assert not re.search(r"\d\.\d{9}", plain.stdout)  # 0.3, and not 0.30000000000000004


@pytest.mark.parametrize("words", SAID)
def test_quiet_is_silent(words, answers):
    quiet = answers[words, "-q"]
    assert (quiet.returncode, quiet.stdout, quiet.stderr) == (0, "", "")


def test_cautions_are_said_once(answers):
    """By run in full, by the others as their number and where to read them."""
    run, compare = (answers[words, ""].stderr for words in ("run s.toml -o e.h5", "compare e.h5"))
    assert "fewer than 30 contacts" in run
    assert compare == f"mcgw: note: {run.count('mcgw: note: ')} cautions: mcgw show e.h5\n"
    assert "fewer than 30 contacts" in answers["compare e.h5", "-v"].stderr


def test_a_doubt_about_units_is_said_again_and_is_none_of_those_counted(tmp_path):
    (tmp_path / "s.toml").write_text(SCENE.replace("sigma = 1e-6", "sigma = 1.37"))
    run, compare = (call(*words.split(), cwd=tmp_path) for words in ("run s.toml -o e.h5", "compare e.h5"))
    doubt, number = compare.stderr.splitlines()
    assert "did you mean 1.37 um" in doubt
    assert doubt in run.stderr
    assert number == f"mcgw: note: {run.stderr.count('mcgw: note: ') - 1} cautions: mcgw show e.h5"


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_takes_them(name):
    shown = call(name, "--help").stdout
    assert "-q, --quiet" in shown
    assert "-v, --verbose" in shown
    assert call(name, "-q", "-v").returncode == 2


def test_errors_are_said_all_the_same(tmp_path):
    done = call("run", "-q", "absent.toml", cwd=tmp_path)
    assert done.returncode == 2
    assert "absent.toml" in done.stderr

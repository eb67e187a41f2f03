"""How much commands say: nothing with -q, cautions in full once or with -v."""

import re

import pytest
from oracles.said import call

from mcgw.cli import COMMANDS

pytestmark = pytest.mark.usefixtures("blank_figures", "no_pressures", "without_caps")

SCENE = """
title = "Flags"
surface = {sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11}
grading = {gamma = 1.5}
contact = {separations = [0.0, 0.3, 4.0], quantities = ["load", "contacts"]}
ensemble = {n_surfaces = 70, n_asperities = 3000, seed = 5}
"""
LINES = (
    "run s.toml -o e.h5", "compare e.h5", "report e.h5", "export e.h5 --to moose -o x.csv --points 3",
    "sweep s.toml --over grading.gamma=1,2 -o w.h5", "surface s.toml --shape 64 -o m.npy",
    "fit m.npy --cutoff none -o f.toml",
)  # fmt: skip


def test_quiet_is_silent(tmp_path):
    """What each says otherwise is recorded, see `test_what_users_read`."""
    (tmp_path / "s.toml").write_text(SCENE)
    for words in LINES:
        quiet = call(*words.split(), "-q", cwd=tmp_path)
        assert (quiet.returncode, quiet.stdout, quiet.stderr) == (0, "", ""), words


def test_cautions_are_said_once(tmp_path):
    """By run in full, by the others as their number and where to read them."""
    (tmp_path / "s.toml").write_text(SCENE)
    lines = ("run s.toml -o e.h5", "compare e.h5", "compare e.h5 -v")
    run, compare, full = (call(*words.split(), cwd=tmp_path) for words in lines)
    assert "fewer than 30 contacts" in run.stderr
    number = run.stderr.count("mcgw: note: ")
    assert compare.stderr == f"mcgw: note: {number} cautions: mcgw show e.h5\n"
    assert "fewer than 30 contacts" in full.stderr
    assert not re.search(r"\d\.\d{9}", compare.stdout)  # 0.3, and not 0.30000000000000004


def test_a_doubt_about_units_is_said_again_and_is_none_of_those_counted(tmp_path):
    (tmp_path / "s.toml").write_text(SCENE.replace("sigma = 1e-6", "sigma = 1.37"))
    run, compare = (call(*words.split(), cwd=tmp_path) for words in ("run s.toml -o e.h5", "compare e.h5"))
    doubt, number = compare.stderr.splitlines()
    assert "did you mean 1.37 um" in doubt
    assert doubt in run.stderr
    assert number == f"mcgw: note: {run.stderr.count('mcgw: note: ') - 1} cautions: mcgw show e.h5"


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_takes_them(name):
    """Either, as `test_what_users_read` has their help; and not both."""
    assert call(name, "-q", "-v").returncode == 2


def test_errors_are_said_all_the_same(tmp_path):
    done = call("run", "-q", "absent.toml", cwd=tmp_path)
    assert done.returncode == 2
    assert "absent.toml" in done.stderr

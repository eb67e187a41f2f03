"""How much commands say: nothing with -q, cautions in full once or with -v."""

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


@pytest.mark.slow
def test_quiet_is_silent_but_for_errors(tmp_path):
    """What each says otherwise is recorded, see `test_what_users_read`."""
    (tmp_path / "s.toml").write_text(SCENE)
    for words in LINES:
        quiet = call(*words.split(), "-q", cwd=tmp_path)
        assert (quiet.returncode, quiet.stdout, quiet.stderr) == (0, "", ""), words
    assert "absent.toml" in call("run", "-q", "absent.toml", cwd=tmp_path).stderr


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

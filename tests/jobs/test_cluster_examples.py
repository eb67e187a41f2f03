"""The examples for clusters: under a stand-in for Slurm, and under Snakemake where it is installed."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from oracles.inside import verify

import mcgw

pytestmark = pytest.mark.site

TESTS = Path(__file__).parents[1]
EXAMPLES = TESTS.parent / "runs" / "cluster"
SCENE = """
surface = {sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11}
contact = {separations = [0.0, 1.0]}
ensemble = {n_surfaces = 2000, n_asperities = 300, seed = 4}
"""


@pytest.fixture
def shell(tmp_path):
    """Call a command in an empty folder with a scene, `mcgw` and `sbatch` on its path."""
    commands, slurm = tmp_path / "bin", tmp_path / "slurm"
    for folder in (commands, slurm, tmp_path / "work"):
        folder.mkdir()
    for name, what in (("mcgw", "-m mcgw"), ("sbatch", TESTS / "oracles" / "slurm_stand_in.py")):
        (commands / name).write_text(f'#!/bin/sh\nexec {sys.executable} {what} "$@"\n')
        (commands / name).chmod(0o755)
    (tmp_path / "work" / "s.toml").write_text(SCENE)
    env = os.environ | {
        "PATH": f"{commands}:{os.environ['PATH']}",
        "PYTHONPATH": str(TESTS.parent),
        "SLURM_STAND_IN": str(slurm),
    }

    def call(*words):
        return subprocess.run(
            words, cwd=tmp_path / "work", env=env, capture_output=True, text=True, timeout=300, check=False
        )

    return call


OVER = ["--over", "grading.gamma=0.5,1,2", "--over", "ensemble.count=fixed,poisson"]


@pytest.mark.parametrize("words", [["run", "s.toml"], ["sweep", "s.toml", *OVER]], ids=["run", "sweep"])
def test_an_array_of_jobs_draws_it(shell, tmp_path, words):
    shell("bash", EXAMPLES / "submit.sh", "3", "e.h5", *words)
    said = {path.stem: path.read_text() for path in (tmp_path / "slurm").glob("*.out")}
    assert sorted(said) == ["slurm-100_1", "slurm-100_2", "slurm-100_3", "slurm-101_None"]
    assert all(f"shard {i}/3 is done" in said[f"slurm-100_{i}"] for i in (1, 2, 3))
    shell("mcgw", *words, "-o", "alone.h5")
    one, other = (shell("mcgw", "show", "--digest", name).stdout for name in ("e.h5", "alone.h5"))
    assert one == other != ""


def test_a_task_that_fails_leaves_no_file(shell, tmp_path):
    """What it would have merged waits; the same submission again goes on."""
    (tmp_path / "work" / "s.toml").write_text(SCENE.replace("seed = 4", "sed = 4"))
    shell("bash", EXAMPLES / "submit.sh", "2", "e.h5", "run", "s.toml")
    assert (tmp_path / "slurm" / "job-101").read_text() == "DependencyNeverSatisfied"
    assert not (tmp_path / "work" / "e.h5").exists()
    (tmp_path / "work" / "s.toml").write_text(SCENE)
    shell("bash", EXAMPLES / "submit.sh", "2", "e.h5", "run", "s.toml")
    assert (tmp_path / "slurm" / "job-103").read_text() == "0"
    assert (tmp_path / "work" / "e.h5").is_file()


@pytest.mark.skipif(shutil.which("snakemake") is None, reason="Snakemake is not installed")
def test_the_snakefile(shell, tmp_path):
    call = ["snakemake", "-s", EXAMPLES / "Snakefile", "--cores", "2", "--config", "scene=s.toml", "shares=2"]
    done = shell(*call)
    assert done.returncode == 0, done.stderr
    work = tmp_path / "work"
    made = {path.name for path in (work / "out").iterdir()}
    assert made == {"run.h5", "run.png", "run.shares", "sweep.h5", "sweep.png", "sweep.shares"}
    mcgw.run(mcgw.load_scene(work / "s.toml"), tmp_path / "alone.h5")
    assert verify(work / "out" / "run.h5") == verify(tmp_path / "alone.h5")
    assert mcgw.open_sweep(work / "out" / "sweep.h5").shape == (10,)
    assert "Nothing to be done" in shell(*call).stderr

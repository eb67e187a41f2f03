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

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "runs" / "cluster"
SCENE = """
surface = {sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11}
contact = {separations = [0.0, 1.0]}
ensemble = {n_surfaces = 2000, n_asperities = 300, seed = 4}
"""
# What Slurm does with them: the tasks of an array, the last first, or what waits for it if all went well.
SBATCH = """#!/bin/bash
case "$*" in
--parsable\\ --array=1-*)
    echo 100; shares=${2#--array=1-}; cp "$3" script; shift 3; worst=0
    cpus=$(sed -n 's/#SBATCH --cpus-per-task=//p' script)
    for task in $(seq "$shares" -1 1); do
        SLURM_CPUS_PER_TASK=$cpus SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_COUNT=$shares \\
            bash script "$@" >"task-$task.out" 2>&1 || worst=1
    done
    echo $worst >ended ;;
--dependency=afterok:100\\ --job-name=*\\ --wrap*)
    [ "$(cat ended)" = 0 ] && sh -c "$4" ;;
*) exit 2 ;;
esac
"""
OVER = ["--over", "grading.gamma=0.5,1,2", "--over", "ensemble.count=fixed,poisson"]


@pytest.fixture
def shell(in_tmp_path):
    """Call a command in a folder with a scene, `mcgw` and `sbatch` on its path."""
    (in_tmp_path / "s.toml").write_text(SCENE)
    for name, text in (("mcgw", f'#!/bin/sh\nexec {sys.executable} -m mcgw "$@"\n'), ("sbatch", SBATCH)):
        (in_tmp_path / name).write_text(text)
        (in_tmp_path / name).chmod(0o755)
    env = os.environ | {"PATH": f"{in_tmp_path}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT)}
    return lambda *words: subprocess.run(words, env=env, capture_output=True, text=True, timeout=300)


@pytest.mark.parametrize("words", [["run", "s.toml"], ["sweep", "s.toml", *OVER]], ids=["run", "sweep"])
def test_an_array_of_jobs_draws_it(shell, words):
    """A task that fails leaves no file; the same submission again goes on."""
    Path("s.toml").write_text(SCENE.replace("seed", "sed"))
    assert shell("bash", EXAMPLES / "submit.sh", "3", "e.h5", *words).returncode != 0
    assert not Path("e.h5").exists()
    Path("s.toml").write_text(SCENE)
    assert shell("bash", EXAMPLES / "submit.sh", "3", "e.h5", *words).returncode == 0
    assert all(f"shard {i}/3 is done" in Path(f"task-{i}.out").read_text() for i in (1, 2, 3))
    shell("mcgw", *words, "-o", "alone.h5")
    one, other = (shell("mcgw", "show", "--digest", name).stdout for name in ("e.h5", "alone.h5"))
    assert one == other != ""


@pytest.mark.skipif(shutil.which("snakemake") is None, reason="Snakemake is not installed")
def test_the_snakefile(shell):
    call = ["snakemake", "-s", EXAMPLES / "Snakefile", "--cores", "2", "--config", "scene=s.toml", "shares=2"]
    done = shell(*call)
    assert done.returncode == 0, done.stderr
    made = {path.name for path in Path("out").iterdir()}
    assert made == {"run.h5", "run.png", "run.shares", "sweep.h5", "sweep.png", "sweep.shares"}
    mcgw.run(mcgw.load_scene("s.toml"), "alone.h5")
    assert verify(Path("out/run.h5")) == verify(Path("alone.h5"))
    assert mcgw.open_sweep("out/sweep.h5").shape == (10,)
    assert "Nothing to be done" in shell(*call).stderr

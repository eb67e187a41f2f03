"""Scenes to start from: each runs, and none is written over a file."""

from dataclasses import replace
from pathlib import Path

import pytest

import mcgw
from mcgw.cli import main
from mcgw.commands.init import PRESETS
from mcgw.statistics.comparison import compare

HERE = Path(mcgw.__file__).parent / "scene" / "presets"


def test_every_preset_is_offered():
    assert {path.stem for path in HERE.glob("*.toml")} == set(PRESETS)


def test_demo_is_the_one_of_the_readme():
    assert (HERE / "demo.toml").read_text() == (HERE.parents[2] / "runs" / "demo.toml").read_text()


@pytest.mark.parametrize("name", PRESETS)
def test_preset_agrees_with_theory(name, tmp_path, capsys):
    """Small ensembles of each; a false alarm of the verdict in 1 of 1000 seeds, and these are fixed."""
    path = tmp_path / "mine.toml"
    assert main(["init", name, "-o", str(path)]) == 0
    assert str(path) in capsys.readouterr().out
    scene = mcgw.load_scene(path)
    assert scene.title
    assert compare(
        mcgw.simulate(replace(scene, n_surfaces=60, separations=scene.separations[::4]))
    ).verdict.agrees


def test_never_over_another_file(tmp_path, capsys):
    path = tmp_path / "mine.toml"
    path.write_text("mine")
    assert main(["init", "-o", str(path)]) == 2
    assert "already there" in capsys.readouterr().err
    assert path.read_text() == "mine"

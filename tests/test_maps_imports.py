"""Inside ``mcgw.maps`` imports point one way, and only the commands reach into it."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import mcgw

ROOT = Path(mcgw.__file__).parent
ORDER = (
    "height_unit", "topography", "nayak", "asperities", "envelope", "sdf", "x3p",
    "array_files", "text_file", "files", "spectrum", "form", "waves", "levels", "spikes", "tally",
    "leverage", "hiding", "fit", "flaws", "doubts", "fitted_scene", "spots",
)  # fmt: skip
NEVER = ("compare", "plots", "cli", "commands", "store.ensembles", "report_text", "regrade")


def modules(path):
    """Full names of all modules of the package that a file imports anywhere."""
    nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    names = [node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.module]
    return [name for name in names if name.startswith("mcgw.")]


def test_imports_point_one_way():
    files = [path for path in (ROOT / "maps").glob("*.py") if path.stem != "__init__"]
    assert {path.stem for path in files} == set(ORDER)
    for path in files:
        for name in modules(path):
            if name.startswith("mcgw.maps."):
                assert ORDER.index(name.split(".")[2]) < ORDER.index(path.stem), f"{path.name} imports {name}"
            assert not name.removeprefix("mcgw.").startswith(NEVER), f"{path.name} imports {name}"


def test_only_commands_reach_into_the_maps():
    for path in [*ROOT.glob("*.py"), *ROOT.glob("sampling/*.py"), *ROOT.glob("store/*.py")]:
        assert not any(name.startswith("mcgw.maps") for name in modules(path)), path.name


@pytest.mark.parametrize("module", ["mcgw.commands.surface", "mcgw.commands.fit"])
def test_help_needs_nothing_heavy(module):
    heavy = "{'numba', 'h5py', 'matplotlib', 'scipy', 'numpy'}"
    probe = f"import {module}, sys; print(*({heavy} & set(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == ""

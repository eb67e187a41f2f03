"""Imports point one way, and nothing is compiled or drawn before it is needed."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import mcgw

# Each file imports only from files before it. Commands come last and are not imported by anything.
ORDER = (
    "errors",
    "disk",
    "seal",
    "child",
    "probe",
    "guard",
    "provenance",
    "philox",
    "scene",
    "section",
    "npy_file",
    "heights_section",
    "scene_file",
    "hertz",
    "spacing",
    "in_threads",
    "cells",
    "tree",
    "uniform_sums",
    "moments",
    "laws",
    "response",
    "counts",
    "extras",
    "aggregate",
    "room",
    "samplers",
    "asperities",
    "ensemble",
    "stopping",
    "simulation",
    "forecast",
    "plan",
    "regrade",
    "shards",
    "layout",
    "rundir",
    "validity",
    "merge",
    "work",
    "engines",
    "dask_engine",
    "driver",
    "store",
    "running",
    "until_known",
    "stop_report",
    "principal",
    "checks",
    "compare",
    "converge",
    "methods",
    "tradeoff",
    "units",
    "csv_table",
    "solution",
    "solution_text",
    "figure_data",
    "figure_paper",
    "figure_more",
    "doubts",
    "plots",
    "plots_converge",
    "plots_tradeoff",
    "figures",
    "report_text",
    "report_html",
    "cli",
)
ROOT = Path(mcgw.__file__).parent


def imports(path):
    """Modules of this package that a file imports at its top level."""
    tree = ast.parse(path.read_text())
    names = [node.module for node in tree.body if isinstance(node, ast.ImportFrom) and node.module]
    return [name.split(".")[1] for name in names if name.startswith("mcgw.")]


def test_imports_point_one_way():
    files = [path for path in ROOT.glob("*.py") if not path.stem.startswith("_")]
    assert {path.stem for path in files} == set(ORDER)
    for path in files:
        for name in imports(path):
            assert ORDER.index(name) < ORDER.index(path.stem), f"{path.name} imports {name}"


def test_only_those_that_compare_take_integrals_from_theory():
    """The simulator shares the surface and its laws with the theory, never an integral."""
    shared = {
        "QUANTITIES", "Body", "Clipped", "Custom", "Exponential", "ExponentialHeights", "Gaussian", "Grading",
        "HeightLaw", "HeightTable", "Homogeneous", "MeasuredHeights", "Quantity", "ScipyHeights", "Surface",
        "Table", "Weibull", "composite_modulus", "first_negative", "resolved_breaks",
    }  # fmt: skip
    meeting = {
        "compare",
        "forecast",
        "methods",
        "principal",
        "solution",
        "figure_paper",
        "figure_more",
        "doubts",
        "report_html",
    }  # where Monte Carlo and theory are put side by side
    for path in ROOT.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and node.module == "analytic":
                assert {alias.name for alias in node.names} <= shared, path.name
            if isinstance(node, ast.Import) and path.stem not in meeting:
                assert all(not alias.name.startswith("analytic") for alias in node.names), path.name


@pytest.mark.parametrize("code", ["import mcgw", "import mcgw.cli; mcgw.cli._parser()"])
def test_nothing_heavy_is_imported_early(code):
    probe = f"{code}\nimport sys\nprint(*({{'numba', 'h5py', 'matplotlib', 'scipy'}} & set(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == ""

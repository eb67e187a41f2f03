"""Imports point one way, and nothing is compiled or drawn before it is needed."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

import mcgw
from mcgw import sampling

# Each file imports only from files before it. Commands come last and are not imported by anything.
ORDER = (
    "errors",
    "units",
    "compiling",
    "terminal",
    "plain_file",
    "toml_text",
    "lifeline",
    "formats.files",
    "formats.pictures",
    "store.disk",
    "store.lock",
    "store.seal",
    "outputs",
    "store.child",
    "store.head",
    "store.probe",
    "store.guard",
    "store.provenance",
    "sampling.philox",
    "surface",
    "scene",
    "section",
    "npy_file",
    "heights_section",
    "scene_file",
    "room",
    "sampling.spacing",
    "sampling.aligned",
    "sampling.in_threads",
    "sampling.hertz",
    "store.arithmetic",
    "sampling.lanes",
    "sampling.rules",
    "sampling.cells",
    "sampling.tree",
    "sampling.uniform_sums",
    "sampling.moments",
    "sampling.laws",
    "sampling.tiles",
    "sampling.assembly",
    "sampling.response",
    "sampling.exp_log",
    "sampling.binomial_ratio",
    "sampling.binomial",
    "sampling.halving",
    "sampling.counts",
    "sampling.extras",
    "sampling.aggregate",
    "sampling.samplers",
    "sampling.asperities",
    "intervals",
    "ensemble",
    "forecast",
    "simulation",
    "duration",
    "plan",
    "regrade",
    "store.shards",
    "store.layout",
    "store.rundir",
    "plausible",
    "validity",
    "store.merge",
    "work",
    "engines",
    "dask_engine",
    "driver",
    "store.sums",
    "store.ensembles",
    "store.leftovers",
    "joining",
    "running",
    "stop_report",
    "principal",
    "checks",
    "compare",
    "converge",
    "reference",
    "methods",
    "tradeoff",
    "csv_table",
    "solution",
    "solution_text",
    "figures.data",
    "figures.samples",
    "figures.paper",
    "figures.equal_load",
    "figures.finite",
    "figures.summits",
    "figures.further",
    "doubts",
    "plots",
    "plots_converge",
    "plots_tradeoff",
    "figures.drawing",
    "report_text",
    "report_html",
    "cli",
)
ROOT = Path(mcgw.__file__).parent


def imports(path):
    """Modules of this package that a file imports at its top level."""
    tree = ast.parse(path.read_text())
    names = [node.module for node in tree.body if isinstance(node, ast.ImportFrom) and node.module]
    return [name.removeprefix("mcgw.") for name in names if name.startswith("mcgw.")]


def parts():
    """All files that stand in one order, by the names of their modules."""
    files = [
        path
        for folder in (".", "figures", "formats", "sampling", "store")
        for path in (ROOT / folder).glob("*.py")
    ]
    named = {".".join(path.relative_to(ROOT).with_suffix("").parts): path for path in files}
    return {name: path for name, path in named.items() if not path.stem.startswith("_")}


def test_imports_point_one_way():
    assert parts().keys() == set(ORDER)
    for this, path in parts().items():
        for name in imports(path):
            assert ORDER.index(name) < ORDER.index(this), f"{this} imports {name}"


SHARED = {
    "QUANTITIES", "Body", "Clipped", "Custom", "Exponential", "ExponentialHeights", "Gaussian", "Grading",
    "HeightLaw", "HeightTable", "Homogeneous", "MeasuredHeights", "Quantity", "ScipyHeights", "Surface",
    "Table", "Weibull", "composite_modulus", "first_negative", "resolved_breaks",
}  # fmt: skip
GAUSSIAN_FIGURES = {"figures/paper.py", "figures/equal_load.py", "figures/summits.py"}  # those of the paper


def sources():
    for path in sorted(ROOT.rglob("*.py")):
        yield path.relative_to(ROOT).as_posix(), ast.parse(path.read_text())


def test_the_simulator_takes_no_integral_from_theory():
    """It shares the surface and its laws with the theory; what a scene's theory says it never asks."""
    besides = {"scene.py": {"Model"}, "compare.py": {"Fluctuations"}}
    whole = GAUSSIAN_FIGURES | {"methods.py"}  # the quadratures that tradeoff measures
    for name, tree in sources():
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module == "analytic":
                assert {alias.name for alias in node.names} <= SHARED | besides.get(name, set()), name
            if isinstance(node, ast.Import) and name not in whole:
                assert all(not alias.name.startswith("analytic") for alias in node.names), name
            if name.startswith(("sampling/", "store/")):
                assert not (isinstance(node, ast.Attribute) and node.attr == "theory"), name


def test_no_default_stands_for_the_height_law_of_a_scene():
    """The functions of 0.x are Gaussian unless told; `scene.theory` knows the scene's own law."""
    forbidden = {
        "area", "area_per_load", "area_per_load_ratio", "barber_conductance", "conductance", "contacts",
        "covariance", "cumulants", "fn", "fn_between", "fn_scaled", "load", "mean", "mean_modulus",
        "ratio_at_equal_load", "separation_at", "stiffness", "stiffness_ratio", "HeightRule", "Model",
    }  # fmt: skip

    def calls(tree):
        for node in ast.walk(tree):
            match node:
                case ast.Attribute(value=ast.Name(id="analytic"), attr=name) if name in forbidden:
                    yield name

    seen = {name: set(calls(tree)) for name, tree in sources()}
    assert {name for name, found in seen.items() if found} == GAUSSIAN_FIGURES  # and they do call them


@pytest.mark.parametrize("code", ["import mcgw", "import mcgw.cli; mcgw.cli._parser()"])
def test_nothing_heavy_is_imported_early(code):
    probe = f"{code}\nimport sys\nprint(*({{'numba', 'h5py', 'matplotlib', 'scipy'}} & set(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == ""


def test_kernels_older_than_a_file_are_compiled_anew(tmp_path):
    """A kernel holds the functions it calls from other files, which numba does not look at."""
    source, kernel = tmp_path / "a.py", tmp_path / "__pycache__" / "b.nbi"
    kernel.parent.mkdir()
    for path in (source, kernel):
        path.touch()
    for changed, kept in ((kernel.stat().st_mtime - 5, True), (kernel.stat().st_mtime + 5, False)):
        os.utime(source, (changed, changed))
        sampling._forget_old_kernels(tmp_path)
        assert kernel.exists() == kept
    sampling._forget_old_kernels(tmp_path / "nowhere")


def test_compiled_functions_lie_where_old_kernels_are_looked_for():
    """Those of one package only call each other: a folder is all that has to be watched."""
    for name, path in parts().items():
        if "@njit" in path.read_text():
            assert name.startswith("sampling."), name
    for path in (ROOT / "maps").glob("*.py"):
        if "njit" in path.read_text():
            assert not any(name.startswith("sampling") for name in imports(path)), path.name


def test_no_loop_of_the_sampler_has_threads_of_its_own():
    """It is called from several threads, which not every kind of numba's own threads allows."""
    for path in (ROOT / "sampling").glob("*.py"):
        assert "prange" not in path.read_text(), path.name

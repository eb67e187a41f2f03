"""Imports point one way, and nothing is compiled or drawn before it is needed."""

import ast
import subprocess
import sys
import tomllib
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import mcgw
from mcgw.scene.samplers import SAMPLERS

# Packages are layers: each imports only from those before it, and within one nothing goes round in a circle.
LAYERS = (
    "errors",
    "machine",
    "formats",
    "scene",
    "sampling",
    "ensemble",
    "store",
    "jobs",
    "sweeps",
    "statistics",
    "exports",
    "maps",
    "figures",
    "reports",
    "commands",
    "cli",
)
ROOT = Path(mcgw.__file__).parent


def imports(tree):
    """Modules of this package that a file imports, wherever in it that is."""
    for node in ast.walk(tree):
        match node:
            case ast.ImportFrom(module=str(module)) if module.startswith("mcgw."):
                yield module.removeprefix("mcgw.")
            case ast.Import(names=names):
                yield from (x.name.removeprefix("mcgw.") for x in names if x.name.startswith("mcgw."))


def sources():
    for path in sorted(ROOT.rglob("*.py")):
        yield path.relative_to(ROOT).as_posix(), ast.parse(path.read_text())


def inside():
    """All that lies in a layer: name of the module, and its tree."""
    for name, tree in sources():
        if name not in ("__init__.py", "__main__.py"):
            yield name.removesuffix(".py").removesuffix("/__init__").replace("/", "."), tree


def test_packages_are_layers():
    assert {name.partition(".")[0] for name, _ in inside()} == set(LAYERS)
    for this, tree in inside():
        for name in imports(tree):
            above, below = (LAYERS.index(x.partition(".")[0]) for x in (this, name))
            assert below <= above, f"{this} imports {name}"


def test_no_imports_go_round_in_a_circle():
    graph = {this: set(imports(tree)) for this, tree in inside()}
    TopologicalSorter(graph).prepare()


def test_the_response_knows_no_randomness():
    random = {"binomial", "counts", "halving", "moments", "philox", "samplers", "uniform_sums", "aggregate"}
    for this, tree in inside():
        if this.startswith("sampling.response"):
            assert not {f"sampling.{name}" for name in random} & set(imports(tree)), this


def test_nobody_outside_asks_which_sampler_it_is():
    """What differs between them they tell themselves, or their `Promise` does."""
    names = set(SAMPLERS) - {"auto", "cells"}  # there is a dataset called cells
    for this, tree in inside():
        if this.startswith(("sampling.", "scene.samplers")):
            continue
        compared = [x for node in ast.walk(tree) if isinstance(node, ast.Compare) for x in ast.walk(node)]
        assert not {x.value for x in compared if isinstance(x, ast.Constant)} & names, this
        assert not {"Cells", "Counted", "Direct"} & {x.id for x in asked_for(tree)}, this


def asked_for(tree):
    """Names in all calls of `isinstance`."""
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Name(id="isinstance")):
                yield from (x for x in ast.walk(node) if isinstance(x, ast.Name))


def test_the_root_has_only_the_door():
    assert {path.name for path in ROOT.glob("*.py")} == {"__init__.py", "__main__.py", "cli.py", "errors.py"}


SHARED = {
    "ALL_QUANTITIES", "LAW_QUANTITIES", "QUANTITIES", "TANGENTIAL", "UNLOADING",
    "Body", "Clipped", "Custom", "Exponential", "ExponentialHeights", "Gaussian", "Grading",
    "HeightLaw", "HeightTable", "Homogeneous", "MeasuredHeights", "MeasuredRadii", "Nayak", "PER_AREA",
    "PiecewiseSeries", "Quantity", "RandomCurvature", "ScipyHeights", "SpectralMoments", "Surface", "Table",
    "Weibull",
    "bends", "composite_modulus", "extent",
    "first_negative", "is_data", "quantity_of", "resolved", "resolved_breaks",
    "ChangEtsionBogy", "Coated", "ContactLaw", "CustomLaw", "DerjaguinMullerToporov", "Hertz",
    "JacksonGreen", "JohnsonKendallRoberts", "KogutEtsion", "PowerLawGraded", "ZhaoMaiettaChang",
    "Film", "Interaction", "Tangential", "masing", "SEPARATIONS",
}  # fmt: skip
LAW_FILES = {
    "adhesion", "bridge", "chang_etsion_bogy", "coated", "custom", "elastic_plastic",
    "etsion_kligerman_kadin", "hardness", "jackson_green", "kogut_etsion", "law_rows",
    "power_law_graded", "root_series", "zhao_maietta_chang",
    "balance", "interacting", "interaction", "interaction_mistakes", "interaction_section", "lowest_felt",
    "nominal", "nominal_literal", "own_balance",
}  # fmt: skip
GAUSSIAN_FIGURES = {"figures/paper.py", "figures/equal_load.py", "figures/summits.py"}  # those of the paper


def test_the_simulator_takes_no_integral_from_theory():
    """It shares the surface and its laws with the theory; what a scene's theory says it never asks."""
    besides = {"scene/fields.py": {"Model", "InteractingModel"}, "statistics/comparison.py": {"Fluctuations"}}
    besides["statistics/bounded.py"] = {"Model"}
    besides["figures/scene_paper.py"] = {"mean_modulus"}
    besides |= {f"figures/{name}.py": {"Model"} for name in ("listed", "yielding", "histories")}
    whole = GAUSSIAN_FIGURES | {"statistics/methods.py"}  # the quadratures that tradeoff measures
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


def test_who_asks_for_hertz_loads_no_other_law(tmp_path):
    """Neither files of other laws nor of interaction, for a run and its comparison with theory."""
    scene = ROOT.parent / "runs" / "quick.toml"
    code = "import sys, mcgw.cli\n"
    for words in (["run", scene, "-o", tmp_path / "q.h5"], ["compare", tmp_path / "q.h5"]):
        code += f"assert mcgw.cli.main({list(map(str, words))}) == 0\n"
    code += (
        "found = {name.rpartition('.')[2] for name in sys.modules if name.startswith(('analytic', 'mcgw'))}\n"
    )
    code += f"assert not found & {LAW_FILES!r}, found & {LAW_FILES!r}\n"
    subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    assert {path.stem for path in (*ROOT.rglob("*.py"), *ROOT.parent.glob("analytic/**/*.py"))} >= LAW_FILES


# Each takes as long to import as much of what a command does: who needs it imports it in a function.
NEEDLESS = {
    "run": {"matplotlib", "scipy.optimize", "scipy.stats"},
    "show": {"matplotlib", "numba", "scipy.optimize", "scipy.stats"},
    "show --plan": {"matplotlib", "scipy.optimize", "scipy.stats"},
    "compare": {"matplotlib.pyplot", "numba", "scipy.optimize", "scipy.stats"},
}


def test_commands_import_nothing_they_do_not_need(tmp_path):
    scene, file = ROOT.parent / "runs" / "quick.toml", tmp_path / "q.h5"
    seen = {}
    for words, needless in NEEDLESS.items():
        on = [scene, "-o", file] if words == "run" else [scene if "--plan" in words else file]
        arguments = [*words.split(), *map(str, on)]
        code = f"import sys, mcgw.cli\nassert mcgw.cli.main({arguments}) == 0\n"
        code += "print(*sys.modules, file=sys.stderr)"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        seen[words] = set(done.stderr.splitlines()[-1].split())
        assert not needless & seen[words], words
    assert "numba" in seen["run"]  # they would be seen
    assert "matplotlib.figure" in seen["compare"]


@pytest.mark.parametrize("command", ["surface", "fit"])
def test_help_needs_not_even_numpy(command):
    code = f"import mcgw.commands.{command}"
    probe = f"{code}\nimport sys\nprint('numpy' in sys.modules)"
    found = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "False"


def test_compiled_functions_call_those_of_their_own_layer():
    """Whose files are all that is looked at to know whether what was kept is old."""
    for name, tree in inside():
        if any(isinstance(node, ast.Name) and node.id == "njit" for node in ast.walk(tree)):
            assert name.startswith(("sampling.", "maps.", "ensemble.")), name
            if name.startswith("maps."):
                assert not any(other.startswith("sampling") for other in imports(tree)), name


def test_a_compiled_function_made_several_times_has_a_name_for_each():
    """Of two with one name, one is called in the place of the other (`mcgw.machine.compiling`)."""
    made = 0
    for name, tree in inside():
        outer = {id(node) for node in tree.body}
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef) and id(node) not in outer:
                for call in (c for c in node.decorator_list if "njit" in ast.unparse(c)):
                    assert "version=" in ast.unparse(call), (name, node.name)
                    made += 1
    assert made


def test_no_loop_of_the_sampler_has_threads_of_its_own():
    """It is called from several threads, which not every kind of numba's own threads allows."""
    for path in (ROOT / "sampling").rglob("*.py"):
        assert "prange" not in path.read_text(), path.name


def test_the_wheel_holds_every_package_and_every_file_that_is_no_module():
    project = ROOT.parent / "pyproject.toml"
    if not project.is_file():
        pytest.skip("the sources are not here")
    said = tomllib.loads(project.read_text())["tool"]["setuptools"]
    there = {path.parent for top in ("mcgw", "analytic") for path in (ROOT.parent / top).rglob("*.py")}
    assert {path.relative_to(ROOT.parent).as_posix().replace("/", ".") for path in there} == set(
        said["packages"]
    )
    for top, patterns in said["package-data"].items():
        data = {file for pattern in patterns for file in (ROOT.parent / top).glob(pattern)}
        kinds = (".py", ".pyc", ".nbi", ".nbc")
        others = {f for f in (ROOT.parent / top).rglob("*") if f.is_file() and f.suffix not in kinds}
        assert others == data

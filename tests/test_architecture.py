"""Imports point one way, and compiled loops stay in their layer."""

import ast
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import analytic
import mcgw
from mcgw.scene.samplers import SAMPLERS

# Packages are layers: each imports only from those before it, and within one nothing goes round in a circle.
LAYERS = (
    "errors", "machine", "formats", "scene", "sampling", "ensemble", "store", "sweeps", "jobs", "statistics",
    "exports", "maps", "figures", "reports", "commands", "cli",
)  # fmt: skip
ROOT = Path(mcgw.__file__).parent


def imports(tree):
    """Modules of this package that a file imports, wherever in it that is."""
    for node in tree.nodes:
        match node:
            case ast.ImportFrom(module=str(module)) if module.startswith("mcgw."):
                yield module.removeprefix("mcgw.")
            case ast.Import(names=names):
                yield from (x.name.removeprefix("mcgw.") for x in names if x.name.startswith("mcgw."))


@cache
def sources():
    """Each file and its syntax tree, read once."""
    paths = sorted(ROOT.rglob("*.py"))
    return [(path.relative_to(ROOT).as_posix(), Tree(ast.parse(path.read_text()))) for path in paths]


class Tree:
    """What stands in a file."""

    def __init__(self, tree):
        self.body, self.nodes = tree.body, list(ast.walk(tree))


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
        compared = [x for node in tree.nodes if isinstance(node, ast.Compare) for x in ast.walk(node)]
        assert not {x.value for x in compared if isinstance(x, ast.Constant)} & names, this
        assert not {"Cells", "Counted", "Direct"} & {x.id for x in asked_for(tree)}, this


def asked_for(tree):
    """Names in all calls of `isinstance`."""
    for node in tree.nodes:
        match node:
            case ast.Call(func=ast.Name(id="isinstance")):
                yield from (x for x in ast.walk(node) if isinstance(x, ast.Name))


def test_the_root_has_only_the_door():
    assert {path.name for path in ROOT.glob("*.py")} == {"__init__.py", "__main__.py", "cli.py", "errors.py"}


# Theory, as modules of `analytic`; the first three are Gaussian unless they are told another law.
GAUSSIAN = {"contact", "integrals", "inversion"}
THEORY = GAUSSIAN | {"height_rule", "interacting", "law_rule", "mean_contact", "model", "plasticity"}
GAUSSIAN_FIGURES = {"figures/paper.py", "figures/equal_load.py", "figures/summits.py"}  # those of the paper


def from_theory(tree, modules):
    """Names of `analytic` that a file uses and that these modules of it define."""
    for node in tree.nodes:
        match node:
            case ast.ImportFrom(module="analytic", names=names):
                found = [alias.name for alias in names]
            case ast.Attribute(value=ast.Name(id="analytic"), attr=name):
                found = [name]
            case _:
                continue
        for name in found:
            module = getattr(getattr(analytic, name), "__module__", "")
            if module.removeprefix("analytic.") in modules:
                yield name


def test_the_simulator_takes_no_integral_from_theory():
    """It shares the surface and its laws with the theory, and compares; what theory says it never asks."""
    asking = {name for name, tree in sources() if set(from_theory(tree, THEORY))}
    assert {name for name in asking if not name.startswith(("statistics/", "figures/"))} == {
        "scene/fields.py"
    }
    for name, tree in sources():
        if name.startswith(("sampling/", "store/")):
            attributes = {node.attr for node in tree.nodes if isinstance(node, ast.Attribute)}
            assert "theory" not in attributes, name


def test_no_default_stands_for_the_height_law_of_a_scene():
    """`scene.theory` knows the scene's own law; the Gaussian functions are for the paper's own figures."""
    asking = {name for name, tree in sources() if set(from_theory(tree, GAUSSIAN))}
    assert asking == GAUSSIAN_FIGURES | {"statistics/methods.py"}  # whose rules `tradeoff` measures


def test_compiled_functions_call_those_of_their_own_layer():
    """Whose files are all that is looked at to know whether what was kept is old."""
    for name, tree in inside():
        if any(isinstance(node, ast.Name) and node.id == "njit" for node in tree.nodes):
            assert name.startswith(("sampling.", "maps.", "ensemble.")), name
            if name.startswith("maps."):
                assert not any(other.startswith("sampling") for other in imports(tree)), name


def test_a_compiled_function_made_several_times_has_a_name_for_each():
    """Of two with one name, one is called in the place of the other (`mcgw.machine.compiling`)."""
    made = 0
    for name, tree in inside():
        outer = {id(node) for node in tree.body}
        for node in tree.nodes:
            if isinstance(node, ast.FunctionDef) and id(node) not in outer:
                for call in (c for c in node.decorator_list if "njit" in ast.unparse(c)):
                    assert "version=" in ast.unparse(call), (name, node.name)
                    made += 1
    assert made


def test_no_loop_of_the_sampler_has_threads_of_its_own():
    """It is called from several threads, which not every kind of numba's own threads allows."""
    for path in (ROOT / "sampling").rglob("*.py"):
        assert "prange" not in path.read_text(), path.name

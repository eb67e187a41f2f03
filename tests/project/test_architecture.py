"""Imports point one way, whether by name or by string, and compiled loops stay in their layer."""

import ast
from functools import cache
from graphlib import CycleError, TopologicalSorter
from importlib import import_module
from pathlib import Path

import pytest
from oracles.inside import MODULES

import analytic
import mcgw

# Packages are layers: each imports only from those before it. Above all is the door, `mcgw` itself.
LAYERS = (
    "errors", "machine", "formats", "validity", "scene", "sampling", "ensemble", "sweeps", "store", "jobs",
    "exports", "maps", "elasticity", "statistics", "figures", "reports", "commands", "cli",
)  # fmt: skip
ROOT = Path(mcgw.__file__).parent


def parsed(text):
    """All nodes of a source."""
    return tuple(ast.walk(ast.parse(text)))


@cache
def modules(package):
    """Every file of a package by the name of its module, read once."""
    folder = Path(package.__file__).parent
    paths = {path.relative_to(folder.parent): path for path in sorted(folder.rglob("*.py"))}
    return {
        ".".join(name.with_suffix("").parts).removesuffix(".__init__"): parsed(path.read_text())
        for name, path in paths.items()
    }


@cache
def known():
    return {**modules(mcgw), **modules(analytic)}


@cache
def imports(tree):
    """Modules of both packages that a file imports, wherever in it that is, or has a string for."""
    return set(named(tree))


def named(tree):
    for node in tree:
        match node:
            case ast.ImportFrom(module=str(module), names=names):
                inside = [f"{module}.{alias.name}" for alias in names]
                found = [name if name in known() else module for name in inside]
            case ast.Import(names=names):
                found = [alias.name for alias in names]
            case ast.Constant(value=str(text)) if "." in text:
                found = [text.rstrip(".")]  # as in f"mcgw.commands.{name}"
            case _:
                continue
        yield from (name for name in found if name in known())


def inside():
    """All that lies in a layer: name of the module in `mcgw`, and its tree."""
    for name, tree in modules(mcgw).items():
        if name not in ("mcgw", "mcgw.__main__"):
            yield name.removeprefix("mcgw."), tree


def going_up(files):
    """Imports of a layer from one above it, as (module, what it imports)."""
    place = {f"mcgw.{layer}": k for k, layer in enumerate(LAYERS)} | {"mcgw": len(LAYERS), "analytic": -1}

    def of(name):
        return place[".".join(name.split(".")[: 1 if name.startswith("analytic") else 2])]

    return {(name, other) for name, tree in files.items() for other in imports(tree) if of(other) > of(name)}


def test_packages_are_layers():
    assert {name.partition(".")[0] for name, _ in inside()} == set(LAYERS)
    doors = {"mcgw", "mcgw.__main__"}
    assert going_up({name: tree for name, tree in known().items() if name not in doors}) == set()


def around(files):
    """A circle of imports, if there is one; the name of a package itself is a text, not an import."""
    graph = {name: set(imports(tree)) - {name, "mcgw", "analytic"} for name, tree in files.items()}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return error.args[1]
    return []


def test_no_imports_go_round_in_a_circle():
    assert around(modules(mcgw)) == []
    assert around(modules(analytic)) == []


@pytest.mark.parametrize(
    "text",
    [
        "from mcgw.figures import plotting",
        "def late():\n    from mcgw.figures.plotting import draw",
        "import_module('mcgw.figures.plotting').draw(1)",
        "import_module(f'mcgw.figures.{name}')",
        "import mcgw",
    ],
)
def test_each_way_of_importing_would_be_seen(text):
    low, high = "mcgw.machine.terminal", "mcgw.figures.plotting"
    (pair,) = going_up({low: parsed(text)})
    assert pair[0] == low
    if pair[1] == high:
        back = parsed("from mcgw.machine.terminal import drawers")
        assert set(around({low: parsed(text), high: back})) == {low, high}


# Modules of `analytic` that hold theory.
THEORY = {"equations", "integrals", "height_rule", "mean_model", "model", "quadrature"}


def from_theory(tree, modules):
    """Names of `analytic` that a file uses and that these modules of it define."""
    for node in tree:
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
    yields = {"yielding_share"}  # beside the table of a solution
    asking = {name.partition(".")[0] for name, tree in inside() if {*from_theory(tree, THEORY)} - yields}
    assert asking == {"scene", "statistics", "figures"}  # that of a scene, of comparisons, of what is drawn
    for name, tree in inside():
        if name.startswith(("sampling.", "store.")):
            attributes = {node.attr for node in tree if isinstance(node, ast.Attribute)}
            assert "theory" not in attributes, name


def test_compiled_functions_call_those_of_their_own_layer():
    """Whose files are all that is looked at to know whether what was kept is old."""
    for name, tree in inside():
        if any(isinstance(node, ast.Name) and node.id == "njit" for node in tree):
            assert name.startswith(("sampling.", "maps.", "ensemble.")), name
            if name.startswith("maps."):
                assert not any(other.startswith("sampling") for other in imports(tree)), name


def test_scripts_take_only_names_that_are_there():
    """Those under `runs/`, most of which no test runs by itself."""
    for path in (ROOT.parent / "runs").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if (
                isinstance(node, ast.ImportFrom)
                and node.module
                and node.module.split(".")[0] in ("mcgw", "analytic")
            ):
                for name in (alias.name for alias in node.names):
                    there = hasattr(import_module(node.module), name) or f"{node.module}.{name}" in known()
                    assert there, f"{path.name}: {node.module}.{name}"


def test_every_dataclass_is_frozen():
    """Scenes, laws and results are keys of what is kept: none may change after."""
    thawed = [
        f"{name}.{node.name}"
        for name, tree in known().items()
        for node in tree
        if isinstance(node, ast.ClassDef)
        for mark in map(ast.unparse, node.decorator_list)
        if mark.startswith("dataclass") and "frozen=True" not in mark
    ]
    assert not thawed


def test_tests_know_little_of_the_inside():
    """Imports of inner modules, `mcgw.x.y`, and lines that patch: their numbers may fall, not rise.

    What several files of tests ask for has one place, `oracles.inside`: each module that moves changes that.
    """
    tests = [path for path in (ROOT.parent / "tests").rglob("*.py") if path.parent.name != "sampling"]
    inner, patches = [], 0
    for path in tests:
        text = path.read_text()
        patches += sum("monkeypatch" in line for line in text.splitlines())
        inner += [
            node.module
            for node in parsed(text)
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(("mcgw.", "analytic."))
            and node.module.count(".") > 1
        ]  # fmt: skip
    assert len(inner) + len(MODULES) <= 112
    assert patches <= 146

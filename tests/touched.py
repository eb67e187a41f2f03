"""Which files of tests a change can reach: `python -m pytest --touched` collects those alone.

A change is what git sees since the branch left main, and what is not committed yet. A file is reached if it
imports what has changed, however many steps away; if it says the name of a command or of a function that
`mcgw` imports on demand; and if it names a changed file that is no module, as a scene or a page.
"""

import ast
import subprocess
from functools import cache
from pathlib import Path

from oracles.inside import HOME

import mcgw
from mcgw.cli import COMMANDS

ROOT = Path(__file__).parent.parent
TREES = ("analytic", "mcgw", "tests")


def changed():
    """Paths that differ from main, without a merge in between, or are not committed."""

    def lines(*words):
        done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
        return done.stdout.splitlines()

    base = lines("merge-base", "main", "HEAD") or lines("merge-base", "origin/main", "HEAD") or ["HEAD"]
    found = lines("diff", "--name-only", base[0]) + lines("ls-files", "--others", "--exclude-standard")
    return {ROOT / name for name in found}


def module_of(path):
    """Name under which a file is imported."""
    if path.is_relative_to(ROOT / "tests"):
        return f"oracles.{path.stem}" if path.parent.name == "oracles" else path.stem
    inside = path.relative_to(ROOT)
    return ".".join(inside.with_suffix("").parts).removesuffix(".__init__")


@cache
def files():
    """Every Python file by the name of its module."""
    return {module_of(path): path for tree in TREES for path in sorted((ROOT / tree).rglob("*.py"))}


def named(tree):
    """Names of modules that a file imports, some of them through the names that `mcgw` gives on demand."""
    for node in ast.walk(tree):
        match node:
            case ast.Import(names=names):
                yield from (alias.name for alias in names)
            case ast.ImportFrom(module=str(module), names=names):
                yield module
                yield from (f"{module}.{alias.name}" for alias in names)
                if module == "mcgw":
                    yield from (f"mcgw.{mcgw._HOME.get(alias.name, '')}" for alias in names)
                elif module == "oracles.inside":
                    yield from (HOME[alias.name] for alias in names if alias.name in HOME)
            case ast.Attribute(value=ast.Name(id="mcgw"), attr=name):
                yield f"mcgw.{mcgw._HOME.get(name, '')}"


def asked_for(tree):
    """Names of modules that a file of tests asks for by a command line or by drawing a result."""
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(attr="plot"):
                yield "mcgw.figures.plotting"
            case ast.Constant(value=str(text)):
                words = text.removeprefix("mcgw ").split()
                yield from (f"mcgw.commands.{word}" for word in words[:1] if word in COMMANDS)


class Run(ast.NodeTransformer):
    """A file without what only type checkers read."""

    def visit_If(self, node):
        return None if ast.unparse(node.test) == "TYPE_CHECKING" else node


def imports(path):
    """Files that one imports."""
    tree = Run().visit(ast.parse(path.read_text()))
    names = {*named(tree), *(asked_for(tree) if path.is_relative_to(ROOT / "tests") else ())}
    return {files()[name] for name in names if name in files()} - {path}


def reached():
    """Files of tests, and modules with examples, that a change can reach."""
    begun = changed()
    importers = {}
    for path in files().values():
        for other in imports(path):
            importers.setdefault(other, set()).add(path)
    others = {path.name for path in begun if path.suffix != ".py"}
    todo = [path for path in begun if path.suffix == ".py"]
    todo += [p for p in files().values() if others and any(name in p.read_text() for name in others)]
    found = set()
    while todo:
        path = todo.pop()
        if path not in found:
            found.add(path)
            todo.extend(importers.get(path, ()))
    return found

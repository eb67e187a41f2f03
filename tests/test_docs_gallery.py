"""The gallery and the notebooks: short, one picture each, with what `import mcgw` gives and our colours."""

import ast
import json
import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

ROOT = Path(__file__).parent.parent
SCRIPTS = sorted((ROOT / "runs" / "gallery").glob("*.py"))
NOTEBOOKS = sorted((ROOT / "runs" / "notebooks").glob("*.py"))
MOST_LINES = 40
PUBLIC = {"mcgw", "mcgw.figures.style", "matplotlib.pyplot", "numpy", "scipy.stats", "tempfile"}


def lines_of_code(text):
    """Lines with a statement on them, without the head of the page, comments and empty lines."""
    _head, *body = ast.parse(text).body
    return {line for node in body for line in range(node.lineno, node.end_lineno + 1)} & {
        k for k, line in enumerate(text.splitlines(), 1) if line.strip() and not line.strip().startswith("#")
    }


def imports(text):
    for node in ast.walk(ast.parse(text)):
        match node:
            case ast.Import(names=names):
                yield from (name.name for name in names)
            case ast.ImportFrom(module=module):
                yield module


def cells(script):
    """Cells of a script as jupytext reads it: their kind and their text."""
    _, _, body = script.partition("# %%")
    for cell in body.split("\n# %%"):
        first, _, rest = cell.partition("\n")
        if "[markdown]" in first:
            rest = "\n".join(line.removeprefix("#").removeprefix(" ") for line in rest.splitlines())
        yield ("markdown" if "[markdown]" in first else "code"), rest.strip()


def test_there_are_enough():
    assert len(SCRIPTS) >= 15
    assert len(NOTEBOOKS) >= 3


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_is_a_short_answer_to_a_question(path):
    text = path.read_text()
    title = ast.get_docstring(ast.parse(text)).splitlines()[0]
    assert title.endswith("?")
    assert len(lines_of_code(text)) <= MOST_LINES
    assert set(imports(text)) <= PUBLIC


@pytest.mark.slow
@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_draws_one_picture(path):
    """As the site does, which runs them all again."""
    plt.close("all")
    runpy.run_path(str(path))
    (number,) = plt.get_fignums()
    for ax in plt.figure(number).axes:
        assert ax.get_xlabel()
        assert ax.lines or ax.collections or ax.patches
    plt.close("all")


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_its_script(path):
    """Cell by cell, without outputs."""
    notebook = json.loads(path.with_suffix(".ipynb").read_text())
    found = [(cell["cell_type"], "".join(cell["source"]).strip()) for cell in notebook["cells"]]
    assert found == list(cells(path.read_text()))
    assert not any(cell.get("outputs") for cell in notebook["cells"])
    assert set(imports(path.read_text())) <= PUBLIC


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_the_script_of_a_notebook_runs(path, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(path))
    plt.close("all")

"""Gallery and notebooks: one picture each, with what users have; numbers that pages name, by theory."""

import ast
import json
import math
import re
import runpy

import numpy as np
import pytest
from oracles.docs_site import ROOT

import analytic

SCRIPTS = sorted((ROOT / "runs" / "gallery").glob("*/*.py"))
NOTEBOOKS = sorted((ROOT / "runs" / "notebooks").glob("*.py"))
PUBLIC = {"mcgw", "mcgw.figures.style", "matplotlib.pyplot", "numpy", "scipy.stats", "tempfile"}


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


def test_pages_use_what_users_have():
    """No script and no notebook imports what is not public."""
    assert SCRIPTS
    assert NOTEBOOKS
    for path in SCRIPTS + NOTEBOOKS:
        assert set(imports(path.read_text())) <= PUBLIC, path


def test_a_notebook_is_its_script():
    """Cell by cell, without outputs."""
    for path in NOTEBOOKS:
        notebook = json.loads(path.with_suffix(".ipynb").read_text())
        found = [(cell["cell_type"], "".join(cell["source"]).strip()) for cell in notebook["cells"]]
        assert found == list(cells(path.read_text())), path
        assert not any(cell.get("outputs") for cell in notebook["cells"])


# --- numbers --------------------------------------------------------------------------------------------

SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3e8, nominal_area=1e-6, E_star=78.6e9)


def says(script, words):
    (path,) = [path for path in SCRIPTS if path.stem == script]
    return words in " ".join(path.read_text().split())


def test_size_of_a_specimen():
    """Scatter goes as one over the root of the area; the specimen of the model is 1 mm^2."""
    model = analytic.Model(SURFACE)
    h = model.separation_at("pressure", 1e6)
    area = (model.std("load", h) / model.mean("load", h) / 0.1) ** 2
    assert area == pytest.approx(50, rel=0.05)
    assert says("specimen_size", "at 1 MPa this surface needs about 50 mm² for a scatter of 10 %")


@pytest.mark.parametrize(("gamma", "factor"), [(2.0, 1.5), (0.5, 2.5)])
def test_area_over_load(gamma, factor):
    model = analytic.Model(SURFACE, grading=analytic.Exponential(gamma))
    light, heavy = (model.mean("area", model.separation_at("pressure", p)) / p for p in (1e3, 1e8))
    assert light / heavy == pytest.approx(factor, abs=0.05)
    assert says("area_and_load", "a factor of 1.5 to 2.5")


def test_number_of_spots():
    model = analytic.Model(SURFACE)
    few, many = (model.mean("contacts", model.separation_at("pressure", p)) for p in (1e5, 1e7))
    assert many / few == pytest.approx(50, rel=0.05)
    assert says("spot_sizes", "A hundred times the pressure makes fifty times as many spots")


def test_ra_for_sigma():
    """Loads go as sigma^(3/2) F_3/2(d/sigma)."""
    errors = []
    for alpha in np.geomspace(1.6, 100, 30):
        wrong = math.sqrt(2 / math.pi) / analytic.SpectralMoments(1.0, 1.0, alpha).sigma
        errors.append(wrong**1.5 * analytic.fn(1.5, 2 / wrong) / analytic.fn(1.5, 2.0))
    assert 1 / min(errors) == pytest.approx(6, abs=0.3)
    assert 3 < max(errors) < 6
    assert says("ra_for_sigma", "here by up to six times")


@pytest.mark.parametrize(("pressure", "more"), [(1e4, 1.2), (1e7, 1.4)])
def test_laws_of_yielding(pressure, more):
    hertz, metal = analytic.Model(SURFACE), {"poisson": 0.33}
    laws = (
        analytic.laws.KogutEtsion(hardness=1.2e9, **metal),
        analytic.laws.JacksonGreen(yield_strength=0.43e9, **metal),
    )
    models = hertz, *(analytic.Model(SURFACE, law=law) for law in laws)
    elastic, kogut, jackson = (m.mean("area", m.separation_at("pressure", pressure)) for m in models)
    assert jackson / kogut == pytest.approx(more, abs=0.05)
    assert 5.5 < kogut / elastic < jackson / elastic < 11.5
    assert says("laws_compared", "is a fifth to two fifths larger than Kogut and Etsion's")


def test_errata_have_their_proofs(capsys):
    """Each row of the table is proved, and the numbers of the page are among those printed."""
    names = runpy.run_path(str(ROOT / "runs" / "errata.py"))
    proofs = list(names["proofs"]())
    assert names["integral"](1.5, 1.0, 1.5) == pytest.approx(0.108021770156762, rel=1e-12)  # 50 digits
    page = (ROOT / "runs" / "ERRATA.md").read_text()
    rows = re.findall(r"^\| (?:text after )?(\d+)", page, flags=re.MULTILINE)
    assert set(rows) == {equation for equation, *_ in proofs}
    printed = " ".join(" ".join(row) for row in proofs)
    for number in ("1.727", "0.548", "3.114", "1.550"):
        assert number in printed
        assert number in page

"""The page of published figures: every one is computed, and a wrong one shows."""

import importlib
import math
from pathlib import Path

import pytest
from scipy.integrate import quad

FOLDER = Path(__file__).parents[2] / "runs" / "validation"
PARTS = ("summits", "conductance", "joints", "asperities")

pytestmark = pytest.mark.site


@pytest.fixture(scope="module")
def at():
    """The modules of the page by name; scripts find each other in their folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(FOLDER))
        names = ("from_print", *(f"from_print_{part}" for part in PARTS))
        yield {name: importlib.import_module(name) for name in names}


@pytest.fixture(scope="module")
def rows(at):
    page = at["from_print"]
    printed = page.read("print.csv")
    return {row.name: row for part in page.PARTS.values() for row in page.rows(part, printed)}


def test_every_line_is_computed_once_and_has_a_source(at, rows):
    page = at["from_print"]
    parts = page.PARTS.values()
    names = [line["name"] for line in page.read("print.csv")]
    assert sorted(names) == sorted(name for part in parts for name in part.FIGURES) == sorted(rows)
    claims = sorted(line["name"] for line in page.read("print_claims.csv"))
    assert claims == sorted(name for part in parts for name in part.CLAIMS)
    for row in rows.values():
        assert all((row.source, row.seen_at, row.note)), row.name
        assert math.isfinite(row.deviation), row.name
        assert row.printed > 0, row.name


def test_limits_are_exact(rows):
    """Bush, Gibson and Thomas; Persson's light load from his own stress distribution; exponential heights."""
    asperities = rows["area over load, vanishing load"].ours
    assert asperities == pytest.approx(math.sqrt(2 * math.pi), rel=1e-6)
    load, width = 1e-4, 0.5  # over E* g: stresses of full contact have deviation E* g/2

    def in_contact(stress):  # the Gaussian of full contact and its image at the other side of 0
        return math.exp(-(((stress - load) / width) ** 2) / 2) - math.exp(
            -(((stress + load) / width) ** 2) / 2
        )

    share = quad(in_contact, 0, 6, epsabs=0, epsrel=1e-10)[0] / (width * math.sqrt(2 * math.pi))
    persson = rows["area over load, Persson"]
    assert persson.printed == pytest.approx(share / load, rel=1e-6)
    assert persson.ours / persson.printed == pytest.approx(math.pi / 2, rel=1e-6)
    assert rows["mean pressure, exponential heights"].ours == pytest.approx(math.pi**-0.5, rel=1e-6)


def test_summits_are_those_of_a_gaussian_surface(rows):
    """In closed form: the densities and relations behind the printed digits."""
    exact = {
        "mean height of the summits": 4 / math.sqrt(math.pi),
        "spread of the summit heights": 1 + 16 / math.pi - 3 * math.sqrt(3),
        "distance of the mean planes": 1 / (math.sqrt(48) * math.pi),
        "bandwidth from η R σ": 768 * math.pi,
    }
    for name, value in exact.items():
        assert rows[name].ours == pytest.approx(value, rel=1e-9), name
        assert abs(rows[name].deviation) < 0.01, name


def test_a_wrong_number_shows(at, rows):
    """A coefficient misprinted by a tenth, and two wrong readings of Mikic's, whose fits are near."""
    page, conductance = at["from_print"], at["from_print_conductance"]
    name = "elastic coefficient, Mikic's own model"
    for near in (name, "plastic coefficient, truncation model"):
        assert abs(rows[near].deviation) < 1, near
    (line,) = [line for line in page.read("print.csv") if line["name"] == name]
    (row,) = page.rows(conductance, [{**line, "printed": "1.705"}])
    assert row.deviation < -8
    whole_area = conductance.by_truncation(1e-3, 1.0) / 1e-3**0.94
    assert abs(whole_area / row.ours - 1) > 0.2
    without_root = conductance.elastic(conductance.own_radii(10.0), math.sqrt(2) * 1e-3) / 1e-3**0.94
    assert abs(without_root / 1.55 - 1) > 0.3


def test_page_has_every_joint_and_every_miss(at, rows, monkeypatch):
    """And what is missing; with the figures that were computed already."""
    page = at["from_print"]
    monkeypatch.setattr(page, "rows", lambda part, _: [rows[name] for name in part.FIGURES])
    text = page.page(page.sheet(), page.claims_sheet())
    shown = {name for name, row in rows.items() if abs(float(f"{row.deviation:.2g}")) > 10} | set(
        at["from_print_joints"].FIGURES
    )
    assert {name for name in rows if f"| {name} |" in text or f"| {name}, in" in text} == shown
    assert "5 claims without a number 5 hold" in text
    assert all(line in text for line in page.NOT_DONE)

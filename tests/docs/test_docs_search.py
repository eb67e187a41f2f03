"""Words that a user types lead to the page that answers, by the search of the built site itself."""

import json
import os
import re
import runpy
import shutil
import subprocess
from pathlib import Path

import pytest
from oracles.docs_site import DOCS, ROOT, WRITTEN, from_the_code

pytestmark = pytest.mark.site

SITE = Path(os.environ.get("MCGW_SITE", DOCS / "_build"))
JOINT, LAW, MAP = "how-to/conductance-of-a-joint", "how-to/law-for-a-joint", "how-to/measured-map"
TABLES, FROM, RA = "how-to/tables-for-other-programs", "how-to/coming-from", "how-to/profiles-and-ra"
WANTED = {
    "thermal contact resistance": JOINT, "thermal contact conductance": JOINT, "contact resistance": JOINT,
    "gap conductance": JOINT, "vacuum": JOINT, "gas": JOINT, "oxide": JOINT, "TCC": "reference/glossary",
    "plastic": LAW, "yield": LAW, "hardness": LAW, "adhesion": LAW, "plasticity index": LAW,
    "contact law": LAW,
    "hysteresis": LAW, "unloading": "explanation/contact-laws", "JKR": LAW, "Kogut Etsion": LAW,
    "ISO 25178": "how-to/numbers-of-iso", "roughness": "explanation/roughness", "Ra": RA, "profile": RA,
    "height map": MAP, "missing points": MAP, "spectrum": "how-to/which-model",
    "coating": "tutorials/map-to-conductance",
    "Greenwood Williamson": FROM, "tamaas": FROM, "asperity": "reference/glossary", "Abaqus": TABLES,
    "COMSOL": TABLES, "Slurm": "how-to/cluster", "units": "how-to/units",
    "pandas": "how-to/xarray-and-pandas",
    "boundary elements": "how-to/elastic-means", "friction": "explanation/validity",
    "stiffness": "how-to/known-load",
    "how many surfaces": "how-to/speed-and-accuracy", "residuals": "how-to/monte-carlo-against-theory",
    "paper figures": "how-to/monte-carlo-against-theory", "convergence": "how-to/statistical-convergence",
    "seed": "explanation/same-bits", "install": "tutorials/first-contact",
}  # fmt: skip


@pytest.fixture(scope="module")
def found():
    """Pages of the results of each query, the best first."""
    if not (SITE / "searchindex.js").exists():
        pytest.skip(f"no built site at {SITE}")
    if shutil.which("node") is None:
        pytest.skip("no node to run the search of the site")
    command = ["node", ROOT / "tests/oracles/site_search.js", SITE]
    words = "\n".join([*WANTED, "lubrikation"])
    done = subprocess.run(command, input=words, capture_output=True, text=True, timeout=60, check=True)
    return json.loads(done.stdout)


@pytest.mark.parametrize("query", WANTED)
def test_a_word_leads_to_its_page(found, query):
    assert WANTED[query] in found[query][:3], found[query][:5]
    names = [k for k, page in enumerate(found[query]) if page.startswith("reference/api/")]
    assert min(names, default=9) > 1, "pages stand before names"


def test_a_word_that_no_page_has_leads_nowhere(found):
    assert len(WANTED) >= 30
    assert not found["lubrikation"]


def test_links_of_the_site_lead_somewhere():
    """Of every page, also those that Sphinx and the gallery make; parts of a page too."""
    pages = {
        path: path.read_text(encoding="utf-8") for path in SITE.rglob("*.html") if "_static" not in path.parts
    }
    if not pages:
        pytest.skip(f"no built site at {SITE}")
    parts = {path: set(re.findall(r'\bid="([^"]+)"', text)) for path, text in pages.items()}
    dead = set()
    for path, text in pages.items():
        for target, _, part in re.findall(r'(?:href|src)="([^"#?:]*)(\?[^"#]*)?(?:#([^"]*))?"', text):
            place = path.parent.joinpath(target).resolve() if target else path
            if not place.exists() or (part and place in parts and part not in parts[place]):
                dead.add((path.relative_to(SITE).as_posix(), target, part))
    assert not dead


def test_the_words_of_the_index_are_of_pages_that_exist():
    words = runpy.run_path(str(DOCS / "search_words.py"))["WORDS"]
    assert {f"{page}.md" for page in words} <= {*WRITTEN, *from_the_code().pages()}

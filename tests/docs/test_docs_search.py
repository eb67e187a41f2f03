"""Words that a user types lead to the page that answers, by the index of the built site."""

import json
import os
import re
from pathlib import Path

import pytest
from oracles.docs_site import DOCS

pytestmark = pytest.mark.site

INDEX = Path(os.environ.get("MCGW_SITE", DOCS / "_build")) / "searchindex.js"
WANTED = {
    "thermal contact conductance": "how-to/conductance-of-a-joint", "TCC": "reference/glossary",
    "contact resistance": "reference/glossary", "gap conductance": "reference/glossary",
    "vacuum": "how-to/conductance-of-a-joint", "TIM": "reference/glossary",
    "hysteresis": "explanation/contact-laws",
    "asperity": "reference/glossary", "unloading": "explanation/contact-laws",
    "roughness": "explanation/roughness", "Ra": "how-to/profiles-and-ra", "Rq": "reference/glossary",
    "Greenwood Williamson": "how-to/coming-from", "tamaas": "how-to/coming-from",
    "SurfaceTopography": "how-to/coming-from", "height map": "how-to/which-model",
    "profile": "how-to/profiles-and-ra", "plastic": "explanation/contact-laws",
    "hardness": "how-to/law-for-a-joint", "adhesion": "how-to/law-for-a-joint",
    "JKR": "explanation/contact-laws", "coating": "tutorials/map-to-conductance",
    "oxide film": "how-to/which-model", "interaction": "explanation/interaction",
    "bandwidth": "reference/glossary", "Abaqus": "how-to/tables-for-other-programs",
    "CalculiX": "how-to/tables-for-other-programs", "Slurm": "how-to/cluster",
    "units": "how-to/units", "boundary elements": "explanation/validation",
    "pandas": "how-to/xarray-and-pandas", "friction": "explanation/validity",
}  # fmt: skip


@pytest.fixture(scope="module")
def index():
    if not INDEX.exists():
        pytest.skip(f"no built site at {INDEX.parent}")
    return json.loads(re.fullmatch(r"Search\.setIndex\((.*)\)", INDEX.read_text(), flags=re.DOTALL)[1])


def leads_to(index, query):
    """Pages that have every word, in their text or their title."""
    stem = pytest.importorskip("snowballstemmer").stemmer("english").stemWord
    found = None
    for word in query.lower().split():
        pages = set()
        for table in (index["terms"], index["titleterms"]):
            at = table.get(stem(word), [])
            pages |= {at} if isinstance(at, int) else set(at)
        found = pages if found is None else found & pages
    return {index["docnames"][k] for k in found}


@pytest.mark.parametrize("query", WANTED)
def test_a_word_leads_to_its_page(index, query):
    assert WANTED[query] in leads_to(index, query)


def test_a_word_that_no_page_has_leads_nowhere(index):
    assert len(WANTED) >= 30
    assert not leads_to(index, "lubrikation")
    assert not any("copied" in name for name in index["docnames"])

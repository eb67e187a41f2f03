"""No text of the project has one of these expressions: riddles, inverted order, private words."""

import re

import pytest
from oracles.docs_site import MADE, ROOT

PHRASES = [
    "is told", "are told", "its surfaces are none", "no map can tell", "says nothing", "shortly",
    "of this model agree", "goes on where it stopped", "bears; metals",
    "in the place of", "command goes on", "sweep goes on", "seed goes on", "nobody told", "no one told",
    "belongs into", "speaks against", "none is asked for", "act one by one", "can be had", "gone on with",
    "going on where", "knows its way back", "in the making", "sinks the ground", "the very summits",
    "the very heights", "very same", "off elasticity", "outside of what was measured", "parted by",
    "shared out", "the gravest", "of one's own", "what would do", "the other way round", "turns round",
    "made anew", "take higher separations", "leaves double precision", "lacks all of", "counts from",
    "how far from elasticity", "shows itself", "show themselves", "says all", "what stands behind",
    "the way back", "a law of your own", "noise of its own", "bears nothing", "come back the way it went",
]  # fmt: skip
PLACES = ("*.md", "docs/*.md", "docs/*/*.md", "runs/*.md", "runs/*/*.md", "runs/gallery/**/*.py")
PLACES += ("runs/notebooks/*.py", "mcgw/**/*.py", "analytic/**/*.py")


def found(text):
    here = [phrase for phrase in PHRASES if phrase in text]  # quicker than to search for each
    return [phrase for phrase in here if re.search(rf"\b{re.escape(phrase)}\b", text)]


@pytest.mark.parametrize("place", PLACES)
def test_no_text_has_them(place):
    made = tuple(f"docs/{name}" for name in MADE)
    paths = [p for p in ROOT.glob(place) if not str(p.relative_to(ROOT)).startswith(made)]
    assert paths
    has = {str(p.relative_to(ROOT)): found(" ".join(p.read_text(encoding="utf-8").split())) for p in paths}
    assert not {name: phrases for name, phrases in has.items() if phrases}


def test_they_are_seen():
    for phrase in PHRASES:
        assert found(f"A line that {phrase}, and ends.") == [phrase]

"""The draft paper: each of its numbers is what its script computes."""

import json
import re
import sys

import pytest
from oracles.docs_site import DOCS

FOLDER = DOCS / "paper"
sys.path[:0] = [str(DOCS), str(FOLDER)]
import paper_numbers  # noqa: E402

del sys.path[:2]

pytestmark = pytest.mark.site

PAPER = (FOLDER / "paper.md").read_text(encoding="utf-8")
SOURCE = (FOLDER / "paper.md.in").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def computed():
    return paper_numbers.numbers()


def test_numbers_are_those_of_the_script(computed):
    """If one differs: run the script, and read whether what the text says of it still holds."""
    assert json.loads(paper_numbers.NUMBERS.read_text(encoding="utf-8")) == computed
    assert paper_numbers.paper(computed) == PAPER


def test_a_wrong_number_would_be_seen(computed):
    for name, value in computed.items():
        assert paper_numbers.paper(computed | {name: f"{value}1"}) != PAPER, f"{name} is not in the paper"


def test_no_number_is_written_by_hand():
    """Beside the head: digits stand only in code, in names of files, and in keys of references."""
    text = SOURCE.split("---\n", 2)[2]
    text = re.sub(r"`[^`\n]+`|\]\([^)]+\)|\[@[^\]]+\]|\{\w+\}|HDF5|h5py", "", text)
    assert not re.findall(r"^.*\d.*$", text, flags=re.MULTILINE)


def test_what_the_text_says_in_words_holds(computed):
    """Claims that stand beside the numbers."""

    def size(name):
        return float(re.match(r"[\d.]+", computed[name])[0])

    assert size("conducts_stiff") < 1 < size("conducts_soft")
    assert size("area_narrow") < size("area_middle") < size("area_least") < size("area_most")
    assert size("area_narrow") < size("area_one_radius") / 5
    assert size("stiffness_together") < size("stiffness_alone") / 5
    assert size("demo_p") > 0.001
    assert abs(size("spread_drawn") / size("spread_exact") - 1) < 0.03  # 5 standard errors of 20 000 surfaces
    assert computed["exact_to"] == "$10^{-12}$"
    assert computed["solve_hours"] in (FOLDER.parents[1] / "runs" / "validation" / "README.md").read_text()

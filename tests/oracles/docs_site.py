"""The pages of the site as the tests see them, without Sphinx: their text, their code, their links."""

import re
import sys
import textwrap
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
MADE = [  # by the code itself, when the site is built
    line.removeprefix("docs/")
    for line in (ROOT / ".gitignore").read_text().splitlines()
    if line.startswith("docs/")
]
WRITTEN = sorted(
    place
    for place in (path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md"))
    if not place.startswith((*MADE, "paper/"))
)
_BLOCK = re.compile(r"^( *)```(python|sh|toml|text)\n(.*?)^ *```$", flags=re.DOTALL | re.MULTILINE)


def blocks(text):
    """Kind and text of each block of code, in their order."""
    return [(kind, textwrap.dedent(code)) for _, kind, code in _BLOCK.findall(text)]


def file_name(code):
    """What a block is called in its first line, if it is a file: a comment of one word with an ending."""
    found = re.match(r"# ([\w-]+\.\w+)\n", code)
    return found and found[1]


@cache
def from_the_code():
    """The module beside the pages that makes the others."""
    sys.path.insert(0, str(DOCS))
    try:
        import from_the_code
    finally:
        sys.path.remove(str(DOCS))
    return from_the_code


@cache
def pages():
    """Text of every page by its place, those that are made too."""
    made = from_the_code().pages()
    assert all(name.startswith(tuple(MADE)) for name in made), "git would take a page that is made"
    return {name: (DOCS / name).read_text() for name in WRITTEN} | made

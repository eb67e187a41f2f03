"""TOML that may come from a stranger: what would keep the parser busy for hours is refused first."""

import re
import tomllib
from typing import Any

__all__ = ["loads"]

_MOST_PARTS = 100  # of a dotted key: the parser's time grows as their square
_DEEPEST = 100  # brackets within brackets: the parser calls itself for each
_ASIDE = re.compile(
    r'"""(?:[^"\\]|\\.|"(?!""))*+(?:"""|\Z)'  # texts, to their ends or to where they break off
    r"|'''(?:[^']|'(?!''))*+(?:'''|\Z)"
    r'|"(?:[^"\\\n]|\\.)*+(?:"|$)'
    r"|'[^'\n]*+(?:'|$)"
    r"|\#[^\n]*+",
    re.DOTALL | re.MULTILINE,
)
_LONG_KEY = re.compile(rf"(?<![\w-])(?:[\w-]++[ \t]*+\.[ \t]*+){{{_MOST_PARTS}}}")


def loads(text: str) -> dict[str, Any]:
    """Read a TOML document as `tomllib.loads`, in a time that grows no faster than its length.

    Raises
    ------
    ValueError
        If it is not TOML, a key has a hundred parts, or brackets are nested a hundred deep.
    """
    plain = _ASIDE.sub(lambda found: "" if found[0].startswith("#") else "t", text)
    if _LONG_KEY.search(plain):
        raise ValueError(f"a dotted key has more than {_MOST_PARTS} parts")
    depth = 0
    for bracket in re.findall(r"[\[\]{}]", plain):
        depth = depth + 1 if bracket in "[{" else max(depth - 1, 0)
        if depth > _DEEPEST:
            raise ValueError("nested too deeply")
    return tomllib.loads(text)

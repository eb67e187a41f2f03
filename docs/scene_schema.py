"""The JSON Schema of scenes, from which editors complete, and the page of keys; run it to write both.

Tables, keys, what may stand there and what it means are the rows of `mcgw.scene.keys`. A test holds both
files to them.
"""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from textwrap import wrap
from typing import Any

from mcgw.scene.keys import TABLES
from mcgw.scene.section import table_shape

PAGE = Path(__file__).parent / "reference" / "scene.md"
SCHEMA = Path(__file__).parent.parent / "mcgw" / "scene" / "scene.schema.json"
_START = "## Top of the file"

Shape = dict[str, Any]


def schema() -> Shape:
    """The schema, draft 2020-12."""
    top = table_shape(TABLES[""].rows)
    for name, table in TABLES.items():
        outer, _, inner = name.rpartition(".")
        if name:
            shape = {"description": plain(table.words)} | table_shape(table.rows)
            around = top["properties"][outer] if outer else top
            around["properties"][inner] = shape
    law = top["properties"]["contact"]["properties"]["law"]  # of one word, too
    top["properties"]["contact"]["properties"]["law"] = {
        "description": law.pop("description"),
        "anyOf": [law, law["properties"]["name"]],
    }
    top["required"] = [name for name, table in TABLES.items() if table.required]
    described(top)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Scene of mcgw", **top}


def described(shape: Any) -> None:
    """Take links and marks out of all descriptions."""
    for inner in shape.values() if isinstance(shape, dict) else shape if isinstance(shape, list) else ():
        described(inner)
    if isinstance(shape, dict) and isinstance(shape.get("description"), str):
        shape["description"] = plain(shape["description"])


def plain(markdown: str) -> str:
    """Without links and marks."""
    words = re.sub(r"\[([^\]]+)\]\([^)]+\)", r"\1", markdown)
    return re.sub(r"\\(.)", r"\1", words.replace("`", ""))


def page() -> str:
    """The page: its beginning as it is, then a table for each of a scene."""
    head, start, _ = PAGE.read_text(encoding="utf-8").partition(_START)
    return head + "\n".join([start, *list(tables())[1:]])


def tables() -> Iterator[str]:
    """Its lines."""
    for name, table in TABLES.items():
        yield f"## `[{name}]`"
        yield from ("", *wrap(table.words, 120, break_on_hyphens=False)) if table.words else ()
        yield from ("", "| key | example | meaning |", "|---|---|---|")
        yield from (f"| `{row.name}` | `{row.example}` | {row.words} |" for row in table.rows)
        yield ""


def text() -> str:
    """What the file of the schema holds: a line for each key."""
    return "".join(lines(schema(), "")) + "\n"


def lines(shape: Shape, indent: str) -> Iterator[str]:
    """A table, whose keys may be tables."""
    comma = "{"
    for key, inner in shape.items():
        yield f"{comma}\n{indent} {json.dumps(key)}: "
        opened = (
            isinstance(inner, dict) and (key == "properties" or "properties" in inner) and len(indent) < 4
        )
        yield from (
            lines(inner, f"{indent} ") if opened else [json.dumps(inner, ensure_ascii=False, allow_nan=False)]
        )
        comma = ","
    yield f"\n{indent}}}"


if __name__ == "__main__":
    SCHEMA.write_text(text(), encoding="utf-8")
    PAGE.write_text(page().rstrip() + "\n", encoding="utf-8")
    print(SCHEMA, PAGE, sep="\n")

"""The JSON Schema of scenes, from which editors complete, and the page of keys; run it to write both.

Tables, keys and what may stand there are the rows of `mcgw.scene.keys`, and what a key means is told there or
by the docstring of what is made of it. A test holds both files to them.
"""

import inspect
import json
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from textwrap import wrap
from typing import Any

import mcgw
from mcgw.scene.keys import TABLES as ROWS
from mcgw.scene.section import Key, table_shape

PAGE = Path(__file__).parent / "reference" / "scene.md"
SCHEMA = Path(__file__).parent.parent / "mcgw" / "scene" / "scene.schema.json"
_START = "## Top of the file"

Shape = dict[str, Any]
DOCUMENTED = {
    "surface": (mcgw.Surface, mcgw.SpectralSurface),
    "interaction": (mcgw.Interaction,),
}


def parameters(documented: Any) -> dict[str, str]:
    """Return the words of each parameter of a docstring, as Markdown."""
    told = (inspect.getdoc(documented) or "").partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    found = re.findall(r"^(\w[\w, ]*) : .*\n((?: +.*\n?)+)", told, re.M)
    return {name: markdown(words) for names, words in found for name in names.split(", ")}


def markdown(words: str) -> str:
    """Return words of a docstring as those of a page: one line, each code between single marks."""
    return " ".join(words.split()).replace("*", r"\*").replace("``", "`")


def in_words(name: str) -> tuple[Key, ...]:
    """Return the rows of a table, each with its words."""
    found: dict[str, str] = {}
    for documented in DOCUMENTED.get(name, (ROWS[name].make,)):
        found = parameters(documented) | found
    return tuple(replace(row, words=row.words or found[row.name]) for row in ROWS[name].rows)


TABLES = {name: table._replace(rows=in_words(name)) for name, table in ROWS.items()}


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

"""The JSON Schema of scenes, from which editors complete, and the page of keys; run it to write both.

Tables, keys and what may stand there are the rows of `mcgw.scene.keys`, and what a key means is told there or
by the docstring of what is made of it. A test holds both files to them.
"""

import json
import math
import re
from collections.abc import Iterator
from dataclasses import replace
from inspect import getdoc, signature
from pathlib import Path
from textwrap import wrap
from typing import Any

import mcgw
from mcgw.scene.keys import TABLES as ROWS
from mcgw.scene.kinds import MOST_WHOLE, Either, Kind, List, Number, Plain, Table, Whole, Word
from mcgw.scene.laws import LAWS
from mcgw.scene.section import Key

PAGE = Path(__file__).parent / "reference" / "scene.md"
SCHEMA = Path(__file__).parent.parent / "mcgw" / "scene" / "scene.schema.json"
_START = "## Top of the file"

Shape = dict[str, Any]
DOCUMENTED: dict[str, tuple[Any, ...]] = {
    "surface": (mcgw.Surface, mcgw.SpectralSurface),
    "grading": (mcgw.Graded, *LAWS["grading"].values()),
    "heights": (*LAWS["heights"].values(),),
    "contact.law": (*LAWS["contact.law"].values(),),
    "interaction": (mcgw.Interaction,),
}


# Units are checked by the program, which knows more spellings than a pattern could.
WITH_UNIT = {"type": "string", "pattern": r"^\s*\+?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*([^\d\s.].*|1/.*)?$"}


def shape_of(kind: Kind) -> Shape:
    """Return a kind of values as JSON Schema."""
    match kind:
        case Whole():
            most = {"maximum": kind.high} if kind.high < MOST_WHOLE else {}
            return {"type": "integer", "minimum": kind.low, **most}
        case Number():
            return number(kind)
        case Word():
            return {"enum": list(kind.words)}
        case Plain() if kind.type is bool:
            return {"type": "boolean"}
        case Plain():
            return {"type": "string", **({} if kind.empty else {"minLength": 1})}
        case List():
            shape: Shape = {"type": "array", "items": shape_of(kind.item)}
            shape |= {"minItems": kind.least} if kind.least else {}
            shape |= {"maxItems": kind.most} if kind.most < 1000 else {}
            return shape | ({"uniqueItems": True} if kind.once else {})
        case Table(item=None):
            return table_shape(kind.rows)
        case Table():
            names = {"propertyNames": {"enum": list(kind.names)}, "minProperties": 1} if kind.names else {}
            return {"type": "object", "additionalProperties": shape_of(kind.item), **names}
        case Either():
            shapes = map(shape_of, kind.kinds)
            return {"anyOf": [each for shape in shapes for each in shape.get("anyOf", [shape])]}
    raise TypeError(f"{type(kind).__name__} has no shape yet")


def number(kind: Number) -> Shape:
    """A range, a text with a unit, or null, which editors show for infinity."""
    shape: Shape = {"type": "number"}
    if kind.low > -math.inf:
        shape["exclusiveMinimum" if kind.low == 0 and not kind.zero else "minimum"] = kind.low
    if kind.high < math.inf and not kind.infinite:
        shape["maximum"] = kind.high
    others = [*([WITH_UNIT] if kind.unit else []), *([{"type": "null"}] if kind.infinite else [])]
    return {"anyOf": [shape, *others]} if others else shape


def table_shape(rows: tuple[Key, ...]) -> Shape:
    """Return an object with these keys only, and which of them go together."""
    told = {row.name: ({"description": row.words} if row.words else {}) | shape_of(row.kind) for row in rows}
    shape: Shape = {"type": "object", "properties": told, "additionalProperties": False}
    replaced = {other for row in rows for other in row.excludes}
    always = [row for row in rows if row.required and not (row.needs or row.excludes)]
    if required := [row.name for row in always if row.name not in replaced]:
        shape["required"] = required
    apart: list[Shape] = []
    for row in rows:
        if row.needs:
            any_of = [{"required": [other]} for other in row.needs]
            shape.setdefault("dependentSchemas", {})[row.name] = {"anyOf": any_of}
        apart += [{"not": {"required": [row.name, other]}} for other in row.excludes]
    return shape | ({"allOf": apart} if apart else {})


def parameters(documented: Any) -> dict[str, str]:
    """Return the words of each parameter of a docstring, as Markdown."""
    told = (getdoc(documented) or "").partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    found = re.findall(r"^(\w[\w, ]*) : .*\n((?: +.*\n?)+)", told, re.M)
    return {name: markdown(words) for names, words in found for name in names.split(", ")}


def markdown(words: str) -> str:
    """Return words of a docstring as those of a page: one line, code between single marks, no other marks."""
    parts = " ".join(words.split()).replace("``", "`").split("`")
    return "`".join(part if k % 2 else part.replace("*", r"\*") for k, part in enumerate(parts))


def in_words(name: str) -> tuple[Key, ...]:
    """Return the rows of a table, each with its words and the laws that it is for."""
    found: dict[str, str] = {}
    for documented in DOCUMENTED.get(name, (ROWS[name].make,)):
        found = parameters(documented) | found  # the first that has it
    rows = []
    for row in ROWS[name].rows:
        laws = [
            f"`{law}`" for law, make in LAWS.get(name, {}).items() if row.name in signature(make).parameters
        ]
        words = markdown(row.words) or found[row.name]
        rows.append(replace(row, words=f"{words.removesuffix('.')} ({', '.join(laws)})" if laws else words))
    return tuple(rows)


TABLES = {name: replace(table, rows=in_words(name)) for name, table in ROWS.items()}


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
        yield from ("", *wrap(markdown(table.words), 120, break_on_hyphens=False)) if table.words else ()
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

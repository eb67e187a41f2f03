"""The JSON Schema of scenes, from which editors complete; ``python docs/scene_schema.py`` writes it.

Tables, keys and what they mean are those of ``docs/reference/scene.md``; what may stand there is told here. A
test holds the file to this, and this to what the code reads.
"""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from analytic import LAW_QUANTITIES, QUANTITIES, UNLOADING
from analytic.laws import by_name
from mcgw.scene.grading_section import NEGATIVE
from mcgw.scene.heights_section import LAWS
from mcgw.scene.samplers import SAMPLERS

PAGE = Path(__file__).parent / "reference" / "scene.md"
SCHEMA = Path(__file__).parent.parent / "mcgw" / "scene" / "scene.schema.json"

Shape = dict[str, Any]

NUMBER: Shape = {"type": "number"}
POSITIVE: Shape = {"type": "number", "exclusiveMinimum": 0}
NOT_NEGATIVE: Shape = {"type": "number", "minimum": 0}
AT_LEAST_ONE: Shape = {"type": "number", "minimum": 1}
NUMBERS: Shape = {"type": "array", "items": NUMBER, "minItems": 1}
TEXT: Shape = {"type": "string"}
FILE: Shape = {"type": "string", "minLength": 1}
YES_NO: Shape = {"type": "boolean"}
# Which unit does is checked by mcgw itself, which knows more spellings than a pattern should.
WITH_UNIT: Shape = {
    "type": "string",
    "pattern": r"^\s*\+?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*([^\d\s.].*|1/.*)?$",
}
QUANTITY: Shape = {"anyOf": [POSITIVE, WITH_UNIT]}
# JSON has no infinity: editors see it as null.
OR_INFINITE: Shape = {"anyOf": [*QUANTITY["anyOf"], {"type": "null"}]}
SHARE: Shape = {"anyOf": [POSITIVE | {"maximum": 0.1}, WITH_UNIT]}
POISSON: Shape = {"type": "number", "minimum": -1, "maximum": 0.5}


def one_of(words: Any) -> Shape:
    """One of a few words."""
    return {"enum": list(words)}


def whole(least: int) -> Shape:
    """A whole number; 1e6 is one."""
    return {"type": "integer", "minimum": least}


def inside(required: str, **properties: Shape) -> Shape:
    """A table in braces; keys that must be there, parted by spaces."""
    required_keys = {"required": required.split()} if required else {}
    return {"type": "object", "properties": properties, "additionalProperties": False, **required_keys}


NAMES = one_of((*QUANTITIES, *LAW_QUANTITIES, *UNLOADING))
PIECE = inside("low high coefficients", low=NUMBER, high=POSITIVE, coefficients=NUMBERS)
PIECES: Shape = {"type": "array", "items": PIECE, "minItems": 1}
BODY = inside("E", E=OR_INFINITE, nu=POISSON)
BY_QUANTITY: Shape = {
    "type": "object",
    "propertyNames": NAMES,
    "minProperties": 1,
    "additionalProperties": {"anyOf": [*SHARE["anyOf"], {"type": "array", "items": OR_INFINITE}]},
}

SHAPES: dict[str, dict[str, Shape]] = {
    "": {"title": TEXT},
    "surface": {
        **dict.fromkeys(("sigma", "radius", "eta", "nominal_area", "E_star", "m0", "m2", "m4"), QUANTITY),
        "bodies": {"type": "array", "items": BODY, "minItems": 2, "maxItems": 2},
    },
    "grading": {
        "law": one_of(("homogeneous", "exponential", "table", "series")),
        "gamma": NUMBER,
        "negative": one_of(NEGATIVE),
        **dict.fromkeys(("s", "ratio", "edges"), NUMBERS),
        "file": FILE,
        "coefficients": {"type": "array", "items": NUMBERS, "minItems": 1},
        "kinks": {"type": "array", "items": NUMBER},
        "name": TEXT,
    },
    "heights": {
        "law": one_of(LAWS),
        "shape": {"type": "number", "minimum": 1, "maximum": 100},
        "alpha": {"type": "number", "exclusiveMinimum": 1.5},
        **dict.fromkeys(("heights", "s", "share"), NUMBERS),
        "file": FILE,
        "resample": YES_NO,
        "name": TEXT,
        "shapes": {"type": "object", "additionalProperties": NUMBER},
    },
    "summits": {
        "curvature": one_of(("random", "mean")),
        "largest_radius": QUANTITY,
        "file": FILE,
        "heights": NUMBERS,
        **dict.fromkeys(("radii", "ratios"), NUMBERS | {"items": POSITIVE}),
        "resample": YES_NO,
    },
    "contact": {
        "separations": {
            "anyOf": [NUMBERS, NUMBER, inside("start stop num", start=NUMBER, stop=NUMBER, num=whole(1))]
        },
        "datum": one_of(("summits", "surface")),
        "quantities": {"type": "array", "items": NAMES, "minItems": 1, "uniqueItems": True},
        "law": one_of((*by_name, "custom")),
        **dict.fromkeys(("hardness", "yield_strength", "c0", "thickness", "work"), QUANTITY),
        **dict.fromkeys(("critical", "yield_strain", "k", "reduced_c0", "reduced_thickness"), POSITIVE),
        **dict.fromkeys(("ratio", "pull_off", "resistivity"), POSITIVE),
        "poisson": POISSON,
        "bridge": one_of(("hermite",)),
        "limits": {"type": "array", "items": POSITIVE},
        **dict.fromkeys(("load", "area"), PIECES),
        "unload_from": {"anyOf": [NUMBER, {"const": "loop"}]},
        "conductivities": {"type": "array", "items": QUANTITY, "minItems": 2, "maxItems": 2},
        "film_resistance": NOT_NEGATIVE,
        "tangential": inside(
            "friction poisson displacements",
            friction=POSITIVE,
            poisson=POISSON,
            displacements={"anyOf": [NUMBERS | {"items": NOT_NEGATIVE}, NOT_NEGATIVE]},
        ),
    },
    "interaction": {
        "reference": one_of(("body", "mean-plane")),
        "at": one_of(("effective", "nominal")),
        "bulk_modulus": QUANTITY,
    },
    "fitted": {
        **dict.fromkeys(("m0", "m2", "m4", "area"), QUANTITY),
        **dict.fromkeys(("kurtosis", "independent"), POSITIVE),
        "skewness": NUMBER,
        **dict.fromkeys(("agreement", "lay"), AT_LEAST_ONE),
    },
    "ensemble": {
        **dict.fromkeys(("n_surfaces", "n_asperities", "max_surfaces"), whole(1)),
        "count": one_of(("fixed", "poisson")),
        "seed": whole(0),
        "sampler": one_of(SAMPLERS),
        "keep": one_of(("sums", "moments", "statistics")),
        "rel_err": {"anyOf": [*SHARE["anyOf"], BY_QUANTITY]},
        "max_seconds": QUANTITY,
        "accuracy": QUANTITY,
        "law_error": {"anyOf": [NOT_NEGATIVE | {"maximum": 0.1}, WITH_UNIT]},
        "edges": {"type": "array", "items": NUMBER},
        "left_out": {"type": "array", "items": one_of(("n_asperities", "seed"))},
    },
}
REQUIRED = {"": ["surface", "contact"], "surface": ["nominal_area"], "contact": ["separations"]}
REQUIRED |= {"interaction": ["reference"]}
REQUIRED |= {"fitted": ["m0", "m2", "m4", "skewness", "kurtosis", "independent"]}
TOGETHER = {"ensemble": {"max_surfaces": ["rel_err"]}}


def rows() -> Iterator[tuple[str, str, str]]:
    """Table, key and meaning of each row of the page; a table itself has the key ""."""
    table, waits = "", False
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            found = re.search(r"`\[(\w+)\]`", line)
            table, waits = found[1] if found else "", found is not None
        elif row := re.match(r"\| `(\w+)` \| `.+?` \| (.+) \|$", line):
            yield table, row[1], plain(row[2])
        elif waits and line:
            yield table, "", plain(line)
            waits = False


def plain(markdown: str) -> str:
    """Without links and marks."""
    words = re.sub(r"\[([^\]]+)\]\([^)]+\)", r"\1", markdown)
    return re.sub(r"\\(.)", r"\1", words.replace("`", ""))


def schema() -> Shape:
    """The schema, draft 2020-12."""
    tables: dict[str, Shape] = {"": {}}
    for table, key, meaning in rows():
        if not key:
            tables[table] = {"description": meaning, **_table(table)}
            tables[""][table] = tables[table]
        else:
            of = tables[""] if not table else tables[table]["properties"]
            of[key] = {"description": meaning, **SHAPES[table][key]}
    top = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Scene of mcgw"}
    return {**top, **_table("", tables[""])}


def _table(name: str, properties: Shape | None = None) -> Shape:
    required = {"required": REQUIRED[name]} if name in REQUIRED else {}
    together = {"dependentRequired": TOGETHER[name]} if name in TOGETHER else {}
    filled = {} if properties is None else properties
    return {"type": "object", "properties": filled, "additionalProperties": False, **required, **together}


def text() -> str:
    """What the file holds."""
    return json.dumps(schema(), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


if __name__ == "__main__":
    SCHEMA.write_text(text(), encoding="utf-8")
    print(SCHEMA)

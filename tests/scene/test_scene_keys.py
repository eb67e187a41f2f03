"""Every key of every table, in one walk: page, schema, right values, wrong ones and a misspelt key."""

import inspect
import json
import re
import sys
import tomllib
from functools import cache
from pathlib import Path

import jsonschema
import pytest
from oracles.docs_site import DOCS, ROOT, WRITTEN, blocks

import mcgw
from mcgw.cli import main
from mcgw.scene.keys import KEYS
from mcgw.scene.section import SceneError, Section

SCHEMA = Path(mcgw.__file__).parent / "scene" / "scene.schema.json"

GOOD = {
    "": {"title": "'x'"},
    "surface": {"sigma": "1e-6", "radius": "1e-5", "eta": "1e9", "nominal_area": "1e-6", "E_star": "1e11"},
    "grading": {"law": "'exponential'", "gamma": "0.5", "negative": "'clip'"},
    "heights": {"law": "'weibull'", "shape": "2.0"},
    "contact": {"separations": "{start = 0.0, stop = 1.0, num = 3}", "quantities": "['load']"},
    "ensemble": {
        "n_surfaces": "10", "n_asperities": "100", "count": "'fixed'", "seed": "1", "sampler": "'cells'",
        "keep": "'sums'", "max_seconds": "1.0", "left_out": "['seed']",
        "accuracy": "1e-3",
    },
}  # fmt: skip
SERIES = {"law": "'series'", "edges": "[0.0, 5.0, 20.0]", "coefficients": "[[1.0, 0.5], [1.5]]"}
PIECE = "[{low = -1.0, high = 1.0, coefficients = [1.0]}, {low = 1.0, high = 3.0, coefficients = [1.0]}]"
CUSTOM = {"law": "'custom'", "critical": "0.05", "limits": "[1.0]", "load": PIECE, "area": PIECE}
NAYAK = {("heights", "law"): "'nayak'", ("heights", "shape"): None, ("heights", "alpha"): "5.0"}
SPECTRAL = {"sigma": None, "radius": None, "eta": None, ("heights", "law"): None, ("heights", "shape"): None}
SPECTRAL |= {"m0": "1e-12", "m2": "1e-3", "m4": "5e6"}
LISTED = {("heights", "law"): None, ("heights", "shape"): None, ("ensemble", "sampler"): "'direct'"}
LISTED |= {"resample": "true"}
HEIGHTS, RADII = {"heights": "[0.0, 1e-6, 3e-6]"}, {"radii": "[1e-5, 2e-5, 3e-5]"}
FITTED = {"m0": "1e-12", "m2": "1e-3", "m4": "5e6"}
FITTED |= {"skewness": "-0.1", "kurtosis": "3.1", "independent": "900.0"}
JOINED = {"gas": "'air'", "rms": "'2 um'", ("contact", "conductivities"): "[150.0, 16.0]"}
# Keys that need other company: its good value, and what is put in place of which other lines.
COMPANY = {
    ("surface", "bodies"): ("[{E = 7e10, nu = 0.3}, {E = inf}]", {"E_star": None}),
    ("ensemble", "rel_err"): ("0.01", {"n_surfaces": None}),
    ("ensemble", "max_surfaces"): ("50", {"n_surfaces": None, "rel_err": "0.01"}),
    ("grading", "s"): ("[0.0, 1.0]", {"gamma": None, "law": "'table'", "ratio": "[1.0, 2.0]"}),
    ("grading", "ratio"): ("[1.0, 2.0]", {"gamma": None, "law": "'table'", "s": "[0.0, 1.0]"}),
    ("grading", "edges"): ("[0.0, 5.0, 20.0]", {"gamma": None, **SERIES, "edges": None}),
    ("grading", "coefficients"): ("[[1.0, 0.5], [1.5]]", {"gamma": None, **SERIES, "coefficients": None}),
    ("grading", "kinks"): ("[5.0]", {"gamma": None, **SERIES}),
    ("grading", "name"): ("'ramp'", {"gamma": None, **SERIES}),
    ("grading", "checked"): ("false", {"gamma": None, **SERIES}),
    ("grading", "file"): ("'g.csv'", {"gamma": None, "law": "'table'"}),
    ("heights", "file"): ("'h.csv'", {"shape": None, "law": "'table'"}),
    ("heights", "heights"): ("[0.0, 1.0, 3.0]", {"shape": None, "law": "'table'"}),
    ("heights", "resample"): ("true", {"shape": None, "law": "'table'", "heights": "[0.0, 1.0, 3.0]"}),
    ("heights", "s"): ("[0.0, 1.0]", {"shape": None, "law": "'table'", "share": "[0.0, 1.0]"}),
    ("heights", "share"): ("[0.0, 1.0]", {"shape": None, "law": "'table'", "s": "[0.0, 1.0]"}),
    ("heights", "name"): ("'gamma'", {"shape": None, "law": "'scipy'", "shapes": "{a = 4.0}"}),
    ("heights", "shapes"): ("{a = 4.0}", {"shape": None, "law": "'scipy'", "name": "'gamma'"}),
    ("heights", "alpha"): ("5.0", {"shape": None, "law": "'nayak'"}),
    ("interaction", "reference"): ("'body'", {}),
    ("interaction", "bulk_modulus"): ("1e11", {"reference": "'body'"}),
    ("joint", "gas"): ("{conductivity = 0.15, jump = '1 um'}", JOINED),
    ("joint", "rms"): ("'2 um'", JOINED),
    ("joint", "temperature"): ("300.0", JOINED),
    ("joint", "gas_pressure"): ("'1 bar'", JOINED),
    **{("fitted", key): (value, FITTED | {key: value}) for key, value in FITTED.items()},
    ("fitted", "agreement"): ("1.02", FITTED),
    ("fitted", "lay"): ("1.0", FITTED),
    ("fitted", "area"): ("'1 mm^2'", FITTED),
    ("fitted", "cautions"): ("['lay: 2 : 1']", FITTED),
    ("surface", "uncertainty"): ("{sigma = '20 %', radius = 0.15}", {}),
    ("surface", "m0"): ("1e-12", SPECTRAL),
    ("surface", "m2"): ("1e-3", SPECTRAL),
    ("surface", "m4"): ("5e6", SPECTRAL),
    ("summits", "curvature"): ("'random'", NAYAK),
    ("summits", "largest_radius"): ("'1 mm'", NAYAK | {"curvature": "'random'"}),
    ("summits", "file"): ("'s.csv'", LISTED),
    ("summits", "heights"): (HEIGHTS["heights"], LISTED | RADII),
    ("summits", "radii"): (RADII["radii"], LISTED | HEIGHTS),
    ("summits", "ratios"): ("[1.0, 2.0, 3.0]", LISTED | HEIGHTS),
    ("summits", "resample"): ("true", LISTED | {"file": "'s.csv'"}),
    ("contact", "datum"): ("'surface'", NAYAK),
    ("contact", "law"): ("'kogut-etsion'", {"critical": "0.05"}),
    ("contact", "critical"): ("0.05", {"law": "'kogut-etsion'"}),
    ("contact", "hardness"): ("'1.2 GPa'", {"law": "'kogut-etsion'"}),
    ("contact", "poisson"): ("0.3", {"law": "'kogut-etsion'", "critical": "0.05"}),
    ("contact", "bridge"): ("'hermite'", {"law": "'kogut-etsion'", "critical": "0.05"}),
    ("contact", "yield_strength"): ("'400 MPa'", {"law": "'jackson-green'"}),
    ("contact", "yield_strain"): ("0.004", {"law": "'jackson-green'", "critical": "0.1"}),
    ("contact", "k"): ("0.5", {"law": "'power-law-graded'", "c0": "'10 um'"}),
    ("contact", "c0"): ("'10 um'", {"law": "'power-law-graded'", "k": "0.5"}),
    ("contact", "reduced_c0"): ("1.0", {"law": "'power-law-graded'", "k": "0.5"}),
    ("contact", "thickness"): ("'1 um'", {"law": "'coated'", "ratio": "3.0"}),
    ("contact", "reduced_thickness"): ("0.5", {"law": "'coated'", "ratio": "3.0"}),
    ("contact", "ratio"): ("3.0", {"law": "'coated'", "thickness": "'1 um'"}),
    ("contact", "limits"): ("[1.0]", CUSTOM | {"limits": None}),
    ("contact", "load"): (CUSTOM["load"], CUSTOM | {"load": None}),
    ("contact", "area"): (CUSTOM["area"], CUSTOM | {"area": None}),
    ("contact", "work"): ("'0.05 J/m^2'", {"law": "'johnson-kendall-roberts'"}),
    ("contact", "pull_off"): ("0.1", {"law": "'derjaguin-muller-toporov'"}),
    ("contact", "unload_from"): ("-0.5", {}),
    ("contact", "resistivity"): ("1e-7", {}),
    ("contact", "conductivities"): ("[150.0, 16.0]", {}),
    ("contact", "film_resistance"): ("1e-12", {"resistivity": "1e-7"}),
    ("contact", "layer"): ("{thickness = 1e-5, conductivity = 1.3}", {"conductivities": "[150.0, 16.0]"}),
    ("contact", "checked"): ("false", CUSTOM),
}
# With ~ what the schema lets pass: wrong by other keys or a file, or as only the program can know.
WRONG = {
    "title": ["1"], "sigma": ["0.0", "-1e-6", "~nan", "true", "[1.0]"], "radius": ["0", "-1", "~inf", "'x'"],
    "eta": ["0", "-1", "{}"], "nominal_area": ["0", "-1", "~'1 m'"], "E_star": ["0", "-1", "~'1 N'"],
    "reference": ["'plane'", "1"], "bulk_modulus": ["0", "-1", "~'1 N'"],
    "bodies": ["[]", "[{E = 7e10}]", "[{E = -1}, {E = 1}]", "[{E = 1, nu = 2}, {E = 1}]",
               "[{e = 1}, {E = 1}]",
               "3", "[{E = true}, {E = 1}]", "[{E = 1, nu = '0.3'}, {E = 1}]", "~[{E = '1 m'}, {E = 1}]"],
    "law": ["'gauss'", "1"], "gamma": ["~nan", "~inf", "'2'", "true"], "negative": ["'no'", "1"],
    "file": ["~'absent.csv'", "1", "''"], "ratio": ["~[1.0]", "1", "['a', 'b']", "~[nan, 1.0]"],
    "edges": ["~[0.0, 20.0, 5.0]", "~[0.0, 5.0, 5.0]", "~[0.0, 5.0, inf]", "[0.0, 5.0, 'x']", "5.0", "[]",
              "[0.0, 5.0, true]", "~[0.0, 1.0, 2.0]", "~[3.0, 5.0, 20.0]"],
    "coefficients": ["[]", "~[[1.0]]", "[[1.0], []]", "~[[1.0], [nan]]", "[[1.0], ['x']]", "[1.0, 2.0]",
                     "'x'", "[[1.0], [[1.0]]]", f"~[[1.0], {[1.0] * 65}]"],
    "kinks": ["~[4.0]", "~[0.0]", "['x']", "5.0", "~[5.0, 5.0]"],
    "shape": ["0.5", "101", "'2'", "~nan"], "heights": ["[]", "~[1.0, 1.0]", "'x'", "1"],
    "resample": ["1.5", "'no'"],
    "share": ["~[0.0, 0.5]", "~[0.0]", "1"], "name": ["~'absent'", "1", "~'binom'"],
    "shapes": ["~{b = 1.0}", "{a = 'x'}", "1", "~{a = -1.0}"],
    "separations": ["[]", "'x'", "~[nan]", "true", "[[1.0]]", "{start = 0.0}", "~[1e-200]", "[1e7]",
                    "{start = 0.0, stop = 1.0, num = 100001}", "{start = 0.0, stop = 1.0, num = 3, nm = 3}",
                    "{start = 0.0, stop = 1.0, num = -3}"],
    "quantities": ["[]", "['weight']", "'load'", "['load', 'load']", "[1]"],
    "n_surfaces": ["0", "-1", "1.5", "'10'", "true", "inf"], "max_surfaces": ["0", "-1", "1.5", "true"],
    "n_asperities": ["0", "-1", "1.5", "true", "~1e300"], "count": ["'free'", "1"],
    "seed": ["-1", "1.5", "18446744073709551616", "true"], "sampler": ["'all'", "1"], "keep": ["'all'", "1"],
    "accuracy": ["-1", "1", "0.2", "~nan", "'abc'", "true"],
    "rel_err": ["0", "-0.1", "0.2", "'x'", "true"], "max_seconds": ["0", "-1", "~inf", "~'1 m'"],
    "critical": ["0", "-1", "'x'", "~nan"], "hardness": ["0", "-1", "~'1 m'"],
    "poisson": ["0.6", "-1.5", "'x'"], "bridge": ["'cubic'", "1"],
    "yield_strength": ["0", "~'1 N'"], "yield_strain": ["0", "~nan"],
    "k": ["~1.0", "-0.1", "'x'"], "c0": ["0", "~'1 Pa'"], "reduced_c0": ["0", "-1"],
    "thickness": ["0", "~'1 Pa'"], "reduced_thickness": ["0", "-1"], "resistivity": ["0", "-1", "'x'"],
    "unload_from": ["~0.5", "'back'", "~nan"], "film_resistance": ["-1", "'x'"],
    "conductivities": ["[1.0]", "[0.0, 1.0]", "1.0", "['x', 1.0]"],
    "layer": ["1", "{thickness = 1}", "{thickness = 0, conductivity = 1}"],
    "uncertainty": ["1", "~{}", "{sigma = 3.0}", "{sigma = 0}", "{sigma = 0.1, m0 = 0.1}", "{E = 0.1}",
                    "~{m0 = 0.1}", "~{sigma = 0.1, correlation = [[1.0, 0.0]]}",
                    "{sigma = 0.1, correlation = 1}",
                    "~{sigma = 0.1, eta = 0.1, correlation = [[1.0, 0.5], [0.0, 1.0]]}"],
    "limits": ["1.0", "[-1.0]", "['x']", "~[nan]"],
    "load": ["[]", "1", "~" + PIECE.replace("}, {", "}] #"), "[{low = 1.0}]", PIECE.replace("[1.0]", "[]"),
             "~" + PIECE.replace("high = 3.0", "high = 0.5")],
    "area": ["[]", "'x'", PIECE.replace("[1.0]", "['x']"), PIECE.replace("low = 1.0", "lowest = 1.0")],
    "work": ["0", "-1", "'x'"], "pull_off": ["0", "-1", "~inf"],
    "alpha": ["1.5", "0", "'x'", "~nan", "inf"], "curvature": ["'all'", "1"],
    "skewness": ["~nan", "'x'"], "kurtosis": ["0", "-1", "~inf"], "independent": ["0", "'many'", "~nan"],
    "agreement": ["0.9", "~nan", "'x'"], "lay": ["0.5", "-1", "~inf"],
    "cautions": ["'x'", "[1]", "['']"],
    "gas": ["'steam'", "1", "{jump = 1e-6}", "{conductivity = -1, jump = 1e-6}"],
    "rms": ["0", "-1", "~'1 Pa'", "~1e-9"], "temperature": ["0", "-1", "~nan"],
    "gas_pressure": ["0", "~'1 m'"],
    "m0": ["0", "-1", "~'1 m'"], "m2": ["0", "~nan", "~'1 m'"], "m4": ["0", "-1", "~'1 m'"],
    "largest_radius": ["0", "-1", "~'1 Pa'"], "datum": ["'top'", "1"],
    "radii": ["~[1e-5]", "1", "[1e-5, -1e-5, 1e-5]", "~[1e-5, nan, 1e-5]", "['x', 1, 1]"],
    "ratios": ["~[1.0]", "'x'", "[1.0, -1.0, 1.0]"],
    "left_out": ["'seed'", "['gamma']", "[1]", "~['n_asperities']"],
}  # fmt: skip
WRONG_HERE = {
    ("grading", "s"): ["~[1.0]", "~[1.0, 0.0]", "~[0.0, nan]", "1"],
    ("heights", "s"): ["~[1.0]", "~[1.0, 0.0]", "1"],
    ("grading", "name"): ["1", "['x']"],
    ("contact", "ratio"): ["0", "-1", "'x'"],
    **{(table, "checked"): ["0", "'no'"] for table in ("contact", "grading")},
    ("summits", "heights"): ["[]", "~[1.0]", "1", "~[1.0, nan, 2.0]"],
    ("fitted", "area"): ["0", "-1", "~'1 m'"],
}  # fmt: skip


# Keys that are arguments in Python, which says the same of a wrong value.
ARGUMENTS = {
    "title", "sigma", "radius", "eta", "nominal_area", "E_star", "negative", "separations", "quantities",
    "n_surfaces", "n_asperities", "count", "seed", "sampler", "keep", "rel_err", "max_seconds",
}  # fmt: skip
FILES = {
    "g.csv": "s,ratio\n0,1\n1,2\n",
    "h.csv": "0\n1\n3\n",
    "s.csv": "height,radius\n0,1e-5\n1e-6,2e-5\n3e-6,3e-5\n",
}
FILES |= {"moduli.csv": FILES["g.csv"], "heights.csv": FILES["h.csv"], "summits.csv": FILES["s.csv"]}


def keys():
    """All keys of all tables: those of GOOD and those in other company."""
    return [(table, key) for table, lines in GOOD.items() for key in lines] + list(COMPANY)


def text_of(table, key, value):
    """A scene that is right but for the value of one key."""
    tables = {name: dict(lines) for name, lines in GOOD.items()}
    _, others = COMPANY.get((table, key), ("", {}))
    for other, line in others.items():
        place, name = other if isinstance(other, tuple) else (table, other)
        tables.setdefault(place, {}).pop(name, None)
        if line is not None:
            tables[place][name] = line
    tables.setdefault(table, {})[key] = value
    return "\n".join(
        (f"[{name}]\n" if name else "") + "".join(f"{k} = {v}\n" for k, v in lines.items())
        for name, lines in tables.items()
    )


def good(table, key):
    return COMPANY[table, key][0] if (table, key) in COMPANY else GOOD[table][key]


def examples():
    """{(table, key): example} of the rows of the page."""
    found, table = {}, ""
    for line in (ROOT / "docs" / "reference" / "scene.md").read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            name = re.search(r"`\[(\w+)\]`", line)
            table = name[1] if name else ""
        elif row := re.match(r"\| `(\w+)` \| `(.+?)` \|", line):
            assert (table, row[1]) not in found
            found[table, row[1]] = row[2]
    return found


@pytest.fixture(scope="module")
def example():
    return examples()


@cache
def validator():
    """That of others; the schema itself is one."""
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def passes(text):
    """Whether the schema finds a document right."""
    return validator().is_valid(tomllib.loads(text))


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).write_text(text)


def problems(call, *args, **options):
    with pytest.raises(SceneError) as caught:
        call(*args, **options)
    assert all("\n" not in line and len(line) < 300 for line in caught.value.problems)
    return caught.value.problems


def test_the_lists_of_keys_are_whole(monkeypatch, example):
    """Whatever key any scene is asked for stands in the lists above, and on the page."""
    asked, plain = set(), Section.read

    def noted(self, key, *default):
        asked.add((self.name, key))
        return plain(self, key, *default)

    monkeypatch.setattr(Section, "read", noted)
    for table, key in keys():
        mcgw.scene_from(text_of(table, key, good(table, key)))
    inner = {("contact.separations", name) for name in ("start", "stop", "num")}
    inner |= {("joint.gas", name) for name in ("conductivity", "jump")}
    inner |= {("contact.layer", name) for name in ("thickness", "conductivity")}
    errors = ("sigma", "radius", "eta", "m0", "m2", "m4", "E_star", "correlation")
    inner |= {("surface.uncertainty", name) for name in errors}
    inner |= {
        (f"contact.{key}", name) for key in ("load", "area") for name in ("low", "high", "coefficients")
    }
    inner |= {("surface.bodies", name) for name in ("E", "nu")}
    rows = {(table, key) for table, known in KEYS.items() for key in known}
    assert asked - inner == rows == set(keys()) == set(example)


@pytest.mark.parametrize(("table", "key"), keys())
def test_right_values_of_every_key_are_read(table, key, example):
    """That of the list and that of the page, by the program and by the schema; and what it writes of them."""
    for value in (good(table, key), example[table, key]):
        text = text_of(table, key, value)
        scene = mcgw.scene_from(text)
        assert passes(text)
        assert passes(mcgw.scene_text(scene))
        assert mcgw.scene_from(mcgw.scene_text(scene)) == scene


@pytest.mark.parametrize(("table", "key"), keys())
def test_wrong_values_of_every_key_are_named(table, key):
    """By the program, from a file and from Python, and by the schema but for those that it cannot know."""
    path, right = f"{table}.{key}" if table else key, mcgw.scene_from(text_of(table, key, good(table, key)))
    named = {path, f"{table}.s"} if key in ("share", "ratio") else {path}
    if key in ("radii", "ratios", "x", "y"):  # lists of two lengths are told by the first
        named.add("summits.heights")
    if key == "left_out":
        named.add("ensemble.n_asperities")
    if key == "law":  # of another law other keys are unknown
        named.add(f"{table}.")
    for value in WRONG_HERE.get((table, key)) or WRONG[key]:
        passing, value = value.startswith("~"), value.removeprefix("~")
        text = text_of(table, key, value)
        said = problems(mcgw.scene_from, text)
        assert all(any(line.startswith(name) for name in named) for line in said), (value, said)
        assert passes(text) == passing, value
        if key in ARGUMENTS and table != "summits":
            argument = tomllib.loads(f"x = {value}")["x"]
            assert problems(right.replace, **{key: argument}) == said
            if table != "surface":
                assert problems(mcgw.simulate, right, **{key: argument}) == said


@pytest.mark.parametrize(("table", "key"), keys())
def test_an_unknown_key_beside_every_key_is_named(table, key):
    """A misspelling of this very key, which would be its default in silence."""
    text, start = text_of(table, key, good(table, key)), f"[{table}]\n" if table else ""
    text = text.replace(start, f"{start}{key}x = 1\n", 1) if start else f"{key}x = 1\n{text}"
    (line,) = problems(mcgw.scene_from, text)
    path = f"{table}.{key}x" if table else f"{key}x"
    assert line.startswith(f"{path}: unknown key; did you mean ")
    assert not passes(text)


def test_an_unknown_table_is_named():
    for name in filter(None, GOOD):
        text = text_of("", "title", "'x'") + f"[{name}x]\n"
        with pytest.raises(SceneError, match=f"{name}x: unknown key; did you mean {name}"):
            mcgw.scene_from(text)
        assert not passes(text)


RANGE = {"start": "0.0", "stop": "1.0", "num": "3"}


@pytest.mark.parametrize("key", RANGE)
def test_inside_of_separations(key):
    def of(lines):
        inside = ", ".join(f"{k} = {v}" for k, v in lines.items())
        return text_of("contact", "separations", f"{{{inside}}}")

    assert mcgw.scene_from(of(RANGE)).separations == (0.0, 0.5, 1.0)
    wrong = {"num": ["0", "-3", "1.5", "true", "100001", "'3'"]}.get(key, ["nan", "inf", "'1'", "true"])
    for value in wrong:
        with pytest.raises(SceneError) as caught:
            mcgw.scene_from(of(RANGE | {key: value}))
        (line,) = caught.value.problems
        assert line.startswith(f"contact.separations.{key} = ")
    with pytest.raises(SceneError, match=re.escape(f"contact.separations.{key}x: unknown key")):
        mcgw.scene_from(of(RANGE | {f"{key}x": "1"}))
    with pytest.raises(SceneError, match=re.escape(f"contact.separations.{key}: missing")):
        mcgw.scene_from(of({k: v for k, v in RANGE.items() if k != key}))


# --- the schema itself: the keys and words of the code, and every right scene passes ---


def made():
    """The module that makes it."""
    sys.path.insert(0, str(DOCS))
    try:
        import scene_schema
    finally:
        sys.path.remove(str(DOCS))
    return scene_schema


def test_it_is_that_of_the_page_and_of_the_code():
    """`python docs/scene_schema.py` would write the same."""
    assert SCHEMA.read_text(encoding="utf-8") == made().text()


def properties():
    top = json.loads(SCHEMA.read_text(encoding="utf-8"))["properties"]
    for table, shape in top.items():
        if "properties" not in shape:
            yield ("", table), shape
            continue
        assert shape["additionalProperties"] is False
        yield from (((table, key), inner) for key, inner in shape["properties"].items())


def test_it_has_every_key_and_no_other():
    found = dict(properties())
    assert set(found) == set(keys())
    for path, shape in found.items():
        assert 5 < len(shape["description"]) < 300, path
        assert not re.search(r"[`\\]|\]\(", shape["description"]), path


def test_what_an_editor_sees_of_infinity_passes():
    """JSON has none: Taplo makes it null."""
    text = text_of("surface", "bodies", "[{E = 7e10}, {E = inf}]")
    document = tomllib.loads(text)
    document["surface"]["bodies"][1]["E"] = None
    assert validator().is_valid(document)
    document["surface"]["sigma"] = None
    assert not validator().is_valid(document)


def scenes():
    """Every whole scene of the repository: presets, those of runs/, and those of the pages."""
    for path in sorted((*ROOT.glob("runs/*.toml"), *ROOT.glob("mcgw/**/*.toml"))):
        yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")
    for page in WRITTEN:
        for k, (kind, code) in enumerate(blocks((DOCS / page).read_text(encoding="utf-8"))):
            if kind in ("toml", "text") and "[surface]" in code and "[contact]" in code:
                yield f"{page}-{k}", code


@pytest.mark.parametrize("text", [pytest.param(text, id=name) for name, text in scenes()])
def test_every_scene_of_ours_passes(text):
    assert passes(text)


@pytest.mark.parametrize(
    ("lines", "right"),
    [
        ('rel_err = "1 %"', True),
        ("rel_err = {load = 0.01, area = '2 %'}", True),
        ("rel_err = {load = [0.01, inf, 0.02]}", True),
        ('rel_err = 0.01\nmax_surfaces = 50\nkeep = "statistics"', True),
        ("rel_err = [0.01]", False),
        ("rel_err = {}", False),
        ("rel_err = {weight = 0.01}", False),
        ("rel_err = {load = true}", False),
        ("max_surfaces = 50", False),
    ],
)
def test_forms_of_a_stop_rule(lines, right):
    """The program says the same of each."""
    text = text_of("contact", "separations", "[0.0, 1.0, 2.0]").replace(
        "quantities = ['load']", "quantities = ['load', 'area']"
    )
    text = re.sub("n_surfaces = .*", lines, text.replace("keep = 'sums'\n", ""))
    assert passes(text) is right
    if right:
        mcgw.scene_from(text)
    else:
        with pytest.raises(mcgw.SceneError):
            mcgw.scene_from(text)


def test_init_puts_it_beside_the_scene(tmp_path, capsys):
    """An editor finds it by the first line; a file of that name that is something else stays."""
    assert main(["init", "coating", "-o", str(tmp_path / "mine.toml"), "--schema"]) == 0
    first, rest = (tmp_path / "mine.toml").read_text(encoding="utf-8").split("\n", 1)
    assert first.startswith("#:schema ./")
    assert (tmp_path / first.removeprefix("#:schema ./")).read_bytes() == SCHEMA.read_bytes()
    assert rest == (SCHEMA.parent / "presets" / "coating.toml").read_text(encoding="utf-8")
    mcgw.load_scene(tmp_path / "mine.toml")
    assert "scene.schema.json" in capsys.readouterr().out
    assert main(["init", "-o", str(tmp_path / "other.toml"), "--schema"]) == 0  # it is there, and the same
    (tmp_path / "scene.schema.json").write_text("{}")
    assert main(["init", "-o", str(tmp_path / "third.toml"), "--schema"]) == 2
    assert "scene.schema.json: already exists, from another version" in capsys.readouterr().err
    assert not (tmp_path / "third.toml").exists()
    assert (tmp_path / "scene.schema.json").read_text() == "{}"


def test_what_is_asked_of_surfaces_is_an_argument_by_its_row():
    arguments, said = inspect.signature(mcgw.Scene).parameters, mcgw.Scene.__doc__
    rows = set(KEYS["ensemble"]) - {"max_surfaces", "left_out"} | {"uncertainty"}
    assert len(rows) == 10
    assert rows <= set(arguments)
    assert all(f"    {name} : " in said for name in arguments)
    assert all(
        arguments[name].default == (KEYS["ensemble"][name].default or None) for name in ("keep", "seed")
    )
    assert not {"datum", "layer"} & set(dir(mcgw.Scene))


@pytest.mark.parametrize(
    ("table", "lines"),
    [
        ("contact", 'law = "johnson-kendall-roberts"\npull_off = 0.1\nseparations = [1.0]'),
        ("contact", 'law = "kogut-etsion"\ncritical = 0.1\nseparations = [1.0]'),
        ("heights", 'law = "weibull"\nshape = 2.0'),
        ("grading", "gamma = 2.0"),
        ("ensemble", "seed = 1"),
    ],
)
def test_each_neighbour_of_an_unknown_key_is_listed_once(table, lines):
    with pytest.raises(mcgw.SceneError) as error:
        mcgw.scene_from(f"[{table}]\n{lines}\nzzzzzz = 1\n")
    (line,) = [line for line in error.value.problems if "zzzzzz" in line]
    known = line.partition("known keys: ")[2].split(", ")
    assert len(known) == len(set(known)) > 1

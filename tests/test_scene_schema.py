"""The JSON Schema of scenes: the keys and words of the code, every right scene passes, wrong ones do not."""

import json
import re
import sys
import tomllib
from pathlib import Path

import jsonschema
import pytest
import test_scene_keys as keys_of_the_code
from docs_site import DOCS, ROOT, WRITTEN, blocks

import mcgw
from mcgw.cli import main
from mcgw.scene.section import Section

SCHEMA = Path(mcgw.__file__).parent / "scene" / "scene.schema.json"
KEYS, PIECE = keys_of_the_code.keys(), keys_of_the_code.PIECE
# What is wrong by other keys, by a file, or in a way that only the program can know.
KNOWN_TO_THE_PROGRAM = {
    ("surface", "sigma"): ["nan"], ("surface", "radius"): ["inf"], ("surface", "nominal_area"): ["'1 m'"],
    ("surface", "E_star"): ["'1 N'"], ("surface", "bodies"): ["[{E = '1 m'}, {E = 1}]"],
    ("surface", "m0"): ["'1 m'"], ("surface", "m2"): ["nan", "'1 m'"], ("surface", "m4"): ["'1 m'"],
    ("grading", "gamma"): ["nan", "inf"], ("grading", "s"): ["[1.0]", "[1.0, 0.0]", "[0.0, nan]"],
    ("grading", "ratio"): ["[1.0]", "[nan, 1.0]"], ("grading", "file"): ["'absent.csv'"],
    ("grading", "edges"): ["[0.0, 20.0, 5.0]", "[0.0, 5.0, 5.0]", "[0.0, 5.0, inf]", "[0.0, 1.0, 2.0]",
                           "[3.0, 5.0, 20.0]"],
    ("grading", "coefficients"): ["[[1.0]]", "[[1.0], [nan]]", f"[[1.0], {[1.0] * 65}]"],
    ("grading", "kinks"): ["[4.0]", "[0.0]", "[5.0, 5.0]"],
    ("heights", "file"): ["'absent.csv'"], ("heights", "heights"): ["[1.0, 1.0]"],
    ("heights", "shape"): ["nan"], ("heights", "s"): ["[1.0]", "[1.0, 0.0]"],
    ("heights", "share"): ["[0.0, 0.5]", "[0.0]"], ("heights", "name"): ["'absent'", "'binom'"],
    ("heights", "shapes"): ["{b = 1.0}", "{a = -1.0}"], ("heights", "alpha"): ["nan", "inf"],
    ("summits", "file"): ["'absent.csv'"], ("summits", "heights"): ["[1.0]", "[1.0, nan, 2.0]"],
    ("summits", "radii"): ["[1e-5]", "[1e-5, nan, 1e-5]"], ("summits", "ratios"): ["[1.0]"],
    ("summits", "largest_radius"): ["'1 Pa'"],
    ("interaction", "bulk_modulus"): ["'1 N'"],
    ("contact", "separations"): ["[nan]", "[1e-200]", "[1e7]"],
    ("contact", "critical"): ["nan"], ("contact", "hardness"): ["'1 m'"],
    ("contact", "yield_strength"): ["'1 N'"], ("contact", "yield_strain"): ["nan"],
    ("contact", "k"): ["1.0"], ("contact", "c0"): ["'1 Pa'"], ("contact", "thickness"): ["'1 Pa'"],
    ("contact", "load"): [PIECE.replace("}, {", "}] #"), PIECE.replace("high = 3.0", "high = 0.5")],
    ("contact", "limits"): ["[nan]"], ("contact", "pull_off"): ["inf"],
    ("contact", "unload_from"): ["0.5", "nan"],
    ("ensemble", "n_asperities"): ["1e300"], ("ensemble", "seed"): ["18446744073709551616"],
    ("ensemble", "accuracy"): ["1", "nan", "inf", "1e-14"], ("ensemble", "law_error"): ["nan"],
    ("ensemble", "edges"): ["[nan]", "[inf]"], ("ensemble", "max_seconds"): ["inf", "'1 m'"],
    ("ensemble", "left_out"): ["['n_asperities']"],
}  # fmt: skip


@pytest.fixture(scope="module")
def passes():
    """Whether a document is right, by the validator of others; the schema itself is one."""
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    return lambda text: validator.is_valid(tomllib.loads(text))


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
    assert set(found) == set(KEYS)
    for path, shape in found.items():
        assert 5 < len(shape["description"]) < 300, path
        assert not re.search(r"[`\\]|\]\(", shape["description"]), path


def test_its_words_are_those_that_the_code_knows(monkeypatch):
    """Spied from the reader: whatever is read as one of a few words, and which these are."""
    asked, plain = {}, Section.choice

    def noted(self, key, default, known):
        asked[self.name, key] = set(known)
        return plain(self, key, default, known)

    monkeypatch.setattr(Section, "choice", noted)
    for path in KEYS:
        mcgw.scene_from(keys_of_the_code.text_of(*path, keys_of_the_code.good(*path)))
    found = dict(properties())
    assert len(asked) >= 10
    assert {path: set(found[path]["enum"]) for path in asked} == asked


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("g.csv").write_text("s,ratio\n0,1\n1,2\n")
    Path("h.csv").write_text("0\n1\n3\n")
    Path("s.csv").write_text("height,radius\n0,1e-5\n1e-6,2e-5\n3e-6,3e-5\n")


@pytest.mark.parametrize(("table", "key"), KEYS)
def test_right_values_pass_and_wrong_ones_do_not(table, key, passes):
    """All values of the test of the keys: what passes is what is known to be left to the program."""
    assert passes(keys_of_the_code.text_of(table, key, keys_of_the_code.good(table, key)))
    wrong = keys_of_the_code.WRONG_HERE.get((table, key), keys_of_the_code.WRONG.get(key, []))
    missed = [value for value in wrong if passes(keys_of_the_code.text_of(table, key, value))]
    assert missed == KNOWN_TO_THE_PROGRAM.get((table, key), [])
    good = keys_of_the_code.text_of(table, key, keys_of_the_code.good(table, key))
    start = f"[{table}]\n" if table else ""
    assert not passes(good.replace(start, f"{start}{key}x = 1\n", 1) if start else f"{key}x = 1\n{good}")


def test_what_an_editor_sees_of_infinity_passes():
    """JSON has none: Taplo makes it null."""
    validator = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8")))
    text = keys_of_the_code.text_of("surface", "bodies", "[{E = 7e10}, {E = inf}]")
    document = tomllib.loads(text)
    document["surface"]["bodies"][1]["E"] = None
    assert validator.is_valid(document)
    document["surface"]["sigma"] = None
    assert not validator.is_valid(document)


def scenes():
    """Every whole scene of the repository: presets, those of runs/, and those of the pages."""
    for path in sorted((*ROOT.glob("runs/*.toml"), *ROOT.glob("mcgw/**/*.toml"))):
        yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")
    for page in WRITTEN:
        for k, (kind, code) in enumerate(blocks((DOCS / page).read_text(encoding="utf-8"))):
            if kind in ("toml", "text") and "[surface]" in code and "[contact]" in code:
                yield f"{page}-{k}", code


@pytest.mark.parametrize("text", [pytest.param(text, id=name) for name, text in scenes()])
def test_every_scene_of_ours_passes(text, passes):
    assert passes(text)


def test_what_the_program_writes_passes(passes):
    for table, key in KEYS:
        scene = mcgw.scene_from(keys_of_the_code.text_of(table, key, keys_of_the_code.good(table, key)))
        assert passes(mcgw.scene_text(scene)), (table, key)


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
def test_forms_of_a_stop_rule(lines, right, passes):
    """The program says the same of each."""
    text = keys_of_the_code.text_of("contact", "separations", "[0.0, 1.0, 2.0]").replace(
        "quantities = ['load']", "quantities = ['load', 'area']"
    )
    text = re.sub("n_surfaces = .*", lines, text.replace("keep = 'sums'\n", ""))
    assert passes(text) is right
    if right:
        mcgw.scene_from(text)
    else:
        with pytest.raises(mcgw.SceneError):
            mcgw.scene_from(text)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("[contact]", "[contacts]"),
        ("nominal_area = 1e-6\n", ""),
        ("separations = {start = 0.0, stop = 1.0, num = 3}\n", ""),
        ("sigma = 1e-6", 'sigma = "much"'),
        ("[contact]\n", '[contact]\nlaw = "herz"\n'),
    ],
)
def test_a_scene_that_lacks_or_misspells_something_does_not_pass(old, new, passes):
    text = keys_of_the_code.text_of("", "title", "'x'")
    assert passes(text)
    assert old in text
    assert not passes(text.replace(old, new))


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
    assert "scene.schema.json: is already there, and not that of this version" in capsys.readouterr().err
    assert not (tmp_path / "third.toml").exists()
    assert (tmp_path / "scene.schema.json").read_text() == "{}"

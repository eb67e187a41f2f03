"""Every key of every table in one walk: file, Python, --set, page and schema; right, wrong and misspelt."""

import importlib
import json
import re
import tomllib
from functools import cache
from pathlib import Path

import jsonschema
import pytest
from hypothesis import assume, given, strategies as st
from oracles.docs_site import DOCS, ROOT
from oracles.inside import KEYS
from strategies import FEW, VALUES
from tables.scene_keys import BASE, FILES, OTHER_FORMS, ROWS, changed, good, keys, text as written, text_of
from tables.wrong_values import ARGUMENTS, WRONG, WRONG_HERE

import mcgw
from mcgw.cli import main

SCHEMA = Path(mcgw.__file__).parent / "scene" / "scene.schema.json"


@pytest.fixture(scope="module")
def example():
    """{(table, key): example} of the rows of the page."""
    found, table = {}, ""
    for line in (ROOT / "docs" / "reference" / "scene.md").read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            name = re.search(r"`\[([\w.]+)\]`", line)
            table = name[1] if name else ""
        elif row := re.match(r"\| `(\w+)` \| `(.+?)` \|", line):
            assert (table, row[1]) not in found
            found[table, row[1]] = row[2]
    return found


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
def files(tmp_path, in_tmp_path):
    for name, content in FILES.items():
        Path(name).write_text(content)


def problems(call, *args, **options):
    with pytest.raises(mcgw.SceneError) as caught:
        call(*args, **options)
    assert all("\n" not in line and len(line) < 300 for line in caught.value.problems)
    return caught.value.problems


def test_the_lists_of_keys_are_whole(example):
    """Whatever key a scene has stands in the table of this test, on the page and in the schema."""
    found = dict(properties())
    assert {(table, key) for table, known in KEYS.items() for key in known} == set(keys()) == set(example)
    assert set(found) == set(keys())
    for path, shape in found.items():
        assert 5 < len(shape["description"]) < 300, path
        assert not re.search(r"[`\\]|\]\(", shape["description"]), path


@pytest.mark.parametrize(("key", "value", "beside", "found", "expected"), ROWS, ids=[row[0] for row in ROWS])
def test_the_number_is_the_one_by_hand(key, value, beside, found, expected):
    number = found(mcgw.scene_from(written(**changed(key, value, **beside))))
    if isinstance(expected, str | tuple | bool):
        assert number == expected
    else:
        assert number == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("table", "key"), keys())
def test_right_values_of_every_key_are_read(table, key, example, tmp_path):
    """That of the table and that of the page, by the program and by the schema; written out, and by --set."""
    bare = tmp_path / "bare.toml"
    bare.write_text(text_of(table, key, None))
    for value in (good(table, key), example[table, key], *OTHER_FORMS.get((table, key), ())):
        text = text_of(table, key, value)
        scene = mcgw.scene_from(text)
        assert passes(text)
        assert passes(mcgw.scene_text(scene))
        assert mcgw.scene_from(mcgw.scene_text(scene)) == scene
        if table:
            changes = {f"{table}.{key}": tomllib.loads(f"x = {value}")["x"]}
            assert mcgw.load_scene(bare, changes=changes) == scene


@pytest.mark.parametrize(("table", "key"), keys())
def test_wrong_values_of_every_key_are_named(table, key):
    """By the program, from a file and from Python, and by the schema but for those that it cannot know."""
    path, right = f"{table}.{key}" if table else key, mcgw.scene_from(text_of(table, key, good(table, key)))
    named = {path, f"{table}.s"} if key in ("share", "ratio") else {path}
    if key in ("radii", "ratios", "x", "y"):  # lists of two lengths are told by the first
        named.add("summits.heights")
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
    (line,) = problems(mcgw.scene_from, text.replace(f"{key}x = 1\n", "zzzzzz = 1\n", 1))
    known = line.partition("known keys: ")[2].split(", ")
    assert len(known) == len(set(known)) > 1 - (not table)


def test_an_unknown_table_is_named():
    for name in filter(None, BASE):
        text, inner = text_of("", "title", "'x'") + f"[{name}x]\n", name.rpartition(".")[2]
        with pytest.raises(mcgw.SceneError, match=f"{name}x: unknown key; did you mean {inner}"):
            mcgw.scene_from(text)
        assert not passes(text)
    assert "did you mean contact.law.hardness" in problems(mcgw.scene_from, f"hardnes = 1\n{text}")[0]


@FEW
@given(path=st.sampled_from(keys()), value=VALUES | st.dates())
def test_whatever_a_key_is_given_is_taken_or_refused_by_name(path, value, tmp_path):
    """No traceback, one line a mistake; what is taken can be written and read again."""
    table, key = path
    assume(table)
    (tmp_path / "s.toml").write_text(text_of(table, key, None))
    told = []
    try:
        scene = mcgw.load_scene(tmp_path / "s.toml", changes={f"{table}.{key}": value})
    except mcgw.SceneError as error:
        told = error.problems
    assert all("\n" not in line and len(line) < 400 for line in told)
    assert not told or any(line.startswith(table) for line in told)
    assert told or mcgw.scene_from(mcgw.scene_text(scene)) == scene


# --- the schema itself: the keys and words of the code, and every right scene passes ---


def test_it_is_that_of_the_page_and_of_the_code(monkeypatch):
    """`python docs/scene_schema.py` would write the same."""
    monkeypatch.syspath_prepend(str(DOCS))
    assert SCHEMA.read_text(encoding="utf-8") == importlib.import_module("scene_schema").text()


def properties():
    top = json.loads(SCHEMA.read_text(encoding="utf-8"))["properties"]
    for table, shape in top.items():
        if "properties" not in shape:
            yield ("", table), shape
            continue
        assert shape["additionalProperties"] is False
        for key, inner in shape["properties"].items():
            if (table, key) == ("contact", "law"):  # a table, or its word
                yield from (
                    (("contact.law", name), of) for name, of in inner["anyOf"][0]["properties"].items()
                )
            else:
                yield (table, key), inner


def test_what_an_editor_sees_of_infinity_passes():
    """JSON has none: Taplo makes it null."""
    text = text_of("surface", "bodies", "[{E = 7e10}, {E = inf}]")
    document = tomllib.loads(text)
    document["surface"]["bodies"][1]["E"] = None
    assert validator().is_valid(document)
    document["surface"]["sigma"] = None
    assert not validator().is_valid(document)


def test_every_scene_of_ours_passes_and_reads_back_the_same():
    """Presets and those of runs/; pages show scenes that are read where they are tested."""
    for path in (*ROOT.glob("runs/*.toml"), *ROOT.glob("mcgw/**/*.toml")):
        scene = mcgw.load_scene(path)
        assert passes(path.read_text(encoding="utf-8")), path
        assert scene.title, path
        assert mcgw.scene_from(mcgw.scene_text(scene)) == scene, path


def test_init_puts_it_beside_the_scene(tmp_path, capsys):
    """An editor finds it by the first line; a file of that name that is something else stays."""
    for name in ("mine", "other"):  # it is there, and the same
        assert main(["init", "coating", "-o", str(tmp_path / f"{name}.toml"), "--schema"]) == 0
    first, rest = (tmp_path / "mine.toml").read_text(encoding="utf-8").split("\n", 1)
    assert (tmp_path / first.removeprefix("#:schema ./")).read_bytes() == SCHEMA.read_bytes()
    assert rest == (SCHEMA.parent / "presets" / "coating.toml").read_text(encoding="utf-8")
    (tmp_path / "scene.schema.json").write_text("{}")
    assert main(["init", "-o", str(tmp_path / "third.toml"), "--schema"]) == 2
    assert "scene.schema.json: already exists, from another version" in capsys.readouterr().err
    assert not (tmp_path / "third.toml").exists()
    assert (tmp_path / "scene.schema.json").read_text() == "{}"

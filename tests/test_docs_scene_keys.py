"""The page of the scene keys: no key is missing, none is invented, and every example is right."""

import re
import tomllib
from pathlib import Path

import pytest
import test_scene_keys as keys_of_the_code

import mcgw
from mcgw.scene.section import Section

PAGE = Path(__file__).parent.parent / "docs" / "reference" / "scene.md"
FILES = {
    "moduli.csv": "s,ratio\n0,1\n1,2\n",
    "heights.csv": "0\n1\n3\n",
    "summits.csv": "height,radius\n0,1e-5\n1e-6,2e-5\n3e-6,3e-5\n",
    "s.csv": "height,radius\n0,1e-5\n1e-6,2e-5\n3e-6,3e-5\n",
}


def rows():
    """Table, key and example of each row of the page."""
    table = ""
    for line in PAGE.read_text().splitlines():
        if line.startswith("## "):
            found = re.search(r"`\[(\w+)\]`", line)
            table = found[1] if found else ""
        elif row := re.match(r"\| `(\w+)` \| `(.+?)` \|", line):
            yield table, row[1], row[2]


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).write_text(text)


def test_each_key_stands_there_once():
    found = [(table, key) for table, key, _ in rows()]
    assert len(found) == len(set(found)) > 70


@pytest.mark.parametrize(("table", "key", "example"), list(rows()))
def test_examples_are_right(table, key, example):
    mcgw.scene_from(keys_of_the_code.text_of(table, key, example))


def test_the_page_has_the_keys_that_the_code_asks_for(monkeypatch):
    """Whatever any scene of the page is asked for, and the list of another test."""
    asked, plain = set(), Section._take

    def noted(self, key, default, unit=""):
        asked.add((self.name, key))
        return plain(self, key, default, unit)

    monkeypatch.setattr(Section, "_take", noted)
    for table, key, example in rows():
        mcgw.scene_from(keys_of_the_code.text_of(table, key, example))
    tables = {table for table, _, _ in rows()}
    asked = {(t, k) for t, k in asked if t in tables and not (t == "" and k in tables)}
    assert {(t, k) for t, k, _ in rows()} == asked | set(keys_of_the_code.keys())


def test_the_first_scene_of_the_page_is_one():
    (text,) = re.findall(r"^```toml\n(.*?)^```", PAGE.read_text(), flags=re.DOTALL | re.MULTILINE)
    assert len(tomllib.loads(text)) == 5
    assert mcgw.scene_from(text).n_asperities == 30_000

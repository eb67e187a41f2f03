"""Any scene that is taken is written as a text that reads as the same; any that is not is refused by key."""

import json
import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings, strategies as st
from tables.scene_keys import BASE, FILES, ROWS, changed, text

import mcgw


def some_of(n):
    """So many examples, the same in every run."""
    unchecked = list(HealthCheck)
    return settings(max_examples=n, deadline=None, derandomize=True, suppress_health_check=unchecked)


SEPARATIONS = st.floats(-1, 4) | st.lists(st.floats(0, 4), min_size=1, max_size=4)
TITLES = st.text("abc \"'\n\\é", max_size=5)


@st.composite
def documents(draw):
    """A few rows of the table of keys beside each other, other texts, and numbers of many digits."""
    tables = {"surface": {key: value * draw(st.floats(0.5, 2)) for key, value in BASE["surface"].items()}}
    for key, value, beside, *_ in draw(st.lists(st.sampled_from(ROWS), max_size=4)):
        if isinstance(value, float):
            value *= draw(st.just(1.0) | st.floats(0.5, 2))
        for table, keys in changed(key, value, **beside).items():
            tables[table] = None if keys is None else (tables.get(table) or {}) | keys
    if draw(st.booleans()):
        tables["contact"] = (tables.get("contact") or {}) | {"separations": draw(SEPARATIONS)}
    return text(**tables | {"top": {"title": json.dumps(draw(TITLES))}})


@pytest.fixture(autouse=True)
def files(in_tmp_path):
    for name, content in FILES.items():
        Path(name).write_text(content)


def is_its_text(document):
    """A scene that is taken; one that is not is refused by key."""
    try:
        scene = mcgw.scene_from(document)
    except mcgw.SceneError as error:
        for line in error.problems:
            assert re.match(rf"({'|'.join(filter(None, BASE))})\b", line), line
            assert len(line) < 300
        return
    written = mcgw.scene_text(scene)
    again = mcgw.scene_from(written)
    assert again == scene
    assert mcgw.scene_text(again) == written
    assert scene.replace(title=scene.title) == scene


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("many", [60, pytest.param(2000, marks=pytest.mark.slow)])
def test_text_and_scene_are_the_same(many):
    some_of(many)(given(documents())(is_its_text))()

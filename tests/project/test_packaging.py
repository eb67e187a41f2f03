"""What stands beside the code says of the package what pyproject.toml says: citation, recipe, layers."""

import re
import tomllib

import jinja2
import pytest
import yaml
from oracles.docs_site import ROOT
from test_architecture import LAYERS

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
ABOUT = PROJECT["project"]
CALLED = {"matplotlib": "matplotlib-base"}  # by conda-forge: without a window system


def text_of(name):
    return (ROOT / name).read_text(encoding="utf-8")


def requirement(written):
    """Name and floor: all that we say of a package."""
    return tuple(re.fullmatch(r"([\w-]+) ?>=([\w.]+)", written).groups())


@pytest.fixture(scope="module")
def recipe():
    """As conda reads it: a template of YAML; a name that nobody gives is an error."""
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=False)
    return yaml.safe_load(environment.from_string(text_of(".ci/conda/meta.yaml")).render(PYTHON="python"))


def test_the_citation_is_of_this_version():
    citation = yaml.safe_load(text_of("CITATION.cff"))
    assert citation["version"] == ABOUT["version"]
    assert citation["license"] == ABOUT["license"]
    assert all(citation[key] for key in ("message", "authors", "abstract", "type"))


def test_the_recipe_needs_what_the_package_needs(recipe):
    wanted = [requirement(x) for x in ABOUT["dependencies"]]
    python = ("python", ABOUT["requires-python"].removeprefix(">="))
    run = [requirement(x) for x in recipe["requirements"]["run"]]
    assert run == [python, *((CALLED.get(name, name), floor) for name, floor in wanted)]
    (build,) = PROJECT["build-system"]["requires"]
    host = recipe["requirements"]["host"]
    assert [requirement(x) for x in host if x != "pip"] == [python, requirement(build)]


def test_every_package_and_its_data_are_in_the_wheel():
    there = {p.parent.relative_to(ROOT).as_posix().replace("/", ".") for p in ROOT.glob("*/**/__init__.py")}
    told = PROJECT["tool"]["setuptools"]
    assert set(told["packages"]) == {x for x in there if x.split(".")[0] in ("analytic", "mcgw")}
    for package, patterns in told["package-data"].items():
        data = {p for pattern in patterns for p in (ROOT / package).glob(pattern)}
        others = {p for p in (ROOT / package).rglob("*.*") if p.suffix != ".py" and p.is_file()}
        assert {p for p in others if p.parent.name != "__pycache__"} == data


def test_the_page_on_architecture_names_every_layer_in_its_order():
    named = re.findall(r"\*\*`(\w+)`\*\*", text_of("docs/explanation/architecture.md"))
    assert named == [name for name in LAYERS if name not in ("errors", "cli")]

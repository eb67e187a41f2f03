"""Any scene that is taken is written as a text that reads as the same; any that is not is refused by key."""

import os
import re

import tomli_w
from hypothesis import HealthCheck, given, settings, strategies as st

import mcgw

TABLES = ("surface", "grading", "heights", "summits", "contact", "interaction", "joint", "ensemble")
MANY = settings(
    max_examples=int(os.environ.get("MCGW_SCENES", "60")),
    deadline=None,
    derandomize=True,
    suppress_health_check=list(HealthCheck),
)


def numbers(low, high):
    return st.floats(low, high, allow_nan=False)


def texts(low, high, unit):
    """Numbers as they are, or as texts with a unit."""
    return numbers(low, high) | numbers(low, high).map(lambda x: f"{x!r} {unit}")


def some(**keys):
    """Some keys of a table."""
    return st.fixed_dictionaries({}, optional=keys)


def all_of(beside=None, **keys):
    return st.fixed_dictionaries(keys, optional=beside or {})


YIELDS = st.sampled_from(["kogut-etsion", "chang-etsion-bogy", "zhao-maietta-chang"])
POISSON = {"poisson": numbers(0, 0.5)}
SURFACES = all_of(
    {"uncertainty": some(sigma=numbers(0.01, 0.3), eta=st.sampled_from(["20 %", "1 %"]))},
    sigma=texts(1e-7, 5e-6, "m"),
    radius=texts(1e-6, 1e-3, "m"),
    eta=numbers(1e7, 1e10),
    nominal_area=texts(1e-8, 1e-4, "m^2"),
    E_star=texts(1e9, 3e11, "Pa"),
)
SPECTRA = all_of(
    m0=numbers(1e-13, 1e-11),
    m2=numbers(1e-4, 1e-2),
    m4=numbers(1e8, 1e10),
    nominal_area=numbers(1e-8, 1e-5),
    E_star=numbers(1e9, 3e11),
)
GRADINGS = (
    all_of({"negative": st.sampled_from(["clip", "allow", "error"])}, gamma=numbers(-1, 3))
    | all_of(
        law=st.just("table"),
        s=st.just([-1.0, 0.5, 2.0]),
        ratio=st.lists(numbers(0.5, 3), min_size=3, max_size=3),
    )
    | all_of(law=st.just("homogeneous"))
)
HEIGHTS = (
    all_of(law=st.just("weibull"), shape=numbers(1, 100))
    | all_of(law=st.just("nayak"), alpha=numbers(1.51, 50))
    | all_of(law=st.sampled_from(["gaussian", "exponential"]))
    | all_of(
        {"resample": st.booleans()},
        law=st.just("table"),
        heights=st.lists(numbers(-1, 1), min_size=3, max_size=5, unique=True),
    )
)
LAWS = (
    all_of(POISSON, name=YIELDS, hardness=texts(1e8, 2e10, "Pa"))
    | all_of({"bridge": st.just("hermite")}, name=st.just("kogut-etsion"), critical=numbers(1e-3, 10))
    | all_of(name=st.just("jackson-green"), yield_strength=texts(1e8, 2e9, "Pa"))
    | all_of(name=st.just("power-law-graded"), k=numbers(0, 0.99), c0=texts(1e-7, 1e-4, "m"))
    | all_of(name=st.just("coated"), ratio=numbers(0.2, 5), thickness=texts(1e-8, 1e-5, "m"))
    | all_of(
        name=st.sampled_from(["derjaguin-muller-toporov", "johnson-kendall-roberts"]), work=numbers(1e-3, 0.1)
    )
    | all_of(POISSON, hardness=texts(1e8, 2e10, "Pa"))
    | st.just("hertz")
)
CONTACTS = all_of(
    {
        "law": LAWS,
        "unload_from": st.just("loop") | numbers(-1, 0),
        "datum": st.sampled_from(["summits", "surface"]),
        "quantities": st.lists(
            st.sampled_from(["load", "area", "contacts", "yielded", "conductance"]), min_size=1, unique=True
        ),
    },
    separations=numbers(0, 3)
    | st.lists(numbers(0, 4), min_size=1, max_size=4)
    | st.just({"start": 0, "stop": 3, "num": 7}),
)
BESIDE = {
    "rms": texts(1e-6, 9e-6, "m"),
    "film_resistance": numbers(0, 1e-6),
    "gas": st.sampled_from(["air", "vacuum", {"conductivity": 0.1, "jump": "1 um"}]),
    "layer": st.just({"thickness": "10 um", "conductivity": 1.3}),
}
JOINTS = all_of(BESIDE, conductivities=st.lists(numbers(0.1, 400), min_size=2, max_size=2)) | all_of(
    {"film_resistance": numbers(0, 1e-6)}, resistivity=texts(1e-8, 1e-5, "ohm m")
)
ENSEMBLES = some(
    n_surfaces=st.integers(1, 1000),
    n_asperities=st.integers(1, 10**5),
    seed=st.integers(0, 2**64 - 1),
    count=st.sampled_from(["fixed", "poisson"]),
    sampler=st.sampled_from(["auto", "tail", "cells", "direct"]),
    keep=st.sampled_from(["sums", "statistics"]),
    accuracy=numbers(0, 0.1),
    rel_err=numbers(1e-4, 0.1) | st.just("1 %"),
    max_seconds=texts(1, 1e3, "s"),
)
SCENES = all_of(
    {
        "title": st.text("abc \"'\n\\é", max_size=5),
        "grading": GRADINGS,
        "heights": HEIGHTS,
        "summits": some(curvature=st.sampled_from(["random", "mean"])),
        "joint": JOINTS,
        "interaction": all_of(reference=st.sampled_from(["body", "mean-plane"])),
        "ensemble": ENSEMBLES,
    },
    surface=SURFACES | SPECTRA,
    contact=CONTACTS,
)


@MANY
@given(SCENES)
def test_text_and_scene_are_the_same(document):
    try:
        scene = mcgw.scene_from(tomli_w.dumps(document))
    except mcgw.SceneError as error:
        for line in error.problems:
            assert re.match(rf"({'|'.join(TABLES)})\b", line), line
            assert len(line) < 300
        return
    text = mcgw.scene_text(scene)
    again = mcgw.scene_from(text)
    assert again == scene
    assert mcgw.scene_text(again) == text
    assert scene.replace(title=scene.title) == scene


PIECES = st.sampled_from(
    [
        "nan",
        "-inf",
        "1e400",
        "-0.0",
        "1e-320",
        "9" * 20,
        "2026-11-21",
        "[]",
        "{}",
        "[[1]]",
        "''",
        '"',
        "\0",
        "[" * 999,
    ]
) | st.text(max_size=3)
LINES = tomli_w.dumps(
    {
        "title": "noise",
        "surface": {"sigma": 1e-6, "radius": 1e-5, "eta": 1e9, "nominal_area": 1e-6, "E_star": 1e11},
        "grading": {"law": "exponential", "gamma": 2.0},
        "contact": {"separations": {"start": 0.0, "stop": 4.0, "num": 5}, "quantities": ["load"]},
        "ensemble": {"n_surfaces": 10, "n_asperities": 1000, "count": "fixed", "seed": 5},
    }
).splitlines()


@MANY
@given(st.lists(st.tuples(st.sampled_from(range(len(LINES))), st.integers(0, 30), PIECES), max_size=3))
def test_noise_in_a_text_is_read_or_refused(noise):
    """A line that is cut, and goes on with something else."""
    lines = [*LINES]
    for at, end, piece in noise:
        lines[at] = f"{lines[at][:end]}{piece}"
    told = ["read"]
    try:
        scene = mcgw.scene_from("\n".join(lines))
    except mcgw.SceneError as error:
        told = error.problems
    assert all(line and "\n" not in line for line in told)
    assert told != ["read"] or mcgw.scene_from(mcgw.scene_text(scene)) == scene

"""Every option of every command says or writes something else: one row at least for each, or this fails."""

import argparse
import dataclasses
import re
import shlex
from collections import namedtuple
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any, ClassVar

import h5py
import numpy as np
import pytest
from oracles.said import call as command_here, without_notes

import analytic
import mcgw
from mcgw.cli import _parser, main
from mcgw.figures.contact_map import EllipseCollection
from mcgw.jobs import executors
from mcgw.jobs.running import run
from mcgw.maps import read_map
from mcgw.store.ensembles import read_attributes

pytestmark = pytest.mark.usefixtures("blank_figures", "looked_at_here", "one_pressure", "without_layout")

SCENE = """
title = "Flags"
surface = {sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11}
grading = {gamma = 1.5}
contact = {separations = [0.0, 1.0]}
ensemble = {n_surfaces = 70, n_asperities = 300, seed = 5}
"""
Said = namedtuple("Said", "code out err folder files")  # what a command left behind
SPECTRUM = ["--from-spectrum", "rms=1um,long=30um,short=6um", "--shape", "128", "--pixel", "1um"]


@pytest.fixture
def without_layout(monkeypatch):
    """That of figures which nobody sees takes most of their time."""
    monkeypatch.setattr("matplotlib.layout_engine.ConstrainedLayoutEngine.execute", lambda *_: None)


@pytest.fixture(scope="module")
def material(tmp_path_factory):
    """What commands read: scenes, an ensemble, a run in two shares, a map, a table."""
    folder = tmp_path_factory.mktemp("material")
    (folder / "s.toml").write_text(SCENE)
    (folder / "noseed.toml").write_text(SCENE.replace(", seed = 5", ""))
    (folder / "rule.toml").write_text(SCENE.replace("n_surfaces = 70", "rel_err = 0.05, max_surfaces = 500"))
    (folder / "t.csv").write_text("s,ratio\n0.0,1.0\n1.0,3.0\n")
    scene = mcgw.load_scene(folder / "s.toml")
    run(scene, folder / "e.h5")
    assert main(["surface", *SPECTRUM, "--seed", "3", "-o", str(folder / "map.h5")]) == 0
    z = read_map(folder / "map.h5").heights
    np.save(folder / "bare.npy", z)
    holes, spiked = z.copy(), z.copy()
    lined = z + 2e-7 * np.random.default_rng(9).normal(size=(len(z), 1))
    marked = z.copy()
    holes[25:35, 50:65], marked[25:35, 50:65] = np.nan, 8e-6
    spiked[25::30, 20::35] += 3e-5
    np.save(folder / "marked.npy", marked)
    for name, heights in (("holes", holes), ("spiked", spiked), ("lined", lined)):
        np.save(folder / f"{name}.npy", heights)
    return folder


@pytest.fixture(scope="module")
def call(material, tmp_path_factory):
    """Run a command in a folder of its own; @name is a file of the material."""

    def call(words):
        folder = tmp_path_factory.mktemp("call")
        words = [str(material / w[1:]) if w.startswith("@") else w for w in words]
        done = command_here(*words, cwd=folder)
        files = sorted(p.name for p in folder.rglob("*") if p.is_file())
        return Said(done.returncode, done.stdout, done.stderr, folder, files)

    return call


@pytest.fixture(scope="module")
def once(call):
    """The same, but each command line is run once a module: nobody changes what it left."""
    return cache(lambda *words: call(words))


# --- what rows look at ------------------------------------------------------------------------------


def writes(*names, instead=()):
    """Files that are there with the option and not without it."""

    def check(plain, given):
        assert set(names) <= set(given.files), given.files
        assert not set(names) & set(plain.files)
        assert not set(instead) & set(given.files)
        assert given.code == plain.code == 0, given.err

    return check


def says(text, *, code=0, err=""):
    """Words that are said with the option and not without it."""

    def check(plain, given):
        assert given.code == code, given.err
        assert text in given.out, given.out
        assert text not in plain.out
        assert err in given.err

    return check


def refuses(text):
    """What it is given reaches what checks it: an error in one line."""

    def check(plain, given):
        assert plain.code == 0, plain.err
        assert given.code == 2, (given.out, given.err)
        assert text in given.err
        assert given.err.count("\n") == 1

    return check


def map_of(said, name="m.h5"):
    assert said.code == 0, said.err
    return read_map(said.folder / name)


# --- the rows ---------------------------------------------------------------------------------------


def other_heights(plain, given):
    a, b = map_of(plain).heights, map_of(given).heights
    assert a.shape == b.shape
    assert not np.array_equal(a, b)


def heights_are_three_times_those(plain, given):
    np.testing.assert_allclose(map_of(given).heights, 3 * map_of(plain).heights, atol=1e-15)


def surface_is_the_seventh(plain, given):
    """Heights of the asperities of that very surface."""
    scene = mcgw.scene_from(SCENE)
    for said, k in ((plain, 0), (given, 7)):
        with h5py.File(said.folder / "m.h5") as file:
            z = file["asperities/z"][()] / scene.surface.sigma
        touching = np.sort(z[z > scene.lowest])
        np.testing.assert_allclose(touching, np.sort(mcgw.heights(scene, k)), rtol=1e-12)


def shape_is(rows, columns):
    def check(plain, given):
        assert map_of(given).heights.shape == (rows, columns) != map_of(plain).heights.shape

    return check


def width_is_2_mm(plain, given):
    assert map_of(given).size == pytest.approx((2e-3, 5e-4))
    assert map_of(plain).size == pytest.approx((1e-3, 1e-3))


def edges_are_joined(plain, given):
    a, b = map_of(plain), map_of(given)
    assert np.all(b.heights >= a.heights)  # caps from across the edge lie on top
    assert np.any(b.heights[:, 0] > a.heights[:, 0])


def pixel_is_2_um(plain, given):
    assert map_of(given).pixel == pytest.approx((2e-6, 2e-6))
    assert map_of(plain).pixel == pytest.approx((1e-6, 1e-6))


def same_draws(plain, given):
    """Never changes a bit, and says that there are not so many."""
    a, b = (mcgw.open_ensemble(x.folder / "a.h5") for x in (plain, given))
    np.testing.assert_array_equal(a.load, b.load)
    assert "--threads 99: this machine has" in given.err
    assert "--threads" not in plain.err


def share_drawn(plain, given):
    assert given.code == 0, given.err
    assert "a.h5.parts: share 1/2 is done" in given.out
    assert not (given.folder / "a.h5").exists()
    assert (given.folder / "a.h5.parts" / "run.toml").is_file()
    assert (plain.folder / "a.h5").is_file()


def digest_alone(plain, given):
    assert len(given.out.strip()) == 64
    assert given.out.strip() in plain.out


def scene_alone(plain, given):
    assert mcgw.scene_from(given.out).seed == 5


def csv_columns(name, *columns):
    def check(plain, given):
        writes(name)(plain, given)
        head, *rows = (given.folder / name).read_text().splitlines()
        assert set(columns) <= set(head.split(",")), head
        assert len(rows) >= 2
        assert f"{name}: the table" in given.out

    return check


def scene_has(**fields):
    """Of the ensemble that is written."""

    def check(plain, given):
        assert given.code == 0, given.err
        (path,) = given.folder.glob("*.h5")
        others = [mcgw.open_ensemble(path).scene for path in plain.folder.glob("*.h5")]
        for name, value in fields.items():
            assert getattr(mcgw.open_ensemble(path).scene, name) == value
            assert all(getattr(other, name) != value for other in others)

    return check


def fitted(differs):
    """Surfaces of the two scenes."""

    def check(plain, given):
        assert given.code == 0, given.err
        a, b = (mcgw.load_scene(x.folder / "f.toml").surface for x in (plain, given))
        assert differs(a, b), (a, b)

    return check


def heights_are_a_table(plain, given):
    laws = [mcgw.load_scene(x.folder / "f.toml").heights for x in (plain, given)]
    assert [isinstance(law, analytic.HeightTable) for law in laws] == [False, True]


def errors_differ(plain, given):
    """Other sub-areas, other errors of the same estimates."""
    assert given.code == 0, given.err
    a, b = (re.findall(r"^ *summits counted +(.*)", x.out, re.MULTILINE) for x in (plain, given))
    assert a != b
    assert [x.split(" +- ")[0] for x in a] == [x.split(" +- ")[0] for x in b]


def exported(said):
    """Of what Abaqus is given: lines that are neither comment nor keyword."""
    assert said.code == 0, said.err
    return np.loadtxt(said.folder / "a.inp", comments="*", delimiter=",")


def rows_are(number):
    def check(plain, given):
        assert len(exported(given)) == number != len(exported(plain))

    return check


def in_mm(plain, given):
    """Pressure in MPa, overclosure in mm."""
    np.testing.assert_allclose(exported(given), exported(plain) * [1e-6, 1e3], rtol=1e-8)


E = "@e.h5"
RUN = "@s.toml -o a.h5"
SWEEP = "@s.toml --over grading.gamma=1,2 -o a.h5"
INP, OF_SCENE = "@e.h5 --to abaqus -o a.inp", "@s.toml --to abaqus -o a.inp"
MAP = "@s.toml --shape 200 -o m.h5"
HDF = "@s.toml --shape 200 -o m.h5"
GAUSS = "--from-spectrum rms=1um,long=30um,short=6um --shape 128 --pixel 1um -o m.h5"
FIT = "@map.h5 --cutoff none -o f.toml"

# Command, option, its words without the option, with it ("+": after those, the last of two counts), and what
# that must change.
ROWS = [
    ("init", "PRESET", "", "coating", writes("coating.toml", instead=["demo.toml"])),
    ("init", "--output", "", "-o x.toml", writes("x.toml", instead=["demo.toml"])),
    ("init", "--schema", "", "--schema", writes("scene.schema.json")),
    ("run", "--set", RUN, "+ --set ensemble.n_surfaces=9", says("a.h5: 9 surfaces")),
    ("run", "--set", RUN, "+ --set grading.gama=2", refuses("grading.gama: unknown key; did you mean gamma")),
    ("run", "--set", RUN, "+ --set gamma", refuses("--set gamma: give KEY=VALUE")),
    ("sweep", "--set", SWEEP, "+ --set ensemble.seed=9", says("seed 9")),
    ("show", "--set", "@s.toml --plan", "+ --set contact.law=kogut-etsion --set contact.critical=0.05",
     says("KogutEtsion")),
    ("solve", "--set", "@s.toml --load 1N -v", "+ --set ensemble.n_surfaces=9", says(": 9 surfaces")),
    ("show", "--set", E, "+ --set grading.gamma=2", refuses("works only with --plan")),
    ("export", "--set", INP, "@e.h5 --to abaqus -o a.inp --set grading.gamma=2", refuses("give a scene")),
    ("run", "--output", RUN, "@s.toml -o b.h5", writes("b.h5", instead=["a.h5"])),
    ("run", "--threads", RUN, "+ --threads 99", same_draws),
    ("run", "--threads", RUN, "+ --threads 0", refuses("threads = 0: give")),
    ("run", "--threads", RUN, "+ --threads 0 --shard 1/2", refuses("threads = 0: give")),
    ("run", "--threads", RUN, "@rule.toml -o a.h5 --threads 0", refuses("threads = 0: give")),
    ("run", "--jobs", RUN, "+ --jobs 0", refuses("--jobs 0: give a whole number >= 1")),
    ("run", "--shard", RUN, "+ --shard 1/2", share_drawn),
    ("run", "--shard", RUN, "+ --shard 3/2", refuses("--shard 3/2: give i/n")),
    ("sweep", "--output", SWEEP, "+ -o b.h5", writes("b.h5", instead=["a.h5"])),
    ("sweep", "--over", SWEEP, "+ --over ensemble.seed=1,2", says("a.h5: 4 scenes")),
    ("sweep", "--over", SWEEP, "+ --over ensemble.seed", refuses("--over ensemble.seed: give")),
    ("sweep", "--zip", f"{SWEEP} -v", "+ --zip --over ensemble.seed=1,2", says("1, 1 ")),
    ("sweep", "--threads", SWEEP, "+ --threads 0", refuses("threads = 0: give")),
    ("sweep", "--jobs", SWEEP, "+ --jobs 0", refuses("--jobs 0: give a whole number >= 1")),
    ("sweep", "--shard", SWEEP, "+ --shard 1/2", share_drawn),
    ("sweep", "--shard", SWEEP, "+ --shard 3/2", refuses("--shard 3/2: give i/n")),
    ("sweep", "--plan", SWEEP, "+ --plan", says("computed ")),
    ("show", "--scene", E, "+ --scene", scene_alone),
    ("show", "--digest", E, "+ --digest", digest_alone),
    ("show", "--verify", E, "+ --verify", says("e.h5: intact (")),
    ("show", "--plan", E, "@s.toml --plan", says("not done:")),
    ("show", "--csv", E, "+ --csv x.csv", csv_columns("x.csv", "mean", "std", "stderr")),
    ("compare", "--output", "@e.h5 -o p.png", "@e.h5 -o q.svg", writes("q.svg", instead=["p.png"])),
    ("compare", "--table", "@e.h5 -o p.png", "+ --table", says("normal load (N)\n")),
    ("compare", "--csv", "@e.h5 -o p.png", "+ --csv x.csv",
     csv_columns("x.csv", "mean", "low_95", "high_95", "theory", "residual")),
    ("solve", "--pressure", "@s.toml --pressure 1MPa", "@s.toml --pressure 2MPa",
     says("load 2 N = pressure 2 MPa")),
    ("solve", "--load", "@s.toml --pressure 1MPa", "@s.toml --load 250mN", says("0.25 N = ")),
    ("solve", "--area", "@s.toml --pressure 1MPa", "@s.toml --area 2000um^2", says("2e-09 m^2 = ")),
    ("solve", "--area-fraction", "@s.toml --pressure 1MPa", "@s.toml --area-fraction 0.2%",
     says("2e-09 m^2 = ")),
    *(
        ("solve", "--scatter", "@s.toml --load 1N", f"+ --scatter {x}", refuses(f"--scatter {x}: give"))
        for x in ("1", "2")
    ),
    ("solve", "--scatter", "@s.toml --load 1N", "+ --scatter 0", refuses("--scatter = '0': give")),
    ("solve", "--scatter", "@s.toml --load 1N", "+ --scatter 1%", says("for std = 0.01 of the mean")),
    ("solve", "--surfaces", "@s.toml --load 1N -v", "+ --surfaces 9", says("specimens: 9 surfaces")),
    ("solve", "--nominal-separation", "@s.toml --load 1N", "@s.toml --nominal-separation 1",
     refuses("nominal_separation: it needs [interaction]")),
    ("solve", "--csv", "@s.toml --load 1N", "+ --csv x.csv",
     csv_columns("x.csv", "value", "infinite", "low_95", "high_95", "std")),
    ("export", "--output", INP, "+ -o b.inp", writes("b.inp", "b.q05.inp", instead=["a.inp"])),
    ("export", "--to", INP, "@e.h5 --to moose -o a.csv", writes("a.csv", "a.q95.csv", instead=["a.inp"])),
    ("export", "--table", INP,
     "@e.h5 --to comsol --table stiffness-pressure --pressures 1MPa:2MPa:2 -o a.txt",
     says("a.txt: stiffness-pressure")),
    ("export", "--points", OF_SCENE, "+ --points 7", rows_are(8)),
    ("export", "--pressures", OF_SCENE, "+ --pressures 10MPa:200MPa:5", rows_are(6)),
    ("export", "--quantile", INP, "+ --quantile 0.5", writes("a.q50.inp", instead=["a.q05.inp"])),
    ("export", "--units", INP, "+ --units mm-N-s", in_mm),
    ("report", "--output", "@e.h5 -o a.html", "@e.h5 -o b.html", writes("b.html", instead=["a.html"])),
    ("surface", "--surface", HDF, "+ --surface 7", surface_is_the_seventh),
    ("surface", "--shape", "@s.toml --shape 50 -o m.h5", "@s.toml --shape 60x40 -o m.h5", shape_is(40, 60)),
    ("surface", "--shape", GAUSS, "+ --shape 128x100", shape_is(100, 128)),
    ("surface", "--width", MAP, "+ --width 2mm", width_is_2_mm),
    ("surface", "--periodic", MAP, "+ --periodic", edges_are_joined),
    ("surface", "--at", MAP, "@s.toml -o m.png --at 1", writes("m.png", instead=["m.h5"])),
    ("surface", "--at", MAP, "@s.toml -o m.png --at 1", says(" contacts, ")),
    ("surface", "--from-spectrum", GAUSS, "+ --from-spectrum rms=3um,long=30um,short=6um",
     heights_are_three_times_those),
    ("surface", "--pixel", GAUSS, "+ --pixel 2um", pixel_is_2_um),
    ("surface", "--seed", GAUSS, "+ --seed 4", other_heights),
    ("surface", "--seed", GAUSS, "+ --seed -1", refuses("--seed -1: give a whole number >= 0")),
    ("surface", "SCENE", GAUSS, f"@s.toml {GAUSS}", refuses("a map without asperities; leave out SCENE")),
    ("surface", "--at", GAUSS, "+ --at 1", refuses("a map without asperities; leave out")),
    ("surface", "--width", MAP, "+ --width -1mm", refuses("--width = '-1mm': give a number > 0")),
    ("surface", "--output", MAP, "@s.toml --shape 200 -o n.npy", writes("n.npy", instead=["m.h5"])),
    ("fit", "--cutoff", FIT, "@map.h5 --cutoff 10um -o f.toml", fitted(lambda a, b: b.eta < 0.8 * a.eta)),
    ("fit", "--form", FIT, "+ --form quadratic", fitted(lambda a, b: b.sigma < a.sigma)),
    ("fit", "--pixel", FIT, "@bare.npy --cutoff none -o f.toml --pixel 2um",
     fitted(lambda a, b: b.eta == pytest.approx(a.eta / 4, rel=1e-6))),
    ("fit", "--unit", "@bare.npy --cutoff none -o f.toml --pixel 1um", "+ --unit mm",
     fitted(lambda a, b: b.sigma == pytest.approx(a.sigma / 1e3, rel=1e-6))),
    ("fit", "--use", FIT, "+ --use moments", fitted(lambda a, b: b.eta != a.eta)),
    ("fit", "--heights", FIT, "+ --heights table", heights_are_a_table),
    ("fit", "--heights", FIT, "+ --heights measured", writes("f.heights.npy")),
    ("fit", "--long-cutoff", FIT, "+ --long-cutoff 20um", fitted(lambda a, b: b.sigma < 0.9 * a.sigma)),
    ("fit", "--missing-value", "@marked.npy --cutoff none --pixel 1um -o f.toml", "+ --missing-value 8e-6",
     fitted(lambda a, b: b.sigma < a.sigma)),
    ("fit", "--missing", "@holes.npy --cutoff none --pixel 1um -o f.toml", "+ --missing fill",
     fitted(lambda a, b: b.nominal_area > a.nominal_area)),
    ("fit", "--spikes", "@spiked.npy --cutoff none --pixel 1um -o f.toml", "+ --spikes remove",
     fitted(lambda a, b: b.radius > a.radius)),
    ("fit", "--lines", "@lined.npy --cutoff none --pixel 1um -o f.toml", "+ --lines rows",
     fitted(lambda a, b: b.radius > a.radius)),
    ("fit", "--trim", FIT, "+ --trim 15", fitted(lambda a, b: b.nominal_area < a.nominal_area)),
    ("fit", "--picture", FIT, "+ --picture f.png", writes("f.png")),
    ("fit", "--E-star", FIT, "+ --E-star 5e9", fitted(lambda a, b: (a.E_star, b.E_star) == (1e11, 5e9))),
    ("fit", "--nominal-area", FIT, "+ --nominal-area 1cm^2",
     fitted(lambda a, b: b.nominal_area == 1e-4 != a.nominal_area)),
    ("fit", "--parts", f"{FIT} -v", "+ --parts 3", errors_differ),
    ("fit", "--summits", FIT, "+ --summits s.csv", writes("s.csv")),
    ("fit", "--tiles", FIT, "+ --tiles t.csv", writes("t.csv")),
    ("fit", "--profile", "@bare.npy --cutoff none -o f.toml --pixel 1um", "+ --profile",
     refuses("holds 2 dimensions")),
    ("fit", "--output", FIT, "@map.h5 --cutoff none -o g.toml", writes("g.toml", instead=["f.toml"])),
]  # fmt: skip

# Options whose commands take long, or need several calls: by tests of their own below.
APART = {
    ("run", "--dask"): "test_executors_are_those_asked_for",
    ("sweep", "--dask"): "test_executors_are_those_asked_for",
    ("merge", "FILE"): "test_merge_makes_the_file_that_is_named",
    ("merge", "--output"): "test_merge_makes_the_file_that_is_named",
    ("tradeoff", "--output"): "test_tradeoff_takes_its_folder_and_its_time",
    ("tradeoff", "--seconds"): "test_tradeoff_takes_its_folder_and_its_time",
    ("compare", "--laws"): "test_compare_takes_laws",
    ("elastic", "--pressure"): "test_elastic_takes_its_question",
    ("elastic", "--separation"): "test_elastic_takes_its_question",
    ("elastic", "--E-star"): "test_elastic_takes_its_question",
    ("elastic", "--pixel"): "test_elastic_takes_its_question",
    ("elastic", "--unit"): "test_elastic_takes_its_question",
    ("elastic", "--rel-err"): "test_elastic_takes_its_question",
    ("elastic", "--solves"): "test_elastic_takes_its_question",
    ("elastic", "--seed"): "test_elastic_takes_its_question",
    ("elastic", "--output"): "test_elastic_takes_its_question",
    ("elastic", "--set"): "test_elastic_takes_its_question",
    ("figures", "--output"): "test_figures_take_folder_scene_and_csv",
    ("figures", "--scene"): "test_figures_take_folder_scene_and_csv",
    ("figures", "--csv"): "test_figures_take_folder_scene_and_csv",
    ("figures", "--only"): "test_figures_take_folder_scene_and_csv",
    ("figures", "--format"): "test_figures_take_folder_scene_and_csv",
    ("figures", "--list"): "test_figures_take_folder_scene_and_csv",
    ("surface", "--colour"): "test_colours_tell_what_was_asked",
    ("", "--version"): "test_version",
    ("converge", "--output"): "test_converge_takes_its_folder",
    ("converge", "--set"): "test_a_study_is_of_the_values_that_are_set",
    ("tradeoff", "--set"): "test_a_study_is_of_the_values_that_are_set",
}


def options_of(parser, command=""):
    """(command, option) of all that may be given or left out."""
    found = set()
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for name, sub in action.choices.items():
                found |= options_of(sub, name)
        elif action.option_strings and "--help" not in action.option_strings:
            found.add((command, max(action.option_strings, key=len)))
        elif not action.option_strings and action.nargs == "?":
            found.add((command, action.metavar))
    return found


def test_every_option_of_every_command_has_its_row():
    tested = {row[:2] for row in ROWS} | set(APART)
    there = {row for row in options_of(_parser()) if row[1] not in ("--quiet", "--verbose")}  # of all alike
    assert there - tested == set(), "a new option: give it a row in which it changes something"
    assert tested - there == set(), "no such option any more"
    for name in APART.values():
        assert name in globals() or " " in name, name


@pytest.mark.parametrize(
    ("command", "option", "words", "given", "check"), ROWS, ids=[" ".join(r[:2]) for r in ROWS]
)
def test_it_changes_what_is_said_or_written(command, option, words, given, check, once):
    given = f"{words} {given[2:]}" if given.startswith("+ ") else given
    check(once(command, *words.split()), once(command, *given.split()))


# Of a number on the command line: the last that is taken, and the first that is not.
EXPORT = "export @s.toml --to moose -o t.csv"
ENDS = [
    ("sweep @s.toml --plan --over grading.gamma=1:2:", "2", "1"),
    ("sweep @s.toml --plan --over grading.gamma=1:2:", "2", "1.5"),
    ("sweep @s.toml --plan --over grading.gamma=1:2:", "3", "1000001"),
    (f"{EXPORT} --pressures 1MPa:", "2MPa:2", "2MPa:1"),
    (f"{EXPORT} --pressures 1MPa:", "1.1MPa:2", "1MPa:2"),
    (f"{EXPORT} --points ", "2", "1"),
    (f"{EXPORT} --points ", "3", "10001"),
    (f"{EXPORT} --points 3 --quantile ", "0.001", "0"),
    (f"{EXPORT} --points 3 --quantile ", "0.999", "1"),
    ("solve @s.toml --pressure 1MPa --scatter ", "99%", "100%"),
    ("solve @s.toml --pressure 1MPa --scatter ", "1%", "0%"),
    (
        "surface --from-spectrum rms=1um,long=20um,short=5um --pixel 1um --shape 32 -o m.h5 --seed ",
        "0",
        "-1",
    ),
]


@pytest.mark.parametrize(("words", "taken", "refused"), ENDS)
def test_numbers_are_taken_up_to_their_ends(once, words, taken, refused):
    assert once(*f"{words}{taken}".split()).code == 0
    said = once(*f"{words}{refused}".split())
    assert (said.code, said.files, said.err.count("\n")) == (2, [], 1), said.err


# --- those apart ------------------------------------------------------------------------------------


class Recorder(ThreadPoolExecutor):
    """An executor that draws in this process and remembers how it was made."""

    made: ClassVar[list[Any]] = []

    def __init__(self, *arguments):
        super().__init__(1)
        self.made.append(arguments)

    def submit(self, attempt, task, *arguments):
        self.made.append(task.__name__)
        return super().submit(attempt, task, *arguments)

    def shutdown(self, *arguments, **options):
        self.made.append("ended")
        super().shutdown(*arguments, **options)


@pytest.mark.parametrize("command", [f"run {RUN}", "run @rule.toml -o a.h5", f"sweep {SWEEP}"])
@pytest.mark.parametrize(
    ("words", "name", "made"),
    [("--jobs 3", "Jobs", (3,)), ("--dask tcp://h:1", "dask_executor", ("tcp://h:1",))],
)
def test_executors_are_those_asked_for(call, monkeypatch, command, words, name, made):
    """They are made as asked, given the blocks, and ended; the file is that of the threads."""
    read = mcgw.open_sweep if command.startswith("sweep") else mcgw.open_ensemble
    monkeypatch.setattr(executors, name, Recorder)
    Recorder.made.clear()
    given = call(f"{command} {words}".split())
    assert given.code == 0, given.err
    assert (Recorder.made[0], Recorder.made[1], Recorder.made[-1]) == (made, "commit_block", "ended")
    plain = call(command.split())
    assert len([x for x in Recorder.made if isinstance(x, tuple)]) == 1
    np.testing.assert_array_equal(*(read(x.folder / "a.h5").mean("load") for x in (plain, given)))


def test_threads_are_so_many_while_it_draws(call, monkeypatch):
    import numba

    from mcgw.sampling import counted

    seen = []
    block = counted.Counted.block

    def spy(self, first, n):
        seen.append(numba.get_num_threads())
        return block(self, first, n)

    monkeypatch.setattr(counted.Counted, "block", spy)
    before = numba.get_num_threads()
    assert call(["run", "@s.toml", "-o", "a.h5", "--threads", "1"]).code == 0
    assert seen[-1] == 1
    assert numba.get_num_threads() == before


def test_a_recorded_seed_is_taken_and_one_that_is_given_holds(call, material):
    """A scene without a seed goes on with the one that its file has; somewhere else it draws another."""
    first = call(["run", "@noseed.toml", "-o", "a.h5"])
    path = first.folder / "a.h5"
    seed = mcgw.open_ensemble(path).scene.seed
    load = mcgw.open_ensemble(path).load
    longer = material / "longer.toml"
    longer.write_text((material / "noseed.toml").read_text().replace("n_surfaces = 70", "n_surfaces = 90"))
    again = call(["run", "@longer.toml", "-o", str(path)])
    assert (again.code, without_notes(again.err)) == (0, "")
    assert f"90 surfaces of 300 asperities, seed {seed}" in again.out
    np.testing.assert_array_equal(mcgw.open_ensemble(path).load[:70], load)
    other = call(["run", "@noseed.toml", "-o", "a.h5"])
    assert mcgw.open_ensemble(other.folder / "a.h5").scene.seed != seed
    given = call(["run", "@s.toml", "-o", "a.h5"])
    assert mcgw.open_ensemble(given.folder / "a.h5").scene.seed == 5


def test_a_seed_of_a_run_in_progress_is_taken(call, material):
    first = call(["run", "@noseed.toml", "-o", "a.h5", "--shard", "1/2"])
    place = str(first.folder / "a.h5")
    assert call(["run", "@noseed.toml", "-o", place, "--shard", "2/2"]).code == 0
    merged = call(["merge", place])
    assert merged.code == 0, merged.err
    assert "70 surfaces" in merged.out


def test_merge_makes_the_file_that_is_named(call):
    place = call(["run", "@s.toml", "-o", "a.h5", "--shard", "1/1"]).folder / "a.h5"
    assert not place.exists()
    assert call(["merge"]).code == 2
    both = call(["merge", str(place), "-o", "elsewhere.h5"])
    assert both.code == 2
    assert "elsewhere.h5" in both.err
    assert not place.exists()
    done = call(["merge", "-o", str(place)])
    assert done.code == 0, done.err
    assert f"{place}: 70 surfaces, seed 5" in done.out
    assert place.is_file()
    place = call(["run", "@s.toml", "-o", "a.h5", "--shard", "1/1"]).folder / "a.h5"
    assert call(["merge", str(place)]).code == 0
    assert place.is_file()


def test_converge_takes_its_folder(call):
    said = call(["converge", "@s.toml", "-o", "there/deep"])
    assert said.files == ["s-converge.png"]
    assert (said.folder / "there/deep/s-converge.png").is_file()


@pytest.fixture
def few_methods(monkeypatch):
    """Studies of speed and accuracy look at two methods alone."""
    from mcgw.statistics import tradeoff

    monkeypatch.setattr(tradeoff, "sampled_ways", lambda scene: ["tail"])


@pytest.mark.parametrize("study", ["converge", "tradeoff"])
@pytest.mark.usefixtures("few_methods")
def test_a_study_lies_beside_its_scene(study, tmp_path):
    """In a folder that is made."""
    (tmp_path / "there").mkdir()
    (tmp_path / "there/s.toml").write_text(SCENE)
    words = {"converge": [], "tradeoff": ["--seconds", "0.1"]}
    done = command_here(study, "there/s.toml", *words[study], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert [*tmp_path.rglob("*.png")] == [tmp_path / f"there/out/s-{study}.png"]


@pytest.mark.parametrize("study", ["converge", "tradeoff"])
def test_a_study_is_of_the_values_that_are_set(call, study):
    said = call([study, "@s.toml", "--set", "ensemble.seed=-1"])
    assert said.code == 2
    assert "ensemble.seed = -1: give a whole number" in said.err


@pytest.mark.usefixtures("few_methods")
def test_tradeoff_takes_its_folder_and_its_time(call, monkeypatch):
    from mcgw.statistics import tradeoff

    seen = []
    study = tradeoff.tradeoff

    def spy(scene, *, seconds, progress):
        seen.append(seconds)
        return study(scene, seconds=0.01, progress=progress)

    monkeypatch.setattr(tradeoff, "tradeoff", spy)
    said = call(["tradeoff", "@s.toml", "-o", "there", "--seconds", "7.5"])
    assert said.code == 0, said.err
    assert sorted(p.name for p in (said.folder / "there").iterdir()) == [
        "s-tradeoff-measured.csv", "s-tradeoff.csv", "s-tradeoff.png"
    ]  # fmt: skip
    assert seen == [7.5]


def test_compare_takes_laws(call, monkeypatch):
    """What is said then is of the values of surfaces, wherever they are the least likely."""
    from mcgw.statistics import laws_of_values

    found = laws_of_values.LawsOfValues(24, "load", 1.5, 0.25, 1e-9)
    monkeypatch.setattr(laws_of_values, "laws_of_values", lambda ensemble: found)
    said = call(["compare", "@e.h5", "-o", "p.png", "--laws"])
    assert said.code == 1
    assert "the distribution of load at d/sigma = 1.5 differs by 0.25, the most of 24" in said.out
    assert call(["compare", "@e.h5", "-o", "p.png"]).code == 0


def test_elastic_takes_its_question(call, material, monkeypatch):
    """Every option reaches the function, and a scene its changes; nothing is solved."""
    from mcgw.elasticity import elastic

    seen = []

    def spy(source, **given):
        seen.append((source, given))
        raise ValueError("seen")

    monkeypatch.setattr(elastic, "elastic", spy)
    words = "@s.toml --pressure 2MPa --E-star 5e9 --rel-err 0.1 --solves 9 --seed 4 -o e.jsonl"
    said = call(["elastic", *shlex.split(words), "--set", "surface.sigma=3e-6"])
    assert (said.code, said.err) == (2, "mcgw: seen\n")
    ((scene, given),) = seen
    assert scene.surface.sigma == 3e-6
    assert given.pop("path").name == "e.jsonl"
    assert callable(given.pop("progress"))
    asked = {"E_star": "5e9", "rel_err": 0.1, "solves": 9, "seed": 4}
    assert given == {"pressure": "2MPa", "separation": None, **asked}
    call(["elastic", "@s.toml", "--separation", "2um"])
    assert (seen[1][1]["pressure"], seen[1][1]["separation"]) == (None, "2um")
    said = call(["elastic", *shlex.split("@s.toml --pressure 2MPa --pixel 2um")])
    assert (said.code, said.err.partition(": is for")[0]) == (2, "mcgw: --pixel 2um")
    call(["elastic", *shlex.split("@bare.npy --pressure 2MPa --pixel 2um --unit mm")])
    assert seen[2][0].pixel == (2e-6, 2e-6)
    assert seen[2][0].heights.std() == pytest.approx(1e-3 * np.load(material / "bare.npy").std())


def test_figures_take_folder_scene_and_csv(call, tmp_path, monkeypatch):
    from mcgw.figures import catalogue

    seen = []

    def first_alone(compared, only):
        seen.append(compared)
        yield (
            "figure-1",
            dataclasses.replace(catalogue.CATALOGUE[0].draw(catalogue.of_paper()), name="figure-1"),
        )
        yield "figure-3", "why not"

    monkeypatch.setattr(catalogue, "figures_of", first_alone)
    assert call(["figures"]).files == ["figure-1.png"]
    words = ["figures", "-o", "there", "--scene", "@s.toml", "--csv", "--format", "png", "pdf", "svg"]
    given = call([*words, "--only", "figure-1", "figure-3"])
    assert given.code == 0, given.err
    assert sorted(p.name for p in (given.folder / "there").iterdir()) == [
        "figure-1.csv", "figure-1.pdf", "figure-1.png", "figure-1.svg"
    ]  # fmt: skip
    scene = mcgw.scene_from(SCENE)
    of_python = scene.replace(grading=lambda s: 1 + 0.3 * np.tanh(s))
    (tmp_path / "python.toml").write_text(mcgw.scene_text(of_python))  # holds the series of that grading
    assert call(["figures", "--scene", str(tmp_path / "python.toml")]).code == 0
    assert "figure-3: not drawn: why not" in given.out
    assert call(["figures", "--list"]).out.split()[:2] == ["figure-1", "figure-2"]
    wrong = call(["figures", "--only", "figure-9"])
    assert (wrong.code, wrong.files) == (2, [])
    assert "--only figure-9: no such figure; give one of figure-1, figure-2, " in wrong.err
    default, *others = seen
    paper = default.scene
    assert (default.swept, paper.n_surfaces, paper.n_asperities, paper.seed) == (True, 2000, 30_000, 20240601)
    one, other = (compared.asked for compared in others)
    assert one == scene
    heights = np.linspace(0, 3, 7)
    np.testing.assert_allclose(other.grading(heights), 1 + 0.3 * np.tanh(heights), rtol=1e-6)


def test_colours_tell_what_was_asked(call, monkeypatch):
    """The numbers that are coloured: loads in mN, or moduli."""
    from mcgw.figures import contact_map

    seen = []

    def spy(*arguments, array, **options):
        seen.append(np.array(array))
        return EllipseCollection(*arguments, array=array, **options)

    monkeypatch.setattr(contact_map, "EllipseCollection", spy)
    for words in ([], ["--colour", "modulus"], ["--colour", "load"]):
        assert call(["surface", "@s.toml", "--at", "1", "-o", "m.png", *words]).code == 0
    scene = mcgw.scene_from(SCENE)
    s = mcgw.heights(scene, 0)
    modulus = 1.5 - 0.5 * np.exp(-s[s > 1])
    load = 1e3 * 4 / 3 * 1e11 * modulus * np.sqrt(1e-5) * ((s[s > 1] - 1) * 1e-6) ** 1.5
    default, by_modulus, by_load = seen
    np.testing.assert_array_equal(default, by_load)
    assert by_modulus.size > 5
    assert set(by_modulus.round(9)) <= set(modulus.round(9))
    shown = by_load[by_load > 1.001e-6 * load.max()]
    assert set(np.round(shown, 6)) <= set(load.round(6))


def test_version(capsys):
    with pytest.raises(SystemExit) as end:
        main(["--version"])
    assert end.value.code == 0
    assert capsys.readouterr().out.startswith("mcgw 0")


def test_places_left_out(call, material):
    """Where a file goes if -o does not say: beside what is read, under its name."""
    for line, name in (
        ("compare @e.h5", "e.png"), ("report @e.h5", "e.html"),
        ("run @s.toml", "out/s.h5"),
    ):  # fmt: skip
        assert call(line.split()).code == 0
        assert (material / name).is_file()
    assert read_attributes(material / "out" / "s.h5")["seed"] == 5

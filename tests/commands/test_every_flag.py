"""Every option of every command reaches the function that does the work: one row each, or this fails.

That the function uses what it is given is tested where the function is.
"""

import argparse
import inspect
import re
import shlex
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from oracles.inside import read_attributes
from oracles.said import call as command_here, without_notes
from oracles.told import ANSWERS

import mcgw
from mcgw.cli import parser_of

near = pytest.approx
pytestmark = pytest.mark.usefixtures("blank_figures", "no_pressures")

SCENE = """
title = "Flags"
surface = {sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11}
grading = {gamma = 1.5}
contact = {separations = [0.0, 1.0]}
ensemble = {n_surfaces = 70, n_asperities = 300, seed = 5}
"""
RUN, SWEEP = "run @s.toml -o a.h5", "sweep @s.toml --over grading.gamma=1,2 -o a.h5"
EXPORT = "export @s.toml --to abaqus -o a.inp"
SOLVE, ELASTIC = "solve @s.toml --load 1N", "elastic @s.toml --pressure 1MPa"
MAP = "surface @s.toml --shape 50 -o m.h5"
GAUSS = "surface --from-spectrum rms=1um,long=30um,short=6um --shape 64x32 --pixel 1um -o m.h5"
FIT, LINES = "fit @map.npy --pixel 1um --cutoff none -o f.toml", "fit @p.txt --cutoff none -o f.toml"

# Command line, the function that must get it, option and words, and the arguments (dotted: of an object).
# What an option shows in a recorded answer (`test_what_users_read`) has no row.
ROWS = [
    *(
        row
        for line, target in ((RUN, "jobs.running:run"), (SWEEP, "jobs.sweeping:sweep"))
        for row in (
            (line, target, "--threads 1", {"threads": 1, "executor": None, "shard": None}),
            (line, target, "--shard 1/2", {"shard": "1/2", "executor": None, "threads": None}),
            (line, target, "--set ensemble.n_surfaces=9", {"scene.n_surfaces": 9, "scene.seed": 5}),
            (line, target, "--set title=007", {"scene.title": "007"}),
            (line, target, "--jobs 3", {"executor.n": 3, "shard": None}),
            (line, "jobs.executors:dask_executor", "--dask tcp://h:1", {"address": "tcp://h:1"}),
        )
    ),
    (SWEEP, "jobs.sweeping:sweep",
     "--over ensemble.seed=-1:3:2 --over surface.eta=3:1:5 --over contact.law=x:1:2,0.5,auto",
     {"over": {"grading.gamma": [1, 2], "ensemble.seed": [-1, 3], "surface.eta": [3, 2.5, 2, 1.5, 1],
               "contact.law": ["x:1:2", 0.5, "auto"]}, "zipped": False}),
    (SWEEP, "jobs.sweeping:sweep", "--zip", {"zipped": True}),
    (f"{SWEEP} --zip --over ensemble.seed=1,2", "sweeps.points:sweep_plan_text", "--plan",
     {"asked.axes.size": 2}),
    ("show --plan @s.toml", "reports.plan:plan_text",
     "--set contact.law=kogut-etsion --set contact.law.critical=0.05",
     {"scene.law": mcgw.KogutEtsion(critical=0.05)}),
    ("converge @s.toml", "statistics.convergence:converge", "--set ensemble.n_surfaces=9",
     {"scene.n_surfaces": 9}),
    ("tradeoff @s.toml", "statistics.tradeoff:tradeoff", "--seconds 2min", {"seconds": 120.0}),
    ("tradeoff @s.toml", "statistics.tradeoff:tradeoff", "--set ensemble.n_surfaces=9",
     {"scene.n_surfaces": 9, "seconds": 60.0}),
    ("solve @s.toml", "ensemble.solution:solutions", "--pressure 1MPa:4MPa:3",
     {"given": "load", "values": near([1.0, 2.0, 4.0])}),
    (SOLVE, "ensemble.solution:solutions", "--surfaces 9", {"scene.n_surfaces": 9}),
    (SOLVE, "ensemble.solution:solutions", "--set ensemble.n_surfaces=8", {"scene.n_surfaces": 8}),
    *((EXPORT, "exports.writing:export", words, asked) for words, asked in (
        ("--points 7", {"points": 7, "units": "SI", "quantiles": None, "pressures": None}),
        ("--pressures 1MPa:4MPa:3", {"pressures": near([1e6, 2e6, 4e6])}),
        ("--quantile 0.5 0.9", {"quantiles": [0.5, 0.9]}),
        ("--set ensemble.n_surfaces=9", {"what.n_surfaces": 9}))),
    ("export @e.h5 --to moose -o a.csv", "exports.writing:export", "--points 7", {"what.name": "e.h5"}),
    ("report @e.h5", "reports.html:report_html", "--pressures 1MPa 2MPa:8MPa:3",
     {"pressures": near([1e6, 2e6, 4e6, 8e6])}),
    (MAP, "maps.synthetic:asperities_of", "--set ensemble.seed=8", {"scene.seed": 8}),
    ("figures --scene @s.toml", "figures.catalogue:figures_of", "--set ensemble.seed=8", {"f.scene.seed": 8}),
    (MAP, "maps.synthetic:asperities_of", "--surface 7", {"surface": 7}),
    (MAP, "maps.envelope:envelope", "--width 2mm", {"width": 2e-3, "shape": (50, 50)}),
    (MAP, "maps.envelope:envelope", "--shape 60x40", {"shape": (40, 60), "periodic": False, "width": None}),
    (MAP, "maps.envelope:envelope", "--periodic", {"periodic": True, "shape": (50, 50)}),
    (GAUSS, "maps.synthetic:gaussian_map", "--pixel 2um",
     {"pixel": near((2e-6, 2e-6)), "shape": (32, 64), "spectrum.rms": 1e-6}),
    (GAUSS, "numpy.random:default_rng", "--seed 4", {"seed": 4}),
    *((FIT, "maps.fitting:fit_sources", words, asked) for words, asked in (
        ("--cutoff 10um", {"asked.cutoff": 1e-5}), ("--long-cutoff 20um", {"asked.long_cutoff": 2e-5}),
        ("--form quadratic", {"asked.form": "quadratic", "asked.cutoff": None}),
        ("--missing fill", {"asked.missing": "fill"}), ("--spikes remove", {"asked.spikes": "remove"}),
        ("--lines rows", {"asked.lines": "rows"}), ("--trim 15", {"asked.trim": 15}),
        ("--use moments", {"use": "moments", "asked.parts": 4}),
        ("--pixel 2um", {"read.keywords.pixel": near((2e-6, 2e-6)), "read.keywords.unit": None}),
        ("--unit mm", {"read.keywords.unit": "mm"}),
        ("--missing-value 8e-6", {"read.keywords.missing": 8e-6}))),
    (FIT, "maps.fitted_scene:fitted_scene", "--use moments", {"use": "moments", "heights": "gaussian"}),
    (FIT, "maps.fitted_scene:fitted_scene", "--heights table", {"heights": "table", "E_star": 1e11}),
    (FIT, "maps.fitted_scene:fitted_scene", "--nominal-area 1cm^2", {"changes": {"nominal_area": 1e-4}}),
    *(("elastic @s.toml", "elasticity.elastic:elastic", words, asked) for words, asked in (
        ("--pressure 2MPa", {"pressure": "2MPa", "separation": None, "rel_err": 0.02, "solves": None}),
        ("--separation 2um", {"pressure": None, "separation": "2um", "seed": 1, "path": None}))),
    *((ELASTIC, "elasticity.elastic:elastic", words, asked) for words, asked in (
        ("--E-star 5e9", {"E_star": "5e9"}), ("--rel-err 0.1", {"rel_err": 0.1}),
        ("--solves 9", {"solves": 9}), ("--seed 4", {"seed": 4}),
        ("--output e.jsonl", {"path.name": "e.jsonl"}),
        ("--set surface.sigma=3e-6", {"source.surface.sigma": 3e-6}))),
    ("elastic @map.npy --pressure 1MPa", "maps.heights_files:read_map", "--pixel 2um --unit mm",
     {"pixel": near((2e-6, 2e-6)), "unit": "mm"}),
    ("figures", "figures.panels:save", "--only figure-1 --format PDF .svg",
     {"paths": (Path("figures/figure-1.pdf"), Path("figures/figure-1.svg"))}),
    ("figures", "figures.catalogue:figures_of", "--only figure-1",
     {"only": ["figure-1"], "f.swept": True, "f.scene.n_surfaces": 2000, "f.scene.n_asperities": 30_000,
      "f.scene.seed": 20240601}),
]  # fmt: skip

# What a command prints or writes by itself: its line, a text that is said, and the files that are then there.
SAID = [
    ("fit --iso Sq=1um Sdq=0.1 Spc=20/mm -o f.toml", "f.toml: m0 = 1e-12 m^2", ["f.toml"]),
    ("show --scene @e.h5", "\n[surface]\n", []), ("show --digest @e.h5", "@digest", []),
    ("show @e.h5 --csv x.csv", "x.csv: the table", ["x.csv"]),
    (f"{FIT} --heights measured", "f.heights.npy", ["f.heights.npy", "f.toml"]),
    ("init --schema", "scene.schema.json: with it", ["demo.toml", "scene.schema.json"]),
    ("run @s.toml -o a.h5 --shard 1/2", "all are done: mcgw merge a.h5", None),
    (f"{RUN} --threads 99", "--threads 99: this machine has", ["a.h5"]),
]  # fmt: skip

REFUSED = [
    ("compare @s.toml", "is not a file of results"),
    ("run @e.h5", "holds results, not a scene; print their scene with mcgw show --scene"),
    ("show absent.h5", "absent.h5: No such file"),
    (f"{RUN} --set grading.gama=2", "grading.gama: unknown key; did you mean gamma"),
    (f"{RUN} --set gamma", "--set gamma: give KEY=VALUE"),
    (f"{RUN} --set nonsense=1", "nonsense: unknown key"),
    (f"{RUN} --set poisson=0.2", "contact.law.poisson = 0.2: give hardness too"),
    (f"{RUN} --set contact.hardness=1", "contact.hardness: unknown key; did you mean contact.law.hardness?"),
    (f"{SWEEP} --set ensemble.seed=-1", "ensemble.seed = -1: give a whole number"),
    ("show @e.h5 --set grading.gamma=2", "is no scene (.toml); give one"),
    *((f"{line} {words}", said) for line in (RUN, SWEEP, "run @rule.toml -o a.h5") for words, said in (
        ("--threads 0", "threads = 0: give"), ("--jobs 0", "--jobs 0: give a whole number >= 1"),
        ("--shard 3/2", "--shard 3/2: give i/n"))),
    (f"{SWEEP} --over ensemble.seed", "--over ensemble.seed: give"),
    (f"{SWEEP} --over grading.gamma=1:2:1.5", "with N from 2"),
    (f"{SOLVE} --scatter 100%", "--scatter"), (f"{SOLVE} --scatter 0", "--scatter = '0': give"),
    ("solve @s.toml --nominal-separation 1", "nominal_separation: it needs [interaction]"),
    ("solve @s.toml --pressure 1MPa:4MPa", "--pressure 1MPa:4MPa: give A:B:N"),
    ("solve @s.toml --pressure 1MPa:1MPa:2", "--pressure 1MPa:1MPa:2: give the lower one first"),
    (f"{EXPORT} --quantile 0", "quantiles"), (f"{EXPORT} --quantile 1", "quantiles"),
    (f"{EXPORT} --points 1", "points = 1: give"), (f"{EXPORT} --points 10001", "points = 10001: give"),
    ("export @e.h5 --to json -o a.json --units mm-N-s", "SI units; leave out table, quantiles, units"),
    (f"{EXPORT} --pressures 1MPa:2MPa:1", "with N from 2"),
    (f"{EXPORT} --pressures 1MPa:2MPa:1000001", "to 1e6"),
    (f"{GAUSS} --seed -1", "--seed -1: give a whole number >= 0"),
    (GAUSS.replace("surface", "surface @s.toml"), "leave out SCENE"),
    (f"{MAP} --width -1mm", "--width = '-1mm': give a number > 0"),
    (f"{MAP} --shape 0x", "--shape '0x': give"),
    ("elastic @s.toml --pressure 2MPa --unit um", "--unit: is for a map"),
    ("figures --only figure-9", "--only figure-9: no such figure; give one of figure-1, "),
    (f"{LINES} --summits s.csv", "--summits s.csv: a profile shows no summits"),
    (f"{LINES} --tiles t.csv", "--tiles t.csv"), (f"{LINES} --picture t.png", "--picture t.png"),
    ("fit --iso Sq=1um Sq=2um -o x.toml", "gives Sq more than once"),
    ("fit --iso Sq=1um pruning=x -o x.toml", "pruning = 'x': give a fraction"),
    ("fit map.npy --iso Sq=1um -o x.toml", "map.npy: give a map, or --iso"),
    ("fit -o x.toml", "MAP: give a map or profiles, or --iso"),
    ("fit map.npy -o x.toml", "--cutoff: give the shortest wavelength"),
]  # fmt: skip


@pytest.fixture(scope="module")
def material(tmp_path_factory):
    """What commands read: scenes, an ensemble, a map, a profile."""
    folder = tmp_path_factory.mktemp("material")
    (folder / "s.toml").write_text(SCENE)
    (folder / "rule.toml").write_text(SCENE.replace("n_surfaces = 70", "rel_err = 0.05, n_surfaces = 500"))
    mcgw.run(mcgw.load_scene(folder / "s.toml"), folder / "e.h5")
    z = np.random.default_rng(3).normal(size=(48, 48))
    np.save(folder / "map.npy", 1e-7 * sum(np.roll(z, k, axis) for k in range(4) for axis in (0, 1)))
    np.savetxt(folder / "p.txt", np.column_stack([np.arange(300.0), z.ravel()[:300]]), header="x (um) z (um)")
    return folder


@pytest.fixture(scope="module")
def call(material, tmp_path_factory):
    """Run a command in a folder of its own; @name is a file of the material."""

    def call(line):
        folder = tmp_path_factory.mktemp("call")
        words = (str(material / w[1:]) if w.startswith("@") else w for w in shlex.split(line))
        done = command_here(*words, cwd=folder)
        done.folder = folder
        return done

    return call


def of(arguments, path):
    """An argument, or what it holds."""
    name, *inner = path.split(".")
    value = arguments[name]
    for each in inner:
        value = value[each] if isinstance(value, dict) else getattr(value, each)
    return value


@pytest.fixture
def spied(monkeypatch):
    """Arguments by name of all calls of a function, the first of which ends in an error."""

    def spied(target):
        module, name = target.split(":")
        module = import_module(module if module.startswith("numpy") else f"mcgw.{module}")
        signature, seen = inspect.signature(getattr(module, name)), []

        def spy(*given, **named):
            bound = signature.bind(*given, **named)
            bound.apply_defaults()
            seen.append(bound.arguments)
            raise ValueError("seen")

        monkeypatch.setattr(module, name, spy)
        return seen

    return spied


@pytest.mark.parametrize(("line", "target", "words", "asked"), ROWS)
def test_it_reaches_what_does_the_work(call, spied, line, target, words, asked):
    seen = spied(target)
    done = call(f"{line} {words}")
    assert seen, done.stderr
    assert {path: of(seen[0], path) for path in asked} == asked
    assert (done.returncode, without_notes(done.stderr)) == (2, "mcgw: seen")


@pytest.mark.parametrize(("line", "said", "files"), SAID)
def test_it_says_and_writes(call, material, line, said, files):
    done = call(line)
    assert done.returncode == 0, done.stderr
    digest = read_attributes(material / "e.h5")["digest"]
    assert said.replace("@digest", digest) in done.stdout + done.stderr
    there = sorted(path.name for path in done.folder.rglob("*") if path.is_file())
    assert files in (None, there)


@pytest.mark.parametrize(("line", "said"), REFUSED)
def test_it_is_refused_in_one_line(call, line, said):
    done = call(line)
    assert (done.returncode, without_notes(done.stderr).count("\n")) == (2, 0)
    assert said in done.stderr
    assert not list(done.folder.iterdir())


def options_of(parser, command=""):
    """(command, option) of all that may be given or left out."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for name, sub in action.choices.items():
                yield from options_of(sub, name)
        elif action.option_strings:
            yield command, max(action.option_strings, key=len)


def test_every_option_of_every_command_has_its_row():
    """Or stands in a recorded answer."""
    lines = [f"{line} {words}" for line, _, words, _ in ROWS] + [line for line, *_ in SAID]
    for path in ANSWERS.glob("read.*.txt"):
        lines += re.findall(r"^\$ mcgw (.+)", path.read_text(), re.MULTILINE)
    tested = {(line.split()[0], word) for line in lines for word in line.split() if word.startswith("--")}
    tested |= {(line.split()[0], "--output") for line in lines if " -o " in line}
    of_all = ("--help", "--quiet", "--verbose", "--version")
    missing = {x for x in options_of(parser_of()) if x[1] not in of_all} - tested
    assert missing == {("solve", "--nominal-separation"), ("tradeoff", "--output")}, "give it a row"


# --- those apart ------------------------------------------------------------------------------------


def test_places_left_out(call, material):
    """Where a file goes if -o does not say: beside what is read, under its name."""
    for line, name in (
        ("compare @e.h5", "e.png"), ("report @e.h5", "e.html"), ("run @s.toml", "out/s.h5"),
        ("sweep @s.toml --over grading.gamma=1,2", "out/s.sweep.h5"),
        ("converge @s.toml", "out/s-converge.png"),
    ):  # fmt: skip
        assert call(line).returncode == 0
        assert (material / name).is_file()
    assert read_attributes(material / "out" / "s.h5")["seed"] == 5


def test_compare_says_which_law_is_the_least_likely_and_ends_with_1(call, monkeypatch):
    found = [(0.2, "area", 0.0), (0.5, "load", 1.5)]
    monkeypatch.setattr("mcgw.statistics.verdict.distances", lambda ensemble: found)
    said = call("compare @e.h5 -o p.png --laws")
    assert said.returncode == 1
    assert "the distribution of load at d/sigma = 1.5 differs by 0.5, the most of 2" in said.stdout

"""Every option of every command says or writes something else: one row at least for each, or this fails."""

import argparse
import dataclasses
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import h5py
import numpy as np
import pytest
from said import without_notes

import analytic
import mcgw
from mcgw.cli import _parser, main
from mcgw.figures.contact_map import EllipseCollection
from mcgw.jobs.running import run
from mcgw.maps.files import read_map
from mcgw.store import ensembles, structure
from mcgw.store.ensembles import read_attributes

pytestmark = pytest.mark.usefixtures("blank_figures")

SCENE = """
title = "Flags"
surface = {sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11}
grading = {gamma = 1.5}
contact = {separations = [0.0, 1.0]}
ensemble = {n_surfaces = 70, n_asperities = 300, seed = 5}
"""
SPECTRUM = ["--from-spectrum", "rms=1um,long=60um,short=12um", "--shape", "512", "--pixel", "1um"]


@dataclass
class Said:
    """What a command left behind."""

    code: int
    out: str
    err: str
    folder: Path
    calls: list[Any] = field(default_factory=list)

    @property
    def files(self):
        return sorted(p.name for p in self.folder.rglob("*") if p.is_file())


@pytest.fixture(scope="module", autouse=True)
def _looked_at_here():
    """Files are looked at in this process: a child for each takes most of the time, on a busy machine all."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ensembles, "examine", lambda path: structure.describe(str(path)))
        yield


@pytest.fixture(scope="module")
def material(tmp_path_factory):
    """What commands read: scenes, an ensemble with its moments, a run in two shares, a map, a table."""
    folder = tmp_path_factory.mktemp("material")
    (folder / "s.toml").write_text(SCENE)
    (folder / "noseed.toml").write_text(SCENE.replace(", seed = 5", ""))
    (folder / "rule.toml").write_text(SCENE.replace("n_surfaces = 70", "rel_err = 0.05, max_surfaces = 500"))
    (folder / "t.csv").write_text("s,ratio\n0.0,1.0\n1.0,3.0\n")
    scene = mcgw.load_scene(folder / "s.toml")
    run(dataclasses.replace(scene, keep="moments"), folder / "e.h5")
    assert main(["surface", *SPECTRUM, "--seed", "3", "-o", str(folder / "map.sdf")]) == 0
    z = read_map(folder / "map.sdf").heights
    np.save(folder / "bare.npy", z)
    holes, spiked, stepped = z.copy(), z.copy(), z.copy()
    holes[100:140, 200:260] = np.nan
    spiked[50::60, 40::70] += 3e-5
    stepped[:, 300:] += 1e-5
    for name, heights in (("holes", holes), ("spiked", spiked), ("stepped", stepped)):
        np.save(folder / f"{name}.npy", heights)
    return folder


@pytest.fixture
def call(material, tmp_path, monkeypatch, capsys):
    """Run a command in a folder of its own; @name is a file of the material."""
    number = 0

    def call(words, **patches):
        nonlocal number
        number += 1
        folder = tmp_path / f"{number}"
        folder.mkdir()
        monkeypatch.chdir(folder)
        words = [str(material / w[1:]) if w.startswith("@") else w for w in words]
        try:
            code = main(words)
        except SystemExit as end:
            code = end.code
        said = capsys.readouterr()
        return Said(code, said.out, said.err, folder)

    return call


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


def makes_scene(name, **expected):
    """A scene is written whose values are these."""

    def check(plain, given):
        a, b = (mcgw.load_scene(x.folder / name) for x in (plain, given))
        for key, value in expected.items():
            found = b.surface if hasattr(b.surface, key) else b
            assert value(getattr(found, key)), (key, getattr(found, key))
        assert a != b

    return check


def map_of(said, name="m.sdf"):
    assert said.code == 0, said.err
    return read_map(said.folder / name)


def other_map(check):
    def both(plain, given):
        check(map_of(plain), map_of(given))

    return both


# --- the rows ---------------------------------------------------------------------------------------


def other_heights(a, b):
    assert a.heights.shape == b.heights.shape
    assert not np.array_equal(a.heights, b.heights)


def surface_is(number):
    """Heights of the asperities of that very surface."""

    def check(plain, given):
        scene = mcgw.scene_from(SCENE)
        for said, k in ((plain, 0), (given, number)):
            with h5py.File(said.folder / "m.h5") as file:
                z = file["asperities/z"][()] / scene.surface.sigma
            touching = np.sort(z[z > scene.lowest])
            np.testing.assert_allclose(touching, np.sort(mcgw.heights(scene, k)), rtol=1e-12)

    return check


def shape_is(rows, columns):
    def check(plain, given):
        assert map_of(given).heights.shape == (rows, columns) != map_of(plain).heights.shape

    return check


def width_is(width):
    def check(plain, given):
        a, b = map_of(plain), map_of(given)
        assert b.size == (pytest.approx(width), pytest.approx(1e-6 / width))
        assert a.size == (pytest.approx(1e-3), pytest.approx(1e-3))

    return check


def edges_are_joined(plain, given):
    a, b = map_of(plain), map_of(given)
    assert np.all(b.heights >= a.heights)  # caps from across the edge lie on top
    assert np.any(b.heights[:, 0] > a.heights[:, 0])


def pixel_is(pixel):
    def check(plain, given):
        assert map_of(given).pixel == pytest.approx((pixel, pixel))
        assert map_of(plain).pixel == pytest.approx((1e-6, 1e-6))

    return check


def seed_of_the_map(plain, given):
    other_heights(map_of(plain), map_of(given))
    rms = [map_of(x).heights.std() for x in (plain, given)]
    assert rms == pytest.approx([1e-6, 1e-6], rel=0.5)


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
    begun = [given.folder / "a.h5.parts" / name for name in ("run.toml", "sweep/asked.toml")]
    assert [path.is_file() for path in begun].count(True) == 1
    assert (plain.folder / "a.h5").is_file()


def digest_alone(plain, given):
    assert len(given.out.strip()) == 64
    assert given.out.strip() in plain.out


def scene_alone(plain, given):
    assert mcgw.scene_from(given.out).seed == 5
    assert mcgw.scene_from(given.out).keep == "moments"


def csv_columns(name, *columns):
    def check(plain, given):
        writes(name)(plain, given)
        head, *rows = (given.folder / name).read_text().splitlines()
        assert set(columns) <= set(head.split(",")), head
        assert len(rows) >= 2
        assert f"{name}: the table" in given.out

    return check


def graded_by(grading):
    def check(plain, given):
        assert given.code == 0, given.err
        (path,) = given.folder.glob("*.h5")
        assert mcgw.open_ensemble(path).scene.grading == grading
        (other,) = plain.folder.glob("*.h5")
        assert mcgw.open_ensemble(other).scene.grading != grading

    return check


def contact_by(law):
    def check(plain, given):
        assert given.code == 0, given.err
        assert mcgw.open_ensemble(given.folder / "a.h5").scene.law == law
        assert plain.code != 0 or mcgw.open_ensemble(plain.folder / "a.h5").scene.law != law

    return check


def solved_for(value, unit):
    """Theory's load or area is what was asked."""

    def check(plain, given):
        assert given.code == 0, given.err
        assert f"{value:.6g} {unit} = " in given.out
        assert given.out != plain.out

    return check


def surfaces_solved(number):
    def check(plain, given):
        assert f"std: over {number} surfaces" in given.out
        assert "std: over 70 surfaces" in plain.out

    return check


def fitted(key, check_value):
    def check(plain, given):
        assert given.code == 0, given.err
        a, b = (mcgw.load_scene(x.folder / "f.toml") for x in (plain, given))
        assert check_value(a, b), (a.surface, b.surface)

    return check


def errors_differ(plain, given):
    """Other sub-areas, other errors of the same estimates."""
    assert given.code == 0, given.err
    a, b = (
        [line for line in x.out.splitlines() if line.startswith("summits counted ")] for x in (plain, given)
    )
    assert a != b
    assert [x.split(" +- ")[0] for x in a] == [x.split(" +- ")[0] for x in b]


def rows_in(name, number):
    """So many lines that are neither comment nor keyword."""

    def count(said):
        return sum(not line.startswith("*") for line in (said.folder / name).read_text().splitlines())

    def check(plain, given):
        assert given.code == 0, given.err
        assert count(given) == number != count(plain)

    return check


def in_mm(plain, given):
    """Pressure in MPa, overclosure in mm."""
    a, b = (
        np.array(
            [
                [float(x) for x in line.split(",")]
                for line in (said.folder / "a.inp").read_text().splitlines()
                if not line.startswith("*")
            ]
        )
        for said in (plain, given)
    )
    np.testing.assert_allclose(b, a * [1e-6, 1e3], rtol=1e-8)


@dataclass
class Row:
    """A command line, the option that is looked at, and what it must change."""

    command: str
    option: str
    words: list[str]
    given: list[str]
    check: Any


E = ["@e.h5"]
LAW = [*E, "-o", "a.h5", "--law"]
HERTZ, KE = [*LAW, "hertz"], [*LAW, "kogut-etsion"]
INP = ["@e.h5", "--to", "abaqus", "-o", "a.inp"]
RUN = ["@s.toml", "-o", "a.h5"]
SWEEP = ["@s.toml", "--over", "grading.gamma=1,2", "-o", "a.h5"]
MAP = ["@s.toml", "--shape", "200", "-o", "m.sdf"]
HDF = [*MAP[:-1], "m.h5"]
GAUSS = [*SPECTRUM, "-o", "m.sdf"]
FIT = ["@map.sdf", "--cutoff", "none", "-o", "f.toml"]
HOLES, SPIKED, STEPPED = (
    [f"@{name}.npy", "--cutoff", "none", "--pixel", "1um"] for name in ("holes", "spiked", "stepped")
)
SHAPES = {f: ["@s.toml", "--shape", f, "-o", "m.sdf"] for f in ("50", "60x40")}


def row(command, option, words, given, check):
    return Row(command, option, words, given, check)


ROWS = [
    row("init", "PRESET", [], ["coating"], writes("coating.toml", instead=["demo.toml"])),
    row("init", "--output", [], ["-o", "x.toml"], writes("x.toml", instead=["demo.toml"])),
    row("init", "--schema", [], ["--schema"], writes("scene.schema.json")),
    row("run", "--output", RUN, ["@s.toml", "-o", "b.h5"], writes("b.h5", instead=["a.h5"])),
    row("run", "--threads", RUN, [*RUN, "--threads", "99"], same_draws),
    row("run", "--threads", RUN, [*RUN, "--threads", "0"], refuses("threads = 0: give")),
    row("run", "--threads", RUN, [*RUN, "--threads", "0", "--shard", "1/2"], refuses("threads = 0: give")),
    row("run", "--threads", RUN, ["@rule.toml", *RUN[1:], "--threads", "0"], refuses("threads = 0: give")),
    row("run", "--processes", RUN, [*RUN, "--processes", "0"], refuses("processes = 0: give")),
    row("run", "--workers", RUN, [*RUN, "--workers", "0"], refuses("workers = 0: give")),
    row("run", "--scheduler", RUN, [*RUN, "--scheduler", "ftp://x"], refuses("ftp://x")),
    row("run", "--shard", RUN, [*RUN, "--shard", "1/2"], share_drawn),
    row("run", "--shard", RUN, [*RUN, "--shard", "3/2"], refuses("--shard 3/2: give i/n")),
    row("sweep", "--output", SWEEP, [*SWEEP[:-1], "b.h5"], writes("b.h5", instead=["a.h5"])),
    row("sweep", "--over", SWEEP, [*SWEEP, "--over", "ensemble.seed=1,2"], says("a.h5: 4 scenes")),
    row("sweep", "--over", SWEEP, [*SWEEP, "--over", "ensemble.seed"], refuses("--over ensemble.seed: give")),
    row("sweep", "--zip", SWEEP, [*SWEEP, "--zip", "--over", "ensemble.seed=1,2"], says("1, 1 ")),
    row("sweep", "--threads", SWEEP, [*SWEEP, "--threads", "0"], refuses("threads = 0: give")),
    row("sweep", "--processes", SWEEP, [*SWEEP, "--processes", "0"], refuses("processes = 0: give")),
    row("sweep", "--workers", SWEEP, [*SWEEP, "--workers", "0"], refuses("workers = 0: give")),
    row("sweep", "--scheduler", SWEEP, [*SWEEP, "--scheduler", "ftp://x"], refuses("ftp://x")),
    row("sweep", "--shard", SWEEP, [*SWEEP, "--shard", "1/2"], share_drawn),
    row("sweep", "--shard", SWEEP, [*SWEEP, "--shard", "3/2"], refuses("--shard 3/2: give i/n")),
    row("sweep", "--plan", SWEEP, [*SWEEP, "--plan"], says("computed ")),
    row("show", "--scene", E, [*E, "--scene"], scene_alone),
    row("show", "--digest", E, [*E, "--digest"], digest_alone),
    row("show", "--verify", E, [*E, "--verify"], says("e.h5: intact (")),
    row("show", "--plan", E, ["@s.toml", "--plan"], says("not done:")),
    row("show", "--csv", E, [*E, "--csv", "x.csv"], csv_columns("x.csv", "mean", "std", "stderr")),
    row("compare", "--output", [*E, "-o", "p.png"], [*E, "-o", "q.svg"], writes("q.svg", instead=["p.png"])),
    row(
        "compare", "--csv", [*E, "-o", "p.png"], [*E, "-o", "p.png", "--csv", "x.csv"],
        csv_columns("x.csv", "mean", "low_95", "high_95", "theory", "residual"),
    ),
    row("regrade", "--gamma", [*E, "--gamma", "1", "-o", "a.h5"], [*E, "--gamma", "0.25", "-o", "a.h5"],
        graded_by(analytic.Exponential(0.25))),
    row("regrade", "--grading", [*E, "--gamma", "1", "-o", "a.h5"], [*E, "--grading", "@t.csv", "-o", "a.h5"],
        graded_by(analytic.Table([0.0, 1.0], [1.0, 3.0]))),
    row("regrade", "--output", [*E, "--gamma", "1", "-o", "a.h5"], [*E, "--gamma", "1", "-o", "b.h5"],
        writes("b.h5", instead=["a.h5"])),
    row("regrade", "--csv", [*E, "--gamma", "1", "-o", "a.h5"],
        [*E, "--gamma", "1", "-o", "a.h5", "--csv", "x.csv"],
        csv_columns("x.csv", "ratio", "stderr", "theory", "variance_gain")),
    row("regrade", "--law", HERTZ, [*KE, "--critical", "0.05"], contact_by(mcgw.KogutEtsion(critical=0.05))),
    row("regrade", "--critical", HERTZ, [*KE, "--critical", "0.05"],
        contact_by(mcgw.KogutEtsion(critical=0.05))),
    row("regrade", "--hardness", [*KE, "--critical", "0.05"], [*KE, "--hardness", "2GPa"],
        contact_by(mcgw.KogutEtsion(hardness=2e9))),
    row("regrade", "--poisson", [*KE, "--critical", "0.05"], [*KE, "--critical", "0.05", "--poisson", "0.4"],
        contact_by(mcgw.KogutEtsion(critical=0.05, poisson=0.4))),
    row("regrade", "--bridge", [*KE, "--critical", "0.05"],
        [*KE, "--critical", "0.05", "--bridge", "hermite"],
        contact_by(mcgw.KogutEtsion(critical=0.05, bridge="hermite"))),
    row("regrade", "--yield-strength", HERTZ,
        [*LAW, "jackson-green", "--yield-strength", "500MPa"],
        contact_by(mcgw.JacksonGreen(yield_strength=5e8))),
    row("regrade", "--k", HERTZ,
        [*LAW, "power-law-graded", "--k", "0.5", "--c0", "1um"],
        contact_by(mcgw.PowerLawGraded(0.5, c0=1e-6))),
    row("regrade", "--c0", [*LAW, "power-law-graded", "--k", "0.5", "--c0", "1um"],
        [*LAW, "power-law-graded", "--k", "0.5", "--c0", "2um"],
        contact_by(mcgw.PowerLawGraded(0.5, c0=2e-6))),
    row("regrade", "--thickness", [*LAW, "coated", "--thickness", "1um", "--ratio", "2"],
        [*LAW, "coated", "--thickness", "0.5um", "--ratio", "2"],
        contact_by(mcgw.Coated(thickness=5e-7, ratio=2.0))),
    row("regrade", "--ratio", [*LAW, "coated", "--thickness", "1um", "--ratio", "2"],
        [*LAW, "coated", "--thickness", "1um", "--ratio", "3"],
        contact_by(mcgw.Coated(thickness=1e-6, ratio=3.0))),
    row("regrade", "--work", HERTZ, [*LAW, "derjaguin-muller-toporov", "--work", "0.05"],
        contact_by(analytic.laws.DerjaguinMullerToporov(work=0.05))),
    row("regrade", "--pull-off", HERTZ, [*LAW, "derjaguin-muller-toporov", "--pull-off", "0.01"],
        contact_by(analytic.laws.DerjaguinMullerToporov(pull_off=0.01))),
    row("solve", "--pressure", ["@s.toml", "--pressure", "1MPa"], ["@s.toml", "--pressure", "2MPa"],
        says("Load 2 N = pressure 2 MPa")),
    row("solve", "--load", ["@s.toml", "--pressure", "1MPa"], ["@s.toml", "--load", "250mN"],
        solved_for(0.25, "N")),
    row("solve", "--area-fraction", ["@s.toml", "--pressure", "1MPa"], ["@s.toml", "--area-fraction", "0.2%"],
        solved_for(0.002e-6, "m^2")),
    row("solve", "--surfaces", ["@s.toml", "--load", "1N"], ["@s.toml", "--load", "1N", "--surfaces", "9"],
        surfaces_solved(9)),
    row("solve", "--csv", ["@s.toml", "--load", "1N"], ["@s.toml", "--load", "1N", "--csv", "x.csv"],
        csv_columns("x.csv", "theory", "mean", "low_95", "high_95", "std")),
    row("export", "--output", INP, [*INP[:-1], "b.inp"], writes("b.inp", "b.q05.inp", instead=["a.inp"])),
    row("export", "--to", INP, ["@e.h5", "--to", "moose", "-o", "a.csv"],
        writes("a.csv", "a.q95.csv", instead=["a.inp"])),
    row("export", "--table", INP,
        ["@e.h5", "--to", "comsol", "--table", "stiffness-pressure", "-o", "a.txt"],
        says("a.txt: stiffness-pressure")),
    row("export", "--points", ["@s.toml", *INP[1:]], ["@s.toml", *INP[1:], "--points", "7"],
        rows_in("a.inp", 8)),
    row("export", "--pressures", ["@s.toml", *INP[1:]],
        ["@s.toml", *INP[1:], "--pressures", "10MPa:200MPa:5"], rows_in("a.inp", 6)),
    row("export", "--quantile", INP, [*INP, "--quantile", "0.5"], writes("a.q50.inp", instead=["a.q05.inp"])),
    row("export", "--units", INP, [*INP, "--units", "mm-N-s"], in_mm),
    row("report", "--output", [*E, "-o", "a.html"], [*E, "-o", "b.html"],
        writes("b.html", instead=["a.html"])),
    row("surface", "--surface", HDF, [*HDF, "--surface", "7"], surface_is(7)),
    row("surface", "--shape", SHAPES["50"], SHAPES["60x40"], shape_is(40, 60)),
    row("surface", "--shape", GAUSS, [*GAUSS, "--shape", "512x300"], shape_is(300, 512)),
    row("surface", "--width", MAP, [*MAP, "--width", "2mm"], width_is(2e-3)),
    row("surface", "--periodic", MAP, [*MAP, "--periodic"], edges_are_joined),
    row("surface", "--at", MAP, ["@s.toml", "-o", "m.png", "--at", "1"],
        writes("m.png", instead=["m.sdf"])),
    row("surface", "--at", MAP, ["@s.toml", "-o", "m.png", "--at", "1"], says(" contacts, ")),
    row("surface", "--from-spectrum", GAUSS,
        ["--from-spectrum", "rms=3um,long=60um,short=12um", *GAUSS[2:]],
        other_map(lambda a, b: np.testing.assert_allclose(b.heights, 3 * a.heights, atol=1e-15))),
    row("surface", "--pixel", GAUSS, [*GAUSS[:-3], "2um", "-o", "m.sdf"], pixel_is(2e-6)),
    row("surface", "--seed", GAUSS, [*GAUSS, "--seed", "4"], seed_of_the_map),
    row("surface", "--output", MAP, [*MAP[:-1], "n.x3p"], writes("n.x3p", instead=["m.sdf"])),
    row("fit", "--cutoff", FIT, ["@map.sdf", "--cutoff", "20um", "-o", "f.toml"],
        fitted("eta", lambda a, b: b.surface.eta < 0.8 * a.surface.eta)),
    row("fit", "--form", FIT, [*FIT, "--form", "quadratic"],
        fitted("sigma", lambda a, b: b.surface.sigma < a.surface.sigma)),
    row("fit", "--pixel", FIT, ["@bare.npy", *FIT[1:], "--pixel", "2um"],
        fitted("eta", lambda a, b: b.surface.eta == pytest.approx(a.surface.eta / 4, rel=1e-6))),
    row("fit", "--unit", ["@bare.npy", *FIT[1:], "--pixel", "1um"],
        ["@bare.npy", *FIT[1:], "--pixel", "1um", "--unit", "mm"],
        fitted("sigma", lambda a, b: b.surface.sigma == pytest.approx(a.surface.sigma / 1e3, rel=1e-6))),
    row("fit", "--use", FIT, [*FIT, "--use", "moments"],
        fitted("eta", lambda a, b: b.surface.eta != a.surface.eta)),
    row("fit", "--heights", FIT, [*FIT, "--heights", "table"],
        fitted("heights", lambda a, b: isinstance(b.heights, analytic.HeightTable))),
    row("fit", "--heights", FIT, [*FIT, "--heights", "measured"], writes("f.heights.npy")),
    row("fit", "--long-cutoff", FIT, [*FIT, "--long-cutoff", "40um"],
        fitted("sigma", lambda a, b: b.surface.sigma < 0.9 * a.surface.sigma)),
    row("fit", "--missing", [*HOLES, "-o", "f.toml"], [*HOLES, "--missing", "fill", "-o", "f.toml"],
        fitted("area", lambda a, b: b.surface.nominal_area > a.surface.nominal_area)),
    row("fit", "--spikes", [*SPIKED, "-o", "f.toml"], [*SPIKED, "--spikes", "remove", "-o", "f.toml"],
        fitted("radius", lambda a, b: b.surface.radius > a.surface.radius)),
    row("fit", "--step", [*STEPPED, "-o", "f.toml"], [*STEPPED, "--step", "crop", "-o", "f.toml"],
        fitted("area", lambda a, b: b.surface.nominal_area < 0.75 * a.surface.nominal_area)),
    row("fit", "--trim", FIT, [*FIT, "--trim", "30"],
        fitted("area", lambda a, b: b.surface.nominal_area < a.surface.nominal_area)),
    row("fit", "--picture", FIT, [*FIT, "--picture", "f.png"], writes("f.png")),
    row("fit", "--E-star", FIT, [*FIT, "--E-star", "5e9"],
        fitted("E_star", lambda a, b: (a.surface.E_star, b.surface.E_star) == (1e11, 5e9))),
    row("fit", "--parts", FIT, [*FIT, "--parts", "3"], errors_differ),
    row("fit", "--summits", FIT, [*FIT, "--summits", "s.csv"], writes("s.csv")),
    row("fit", "--tiles", FIT, [*FIT, "--tiles", "t.csv"], writes("t.csv")),
    row("fit", "--profile", ["@bare.npy", *FIT[1:], "--pixel", "1um"],
        ["@bare.npy", *FIT[1:], "--pixel", "1um", "--profile"], refuses("holds 2 dimensions")),
    row("fit", "--output", FIT, [*FIT[:-1], "g.toml"], writes("g.toml", instead=["f.toml"])),
    row("converge", "--output", ["@s.toml", "-o", "a"], ["@s.toml", "-o", "b"], writes("s-converge.png")),
]  # fmt: skip

# Options whose commands take long, or need several calls: by tests of their own below.
APART = {
    ("run", "--insecure"): "test_engines_are_those_asked_for",
    ("sweep", "--insecure"): "test_sweeps_take_the_same_engines",
    ("merge", "FILE"): "test_merge_makes_the_file_that_is_named",
    ("merge", "--output"): "test_merge_makes_the_file_that_is_named",
    ("tradeoff", "--output"): "test_tradeoff_takes_its_folder_and_its_time",
    ("tradeoff", "--seconds"): "test_tradeoff_takes_its_folder_and_its_time",
    ("figures", "--output"): "test_figures_take_folder_scene_and_csv",
    ("figures", "--scene"): "test_figures_take_folder_scene_and_csv",
    ("figures", "--csv"): "test_figures_take_folder_scene_and_csv",
    ("surface", "--colour"): "test_colours_tell_what_was_asked",
    ("surface", "SCENE"): "every row of surface",
    ("", "--version"): "test_version",
    ("converge", "--output"): "test_converge_takes_its_folder",
}
ROWS = [r for r in ROWS if (r.command, r.option) not in APART]


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
    tested = {(r.command, r.option) for r in ROWS} | set(APART)
    there = options_of(_parser())
    assert there - tested == set(), "a new option: give it a row in which it changes something"
    assert tested - there == set(), "no such option any more"
    for name in APART.values():
        assert name in globals() or " " in name, name


@pytest.mark.parametrize("row", ROWS, ids=[f"{r.command} {r.option}" for r in ROWS])
def test_it_changes_what_is_said_or_written(row, call):
    assert any(r.command == row.command and row.option == r.option for r in ROWS)
    plain, given = call([row.command, *row.words]), call([row.command, *row.given])
    row.check(plain, given)


# --- those apart ------------------------------------------------------------------------------------


class Recorder:
    """An engine that draws in this process and remembers how it was made."""

    made: ClassVar[list[Any]] = []
    width = 1

    def __init__(self, *arguments, **options):
        self.made.append((type(self).__name__, arguments, options))
        self.given = 0

    def submit(self, task, *arguments):
        from concurrent.futures import Future

        self.given += 1
        self.made.append(task.__name__)
        future = Future()
        future.set_result(task(*arguments))
        return future

    def close(self):
        self.made.append("closed")


@pytest.mark.parametrize("scene", ["@s.toml", "@rule.toml"])
@pytest.mark.parametrize(
    ("words", "where", "made"),
    [
        (["--processes", "3"], "mcgw.jobs.engines.Processes", ((3,), {})),
        (
            ["--workers", "2"],
            "mcgw.jobs.dask_engine.Dask",
            ((None,), {"workers": 2, "insecure": False, "quiet": True}),
        ),
        (
            ["--scheduler", "tcp://h:1", "--insecure"],
            "mcgw.jobs.dask_engine.Dask",
            (("tcp://h:1",), {"workers": 1, "insecure": True, "quiet": True}),
        ),
    ],
)
def test_engines_are_those_asked_for(call, monkeypatch, scene, words, where, made):
    """They are made as asked, given the blocks, and closed; the file is that of the threads."""
    monkeypatch.setattr(where, Recorder)
    Recorder.made.clear()
    given = call(["run", scene, "-o", "a.h5", *words])
    assert given.code == 0, given.err
    assert Recorder.made[0][1:] == made
    assert Recorder.made[1] == "commit_block"
    assert Recorder.made[-1] == "closed"
    plain = call(["run", scene, "-o", "a.h5"])
    assert len([x for x in Recorder.made if isinstance(x, tuple)]) == 1
    a, b = (mcgw.open_ensemble(x.folder / "a.h5") for x in (plain, given))
    np.testing.assert_array_equal(a.load, b.load)


def test_sweeps_take_the_same_engines(call, monkeypatch):
    monkeypatch.setattr("mcgw.jobs.dask_engine.Dask", Recorder)
    Recorder.made.clear()
    given = call(["sweep", *SWEEP, "--scheduler", "tcp://h:1", "--insecure"])
    assert given.code == 0, given.err
    assert Recorder.made[0][1:] == (("tcp://h:1",), {"workers": 1, "insecure": True, "quiet": True})
    assert (Recorder.made[1], Recorder.made[-1]) == ("commit_chunk", "closed")
    files = [mcgw.open_sweep(x.folder / "a.h5") for x in (given, call(["sweep", *SWEEP]))]
    np.testing.assert_array_equal(*(file.mean("load") for file in files))


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
    first = call(["run", "@s.toml", "-o", "a.h5", "--shard", "1/1"])
    place = first.folder / "a.h5"
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
    assert call(["merge", str(place)]).code == 0


def test_merge_takes_its_file_as_an_argument(call):
    first = call(["run", "@s.toml", "-o", "a.h5", "--shard", "1/1"])
    assert call(["merge", str(first.folder / "a.h5")]).code == 0
    assert (first.folder / "a.h5").is_file()


def test_converge_takes_its_folder(call, material):
    said = call(["converge", "@s.toml", "-o", "there/deep"])
    assert said.files == ["s-converge.png"]
    assert (said.folder / "there/deep/s-converge.png").is_file()


def test_tradeoff_takes_its_folder_and_its_time(call, monkeypatch):
    from mcgw.statistics import tradeoff

    seen = []
    study = tradeoff.tradeoff

    def spy(scene, *, seconds, progress):
        seen.append(seconds)
        return study(scene, seconds=0.01, progress=progress)

    monkeypatch.setattr(tradeoff, "tradeoff", spy)
    monkeypatch.setattr(tradeoff, "methods_for", few_methods(tradeoff.methods_for))
    said = call(["tradeoff", "@s.toml", "-o", "there", "--seconds", "7.5"])
    assert said.code == 0, said.err
    assert sorted(p.name for p in (said.folder / "there").iterdir()) == ["s-tradeoff.csv", "s-tradeoff.png"]
    assert seen == [7.5]
    refused = call(["tradeoff", "@s.toml", "-o", "there", "--seconds", "7.5"])
    assert refused.files
    monkeypatch.setattr(tradeoff, "tradeoff", study)
    assert (
        "--seconds = '-1': give a number > 0"
        in call(["tradeoff", "@s.toml", "--seconds", "-1", "-o", "x"]).err
    )


def few_methods(methods_for):
    """The cheap ones, at their smallest sizes."""

    def few(scene, chosen):
        return tuple(
            dataclasses.replace(m, sizes=m.sizes[:3])
            for m in methods_for(scene, chosen)
            if m.name in ("direct", "tail", "theory: analytic.fn", "paper's Gauss rule, Eq. (9)")
        )

    return few


def test_figures_take_folder_scene_and_csv(call, tmp_path, monkeypatch):
    from mcgw.figures import further, of_scene, paper

    seen, scenes = [], []

    def first_alone(samples):
        seen.append(samples)
        return [paper._figure_1()]

    def first_of_scene(scene):
        scenes.append(scene)
        yield "figure-1", paper._figure_1()
        yield "figure-3", "why not"

    monkeypatch.setattr(paper, "paper_figures", first_alone)
    monkeypatch.setattr(further, "further_figures", lambda samples: [])
    monkeypatch.setattr(of_scene, "scene_figures", first_of_scene)
    assert call(["figures"]).files == ["figure-1.pdf", "figure-1.png", "figure-1.svg"]
    given = call(["figures", "-o", "there", "--scene", "@s.toml", "--csv"])
    assert given.code == 0, given.err
    assert sorted(p.name for p in (given.folder / "there").iterdir()) == [
        "figure-1.csv", "figure-1.pdf", "figure-1.png", "figure-1.svg"
    ]  # fmt: skip
    scene = mcgw.scene_from(SCENE)
    of_python = scene.replace(grading=lambda s: 1 + 0.3 * np.tanh(s))
    (tmp_path / "python.toml").write_text(mcgw.scene_text(of_python))  # holds the series of that grading
    assert call(["figures", "--scene", str(tmp_path / "python.toml")]).code == 0
    assert "figure-3: not drawn: why not" in given.out
    (default,) = seen
    assert (default.n_asperities, default.seed) == (30_000, 20240601)
    one, other = scenes
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
    assert call(["compare", "@e.h5"]).code == 0
    assert (material / "e.png").is_file()
    assert call(["report", "@e.h5"]).code == 0
    assert (material / "e.html").is_file()
    assert call(["regrade", "@e.h5", "--gamma", "1"]).code == 0
    assert (material / "e.regraded.h5").is_file()
    assert call(["run", "@s.toml"]).code == 0
    assert (material / "out" / "s.h5").is_file()
    assert read_attributes(material / "out" / "s.h5")["seed"] == 5

"""What no scene has, no call takes and no place allows: one line with the key, the value and the cure."""

import re
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import scipy.stats as st
from oracles.scenes import scene_by
from tables.scene_keys import text

import analytic
import mcgw
from mcgw.cli import main

SURFACE = mcgw.Surface("1 um", "10 um", "1000/mm^2", "1 mm^2", "100 GPa")
SCENE = mcgw.Scene(SURFACE, separations=[0.0, 1.0], n_surfaces=4, seed=1)
COATED = analytic.Coated(ratio=2.0, thickness=1e-6, poisson=0.25)


def scene(**given):
    return scene_by(**{"surface": SURFACE, "separations": [0.0, 1.0], "n_surfaces": 3, "seed": 1} | given)


def read(**tables):
    """A text that is right but for these keys."""
    return mcgw.scene_from(text(**tables))


def table(s, ratio):
    return {"grading": {"law": "'table'", "s": s, "ratio": ratio}, "heights": None}


OTHERS = [  # other objects and words than a call takes
    (lambda: mcgw.simulate(SURFACE),
     r"simulate: give a mcgw\.Scene, not Surface; mcgw\.Scene\(surface, separations=\.\.\.\) makes one"),
    (lambda: mcgw.run("mine.toml", "never.h5"),
     r"run: give a mcgw\.Scene, not str 'mine\.toml'; mcgw\.load_scene\(path\) reads one"),
    (lambda: mcgw.solve(mcgw.simulate(SCENE), pressure=1e6),
     r"solve: give a mcgw\.Scene, not Ensemble; that of an ensemble is its \.scene"),
    (lambda: mcgw.sweep(3, {"grading.gamma": [1.0]}), r"sweep: give a mcgw\.Scene, not int; "),
    (lambda: mcgw.converge(SURFACE), r"converge: give a mcgw\.Scene, not Surface"),
    (lambda: mcgw.tradeoff(SURFACE), r"tradeoff: give a mcgw\.Scene, not Surface"),
    (lambda: mcgw.elastic(SCENE, pressure=1e6), "m0, m2, m4"),
    (lambda: mcgw.compare(SCENE),
     r"compare: give a mcgw\.Ensemble, not Scene; mcgw\.simulate\(scene\) draws one"),
    (lambda: mcgw.save("file.h5", "never.h5"),
     r"save: give a mcgw\.Ensemble, not str 'file\.h5'; mcgw\.open_ensemble\(path\) opens one"),
    (lambda: mcgw.paired_ratio(mcgw.simulate(SCENE), None, "load"),
     r"paired_ratio: give a mcgw\.Ensemble, not NoneType; "),
    (lambda: mcgw.solve(SCENE, pressures=[1e6]), r"solve: there is no 'pressures'; did you mean pressure\?$"),
    *((lambda call=call, more=more: call(SCENE, n_surface=3, **more),
       r"^a scene has no 'n_surface'; did you mean n_surfaces\?$") for call, more in (
        (mcgw.Scene.replace, {}), (mcgw.simulate, {}), (mcgw.solve, {"load": 1.0}), (mcgw.converge, {}),
        (mcgw.tradeoff, {}))),
    (lambda: mcgw.Body("70 m"), "E = '70 m': give a finite number > 0 in Pa"),
    (lambda: mcgw.Body(7e10, 0.6), r"nu = 0\.6: give a finite number"),
    (lambda: SCENE.replace(sigma="2 N"), r"surface\.sigma = '2 N': give a finite number > 0"),
]  # fmt: skip
CALLS = [  # wrong values of arguments
    (lambda: mcgw.simulate(scene(), threads=0), r"^threads = 0: give a whole number >= 1$"),
    (lambda: mcgw.simulate(scene(), threads=1.5), r"^threads = 1\.5: give a whole number >= 1$"),
    (lambda: mcgw.simulate(scene(), progress=3),
     r"^progress = 3: give True, or a function of \(done, total\)$"),
    (lambda: mcgw.run(scene(), "x.h5", executor="gpu"),
     r"^executor = 'gpu': give a concurrent.futures.Executor, such as ProcessPoolExecutor"),
    (lambda: mcgw.run(scene(), "x.h5", shard="9/8"), "9/8: give i/n with 1 <= i <= n$"),
    (lambda: mcgw.run(scene(), "x.h5", shard="1/2", executor=ThreadPoolExecutor(1)),
     r"^shard = '1/2': .*leave executor out$"),
    (lambda: mcgw.solve(scene()),
     "^solve: give one of load, pressure, area, area_fraction, nominal_separation, not none$"),
    (lambda: mcgw.solve(scene(), load=1, area=1), "^solve: give one of .*, not load and area$"),
    (lambda: mcgw.solve(scene(), pressure="1 N"),
     r"^pressure = '1 N': give a finite number > 0 in Pa, such as 1MPa"),
    (lambda: mcgw.solve(scene(), load=[1.0, -1.0]),
     r"^load = -1\.0: give a finite number > 0 in N, such as 5N"),
    (lambda: mcgw.tradeoff(scene(), seconds="1 m"),
     r"^seconds = '1 m': give a finite number > 0 in s, such as 90 s"),
    (lambda: mcgw.fit("map.h5", cutoff="5 N"), r"^cutoff = '5 N': give a finite number > 0 in m"),
    (lambda: mcgw.fit("map.h5", cutoff=None, form="x"),
     r"^form = 'x': choose one of plane, none, quadratic, cubic, quartic$"),
    (lambda: mcgw.fit("map.h5", cutoff=None, parts=1), r"^parts = 1: give a whole number >= 2$"),
    (lambda: mcgw.fit("map.h5", cutoff=None, pixel=-1), r"^pixel = -1: give a finite number > 0 in m"),
    (lambda: mcgw.solve(SCENE, 1e6), r"^solve: 1000000\.0 has no name: give one of load=, pressure=, "),
]  # fmt: skip
HARDNESS = [  # what says nothing beside a law
    (lambda: scene(law="hertz", poisson=0.3), r"contact\.law\.poisson = 0\.3: give hardness too, or leave"),
    (lambda: scene(law={"name": "hertz", "k": 0.3}),
     r"contact\.law\.k: unknown key; it is for name = 'power-law-graded' only; leave it out"),
    (lambda: scene(law=COATED, hardness=2e9, poisson=0.2),
     r"contact\.law\.poisson = 0\.2: give it to the law, Coated, or leave it out"),
    (lambda: scene(law=analytic.JacksonGreen(yield_strength=4e8), hardness=2e9),
     r"contact\.law\.hardness = 2.*: give it to the law, JacksonGreen, or leave it out"),
]  # fmt: skip
TEXTS = [
    (lambda: read(contact={"separations": [1.0, -5e-324]}),
     r"contact\.separations: -4\.94066e-324 is too close to 0"),
    (lambda: read(ensemble={"n_asperities": 2**53 + 1}), r"ensemble\.n_asperities = .*between 1 and 2\^53"),
    (lambda: read(surface={"sigma": 1e-320}), "surface.*beyond double precision"),
    (lambda: read(surface={"E_star": 1e308}), "surface.*beyond double precision"),
    (lambda: read(**table([0.0, 9.0], [1.0, -1.0])), r"grading.*negative from s = 4\.5"),
    (lambda: read(**table([1.0, 0.0], [1.0, 2.0])), "grading.*the heights must increase"),
    (lambda: read(contact={"quantities": ["lod"]}),
     r"contact\.quantities = 'lod': did you mean load\? choose one of load, area"),
    (lambda: mcgw.scene_from(b"\xef\xbb\xbf" + text().encode()), "this is not TOML"),
    (lambda: read(ensemble={"n_asperities": "9" * 5000}), "this is not TOML"),
    (lambda: read(contact={"separations": "[" * 5000 + "]" * 5000}), "this is not TOML"),
]  # fmt: skip
FAR = [  # beyond numbers, memory, disk and folders
    (lambda: mcgw.run(scene(n_surfaces=10**12, n_asperities=10**8, separations=3.0), "e.h5"),
     r"needs up to .* GiB more on the disk while made and .* are free"),
    (lambda: scene(grading=analytic.Exponential(1e300)), r"grading.gamma = 1e\+300: .* overflow"),
    *((lambda name=name: mcgw.run(SCENE, name), words) for name, words in (
        ("..", ""), ("a\0b", ""), ("x" * 300, ""), ("a\nb", ""), ("", "is not a valid file name"),
        ("/proc/e.h5", "0 GiB are free|cannot be written"))),
    (lambda: mcgw.load_scene("."), "is not a regular file"),
    (lambda: mcgw.load_scene("absent.toml"), "No such file"),
    (lambda: mcgw.open_ensemble("/dev/zero"), "is not a regular file"),
    (lambda: mcgw.solve(SCENE, load=5e-324), r"load = .*double precision of the heights; give .* or more"),
]  # fmt: skip
ONLY_PYTHON = [
    ({"surface": 3}, r"^surface = 3: .* give mcgw\.Surface\("),
    ({"summits": 3.0}, r"^summits\.curvature = 3\.0: .* random, mean; .* give mcgw\.MeasuredRadii"),
    ({"law": mcgw.KogutEtsion(hardness=1e300)},
     r'^contact\.law = "kogut-etsion": critical = inf: give a finite number > 0$'),
    ({"law": mcgw.JacksonGreen(yield_strength=1e200)},
     r'^contact\.law = "jackson-green": critical = inf: give a finite number > 0$'),
    ({"surface": analytic.Surface(1e250, 1e250, 1e-9, 1e12, 1e9), "quantities": ["load"]},
     "^surface: the load of an asperity would be inf N, beyond double precision; check sigma"),
    ({"grading": 2.0}, r"^grading\.law = 2\.0: .* give mcgw\.Exponential\(gamma\)"),
    ({"grading": mcgw.Homogeneous}, r"^grading\.law = <class .*Homogeneous'>: .* give mcgw"),
    ({"grading": lambda s: 1.0 + float(s)},
     r"^grading: the function fails on an array of heights \(TypeError: .*vectorize"),
    ({"grading": lambda s: s > 0 and 1.0}, r"^grading: the function fails on an array .*\(ValueError: "),
    ({"grading": lambda s: s[:1]}, r"^grading: gave shape \(1,\)"),
    ({"grading": lambda s: np.log(s - 3)}, r"^grading: E\*\(s\)/E\* is not finite at s = "),
    ({"grading": lambda s: 1 - s}, r"^grading: E\*\(s\) is negative from s = 1\.\d*,"),
    ({"heights": np.ones(3)}, r"^heights\.law = \[1.*\]: .* give .*mcgw\.HeightTable\.of\(heights\)"),
    ({"heights": mcgw.Gaussian}, r"^heights\.law = <class .*Gaussian'>: .* give mcgw"),
    ({"heights": st.lognorm}, r"^heights\.law = <scipy.*: .* give mcgw"),
    ({"heights": st.poisson(3)}, r"^heights\.law = <scipy.*: give a frozen continuous distribution"),
    ({"heights": st.cauchy()}, r"^heights\.law = <scipy.*: cauchy: its mean is nan .* must be finite"),
]  # fmt: skip
REFUSED = [
    *((lambda given=given: scene(**given), words) for given, words in ONLY_PYTHON),
    *OTHERS,
    *CALLS,
    *HARDNESS,
    *TEXTS,
    *FAR,
]


@pytest.mark.parametrize(("action", "words"), REFUSED, ids=[words for _, words in REFUSED])
def test_one_line_names_what_is_wrong_and_the_cure(action, words, in_tmp_path):
    """And nothing is written."""
    with pytest.raises((ValueError, TypeError)) as caught:
        action()
    said = getattr(caught.value, "problems", [str(caught.value)])
    assert any(re.search(words, line) for line in said), said
    assert all("\n" not in line and len(line) < 350 for line in said)
    assert not list(in_tmp_path.iterdir())


NO_SCENE = [
    ("[surface]\nsigma = 1 um\n", 'sigma = 1 um; quote a text with its unit: sigma = "1 um"'),
    ("[surface]\nradius = 1.3e-5m # R\n", 'quote a text with its unit: radius = "1.3e-5m"'),
    ("[contact]\nlaw = hertz\n", 'law = hertz; quote a text: law = "hertz"'),
    ("[surface]\nradius 1e-5\n", "radius 1e-5; write key = value"),
    ("[surface]\nsigma = 1e-6\n[surface]\n", ": [surface]"),
    ("[grading\n", ": [grading"),
    ("a = [1,\n", ""),
    ("# gr\u00f6\u00dfer\n".encode("latin-1"), ": not text in UTF-8 (byte 4)"),
    (text() + "#" * 2**21, "longer than 2097152 bytes"),
]


@pytest.mark.parametrize(("written", "line"), NO_SCENE, ids=[line for _, line in NO_SCENE])
def test_a_file_that_is_no_scene_is_one_line_with_its_cure(written, line, tmp_path, capsys):
    path = tmp_path / "bad.toml"
    path.write_bytes(written if isinstance(written, bytes) else written.encode())
    assert main(["run", str(path)]) == 2
    (told,) = capsys.readouterr().err.splitlines()
    assert told.startswith(f"mcgw: {path}: {'this is not TOML: ' * ('longer' not in line)}")
    assert told.endswith(line)


@pytest.mark.parametrize("quantities", [None, ["stiffness"], ["area", "load_slope", "load"]])
def test_what_breaks_off_is_told_with_the_list_to_give(quantities):
    law = {"name": "johnson-kendall-roberts", "pull_off": 0.1}
    with pytest.raises(mcgw.SceneError) as error:
        scene(law=law, unload_from=0.0, quantities=quantities)
    (line,) = error.value.problems
    names = re.search(r"; give \[(.*)\], or leave out unload_from$", line)[1].replace('"', "").split(", ")
    assert names == {0: ["load", "area", "contacts"], 1: ["load"], 3: ["area", "load"]}[len(quantities or ())]
    assert set(names) < set(scene(law=law, unload_from=0.0, quantities=names).quantities)


def test_negative_moduli_are_named_clipped_or_allowed():
    """Below -ln 2 for gamma = 2, touched from -2 on; above ln 3 for gamma = -0.5."""
    with pytest.raises(mcgw.SceneError, match=r"^grading\.gamma = 2.* negative from s = (-2|-1\.99)"):
        scene(grading=analytic.Exponential(2.0), separations=-2.0)
    with pytest.raises(mcgw.SceneError, match=r"^grading\.gamma = -0\.5.* negative from s = 1\.099"):
        scene(grading=analytic.Exponential(-0.5))
    for word in ("clip", "allow"):
        found = scene(grading=analytic.Exponential(2.0), separations=-2.0, negative=word)
        assert (found.modulus(np.array([-1.0]))[0] < 0) == (word == "allow")


@pytest.mark.parametrize(("n", "surfaces", "separation"), [(10**12, 1000, 0.0), (10**14, 1000, 4.0)])
def test_hours_of_drawing_are_told_when_the_scene_is_made(n, surfaces, separation):
    def hours(**others):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            scene(**{"separations": separation, "n_asperities": n, "n_surfaces": surfaces} | others)
        return [str(each.message) for each in caught if "hours" in str(each.message)]

    (line,) = hours()
    told = re.fullmatch(r'ensemble: .* take about (\S+) hours; give fewer, .* = "aggregate".*', line)
    assert float(told[1]) == pytest.approx(n * st.norm.sf(separation) * surfaces * 4.4e-9 / 3600, rel=0.06)
    assert not hours(sampler="aggregate")
    assert not hours(max_seconds=60.0)
    assert not hours(n_asperities=int(n / float(told[1]) * 0.9))
    assert hours(n_asperities=min(int(n / float(told[1]) * 1.1), 2**53))


def test_a_plane_that_sinks_faster_than_it_is_pressed_is_told_up_to_where():
    """The nominal separation h - c P(h)/sigma falls below 1.5 for a half-space as soft as this."""
    plain = scene(separations=[0.0, 1.0, 2.0])
    soft = mcgw.Interaction("mean-plane", bulk_modulus=1e9)
    above, below = (float(plain.theory.mean("load", 1.5 + step)) for step in (-1e-4, 1e-4))
    ratio = soft.compliance(SURFACE, plain.n_asperities) * (above - below) / 2e-4 / SURFACE.sigma
    for_1_5 = 1e9 * abs(ratio)
    plain.replace(interaction=mcgw.Interaction("mean-plane", bulk_modulus=1e3 * for_1_5))
    with pytest.raises(mcgw.SceneError, match=r"^interaction: at d/sigma = 1 the mean plane sinks faster"):
        plain.replace(interaction=mcgw.Interaction("mean-plane", bulk_modulus=for_1_5))

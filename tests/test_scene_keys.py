"""Every key of every table: wrong values of it, a misspelt one beside it; all from one list of keys."""

import re
from dataclasses import fields, replace
from pathlib import Path

import pytest

import analytic
import mcgw
from mcgw.scene.plausible import RANGES, perhaps_other_units
from mcgw.scene.scene import LeftOut, Scene, SceneError
from mcgw.scene.section import Section
from mcgw.scene.surface import SURFACE_UNITS

GOOD = {
    "": {"title": "'x'"},
    "surface": {"sigma": "1e-6", "radius": "1e-5", "eta": "1e9", "nominal_area": "1e-6", "E_star": "1e11"},
    "grading": {"law": "'exponential'", "gamma": "0.5", "negative": "'clip'"},
    "heights": {"law": "'weibull'", "shape": "2.0"},
    "contact": {"separations": "{start = 0.0, stop = 1.0, num = 3}", "quantities": "['load']"},
    "ensemble": {
        "n_surfaces": "10", "n_asperities": "100", "count": "'fixed'", "seed": "1", "sampler": "'cells'",
        "keep": "'sums'", "max_seconds": "1.0", "left_out": "['seed']", "accuracy": "1e-6",
        "law_error": "1e-3", "edges": "[0.5, 2.0]",
    },
}  # fmt: skip
SERIES = {"law": "'series'", "edges": "[0.0, 5.0, 20.0]", "coefficients": "[[1.0, 0.5], [1.5]]"}
PIECE = "[{low = -1.0, high = 1.0, coefficients = [1.0]}, {low = 1.0, high = 3.0, coefficients = [1.0]}]"
CUSTOM = {"law": "'custom'", "critical": "0.05", "limits": "[1.0]", "load": PIECE, "area": PIECE}
NAYAK = {("heights", "law"): "'nayak'", ("heights", "shape"): None, ("heights", "alpha"): "5.0"}
SPECTRAL = {"sigma": None, "radius": None, "eta": None, ("heights", "law"): None, ("heights", "shape"): None}
SPECTRAL |= {"m0": "1e-12", "m2": "1e-3", "m4": "5e6"}
LISTED = {("heights", "law"): None, ("heights", "shape"): None, ("ensemble", "sampler"): "'direct'"}
LISTED |= {"resample": "true"}
HEIGHTS, RADII = {"heights": "[0.0, 1e-6, 3e-6]"}, {"radii": "[1e-5, 2e-5, 3e-5]"}
# Keys that need other company: its good value, and what is put in place of which other lines.
COMPANY = {
    ("surface", "bodies"): ("[{E = 7e10, nu = 0.3}, {E = inf}]", {"E_star": None}),
    ("ensemble", "rel_err"): ("0.01", {"n_surfaces": None}),
    ("ensemble", "max_surfaces"): ("50", {"n_surfaces": None, "rel_err": "0.01"}),
    ("grading", "s"): ("[0.0, 1.0]", {"gamma": None, "law": "'table'", "ratio": "[1.0, 2.0]"}),
    ("grading", "ratio"): ("[1.0, 2.0]", {"gamma": None, "law": "'table'", "s": "[0.0, 1.0]"}),
    ("grading", "edges"): ("[0.0, 5.0, 20.0]", {"gamma": None, **SERIES, "edges": None}),
    ("grading", "coefficients"): ("[[1.0, 0.5], [1.5]]", {"gamma": None, **SERIES, "coefficients": None}),
    ("grading", "kinks"): ("[5.0]", {"gamma": None, **SERIES}),
    ("grading", "name"): ("'ramp'", {"gamma": None, **SERIES}),
    ("grading", "file"): ("'g.csv'", {"gamma": None, "law": "'table'"}),
    ("heights", "file"): ("'h.csv'", {"shape": None, "law": "'table'"}),
    ("heights", "heights"): ("[0.0, 1.0, 3.0]", {"shape": None, "law": "'table'"}),
    ("heights", "resample"): ("true", {"shape": None, "law": "'table'", "heights": "[0.0, 1.0, 3.0]"}),
    ("heights", "s"): ("[0.0, 1.0]", {"shape": None, "law": "'table'", "share": "[0.0, 1.0]"}),
    ("heights", "share"): ("[0.0, 1.0]", {"shape": None, "law": "'table'", "s": "[0.0, 1.0]"}),
    ("heights", "name"): ("'gamma'", {"shape": None, "law": "'scipy'", "shapes": "{a = 4.0}"}),
    ("heights", "shapes"): ("{a = 4.0}", {"shape": None, "law": "'scipy'", "name": "'gamma'"}),
    ("heights", "alpha"): ("5.0", {"shape": None, "law": "'nayak'"}),
    ("interaction", "reference"): ("'body'", {}),
    ("interaction", "at"): ("'nominal'", {"reference": "'body'"}),
    ("interaction", "bulk_modulus"): ("1e11", {"reference": "'body'"}),
    ("surface", "m0"): ("1e-12", SPECTRAL),
    ("surface", "m2"): ("1e-3", SPECTRAL),
    ("surface", "m4"): ("5e6", SPECTRAL),
    ("summits", "curvature"): ("'random'", NAYAK),
    ("summits", "largest_radius"): ("'1 mm'", NAYAK | {"curvature": "'random'"}),
    ("summits", "file"): ("'s.csv'", LISTED),
    ("summits", "heights"): (HEIGHTS["heights"], LISTED | RADII),
    ("summits", "radii"): (RADII["radii"], LISTED | HEIGHTS),
    ("summits", "ratios"): ("[1.0, 2.0, 3.0]", LISTED | HEIGHTS),
    ("summits", "resample"): ("true", LISTED | {"file": "'s.csv'"}),
    ("contact", "datum"): ("'surface'", NAYAK),
    ("contact", "law"): ("'kogut-etsion'", {"critical": "0.05"}),
    ("contact", "critical"): ("0.05", {"law": "'kogut-etsion'"}),
    ("contact", "hardness"): ("'1.2 GPa'", {"law": "'kogut-etsion'"}),
    ("contact", "poisson"): ("0.3", {"law": "'kogut-etsion'", "critical": "0.05"}),
    ("contact", "bridge"): ("'hermite'", {"law": "'kogut-etsion'", "critical": "0.05"}),
    ("contact", "yield_strength"): ("'400 MPa'", {"law": "'jackson-green'"}),
    ("contact", "yield_strain"): ("0.004", {"law": "'jackson-green'", "critical": "0.1"}),
    ("contact", "k"): ("0.5", {"law": "'power-law-graded'", "c0": "'10 um'"}),
    ("contact", "c0"): ("'10 um'", {"law": "'power-law-graded'", "k": "0.5"}),
    ("contact", "reduced_c0"): ("1.0", {"law": "'power-law-graded'", "k": "0.5"}),
    ("contact", "thickness"): ("'1 um'", {"law": "'coated'", "ratio": "3.0"}),
    ("contact", "reduced_thickness"): ("0.5", {"law": "'coated'", "ratio": "3.0"}),
    ("contact", "ratio"): ("3.0", {"law": "'coated'", "thickness": "'1 um'"}),
    ("contact", "limits"): ("[1.0]", CUSTOM | {"limits": None}),
    ("contact", "load"): (CUSTOM["load"], CUSTOM | {"load": None}),
    ("contact", "area"): (CUSTOM["area"], CUSTOM | {"area": None}),
    ("contact", "work"): ("'0.05 J/m^2'", {"law": "'johnson-kendall-roberts'"}),
    ("contact", "pull_off"): ("0.1", {"law": "'derjaguin-muller-toporov'"}),
    ("contact", "unload_from"): ("-0.5", {}),
    ("contact", "resistivity"): ("1e-7", {}),
    ("contact", "conductivities"): ("[150.0, 16.0]", {}),
    ("contact", "film_resistance"): ("1e-12", {"resistivity": "1e-7"}),
    ("contact", "tangential"): ("{friction = 0.3, poisson = 0.3, displacements = [1e-8]}", {}),
}
WRONG = {
    "title": ["1"], "sigma": ["0.0", "-1e-6", "nan", "true", "[1.0]"], "radius": ["0", "-1", "inf", "'x'"],
    "eta": ["0", "-1", "{}"], "nominal_area": ["0", "-1", "'1 m'"], "E_star": ["0", "-1", "'1 N'"],
    "reference": ["'plane'", "1"], "at": ["'both'", "1"], "bulk_modulus": ["0", "-1", "'1 N'"],
    "bodies": ["[]", "[{E = 7e10}]", "[{E = -1}, {E = 1}]", "[{E = 1, nu = 2}, {E = 1}]",
               "[{e = 1}, {E = 1}]",
               "3", "[{E = true}, {E = 1}]", "[{E = 1, nu = '0.3'}, {E = 1}]", "[{E = '1 m'}, {E = 1}]"],
    "law": ["'gauss'", "1"], "gamma": ["nan", "inf", "'2'", "true"], "negative": ["'no'", "1"],
    "file": ["'absent.csv'", "1", "''"], "ratio": ["[1.0]", "1", "['a', 'b']", "[nan, 1.0]"],
    "edges": ["[0.0, 20.0, 5.0]", "[0.0, 5.0, 5.0]", "[0.0, 5.0, inf]", "[0.0, 5.0, 'x']", "5.0", "[]",
              "[0.0, 5.0, true]", "[0.0, 1.0, 2.0]", "[3.0, 5.0, 20.0]"],
    "coefficients": ["[]", "[[1.0]]", "[[1.0], []]", "[[1.0], [nan]]", "[[1.0], ['x']]", "[1.0, 2.0]", "'x'",
                     "[[1.0], [[1.0]]]", f"[[1.0], {[1.0] * 65}]"],
    "kinks": ["[4.0]", "[0.0]", "['x']", "5.0", "[5.0, 5.0]"],
    "shape": ["0.5", "101", "'2'", "nan"], "heights": ["[]", "[1.0, 1.0]", "'x'", "1"],
    "resample": ["1.5", "'no'"],
    "share": ["[0.0, 0.5]", "[0.0]", "1"], "name": ["'absent'", "1", "'binom'"],
    "shapes": ["{b = 1.0}", "{a = 'x'}", "1", "{a = -1.0}"],
    "separations": ["[]", "'x'", "[nan]", "true", "[[1.0]]", "{start = 0.0}", "[1e-200]", "[1e7]"],
    "quantities": ["[]", "['weight']", "'load'", "['load', 'load']", "[1]"],
    "n_surfaces": ["0", "-1", "1.5", "'10'", "true", "inf"], "max_surfaces": ["0", "-1", "1.5", "true"],
    "n_asperities": ["0", "-1", "1.5", "true", "1e300"], "count": ["'free'", "1"],
    "seed": ["-1", "1.5", "18446744073709551616", "true"], "sampler": ["'all'", "1"], "keep": ["'all'", "1"],
    "accuracy": ["0", "-1", "1", "nan", "inf", "'abc'", "1e-14", "true", "[1e-6]"],
    "law_error": ["-1", "1", "0.2", "nan", "'abc'", "true"],
    "rel_err": ["0", "-0.1", "0.2", "'x'", "true"], "max_seconds": ["0", "-1", "inf", "'1 m'"],
    "critical": ["0", "-1", "'x'", "nan"], "hardness": ["0", "-1", "'1 m'"],
    "poisson": ["0.6", "-1.5", "'x'"], "bridge": ["'cubic'", "1"],
    "yield_strength": ["0", "'1 N'"], "yield_strain": ["0", "nan"],
    "k": ["1.0", "-0.1", "'x'"], "c0": ["0", "'1 Pa'"], "reduced_c0": ["0", "-1"],
    "thickness": ["0", "'1 Pa'"], "reduced_thickness": ["0", "-1"], "unload_from": ["0.5", "'back'", "nan"],
    "resistivity": ["0", "-1", "'x'"], "conductivities": ["[1.0]", "[0.0, 1.0]", "1.0", "['x', 1.0]"],
    "film_resistance": ["-1", "'x'"],
    "tangential": ["1", "{}", "{friction = 0.3}", "{friction = 0, poisson = 0.3, displacements = [1e-8]}",
                   "{friction = 0.3, poisson = 0.9, displacements = [1e-8]}",
                   "{friction = 0.3, poisson = 0.3, displacements = []}",
                   "{friction = 0.3, poisson = 0.3, displacements = [-1.0]}",
                   "{friction = 0.3, poisson = 0.3, displacements = ['x']}",
                   "{friction = 0.3, poisson = 0.3, displacements = [1e-8], u = 1}"],
    "limits": ["1.0", "[-1.0]", "['x']", "[nan]"],
    "load": ["[]", "1", PIECE.replace("}, {", "}] #"), "[{low = 1.0}]", PIECE.replace("[1.0]", "[]"),
             PIECE.replace("high = 3.0", "high = 0.5")],
    "area": ["[]", "'x'", PIECE.replace("[1.0]", "['x']"), PIECE.replace("low = 1.0", "lowest = 1.0")],
    "work": ["0", "-1", "'x'"], "pull_off": ["0", "-1", "inf"],
    "alpha": ["1.5", "0", "'x'", "nan", "inf"], "curvature": ["'all'", "1"],
    "m0": ["0", "-1", "'1 m'"], "m2": ["0", "nan", "'1 m'"], "m4": ["0", "-1", "'1 m'"],
    "largest_radius": ["0", "-1", "'1 Pa'"], "datum": ["'top'", "1"],
    "radii": ["[1e-5]", "1", "[1e-5, -1e-5, 1e-5]", "[1e-5, nan, 1e-5]", "['x', 1, 1]"],
    "ratios": ["[1.0]", "'x'", "[1.0, -1.0, 1.0]"],
    "left_out": ["'seed'", "['gamma']", "[1]", "['n_asperities']"],
}  # fmt: skip
WRONG_HERE = {
    ("grading", "s"): ["[1.0]", "[1.0, 0.0]", "[0.0, nan]", "1"],
    ("heights", "s"): ["[1.0]", "[1.0, 0.0]", "1"],
    ("grading", "name"): ["1", "['x']"],
    ("ensemble", "edges"): ["1.0", "'x'", "[1.0, 'x']", "[nan]", "[inf]", "[true]", "{a = 1.0}"],
    ("contact", "ratio"): ["0", "-1", "'x'"],
    ("summits", "heights"): ["[]", "[1.0]", "1", "[1.0, nan, 2.0]"],
}  # fmt: skip


def keys():
    """All keys of all tables: those of GOOD and those in other company."""
    return [(table, key) for table, lines in GOOD.items() for key in lines] + list(COMPANY)


def text_of(table, key, value):
    """A scene that is right but for the value of one key."""
    tables = {name: dict(lines) for name, lines in GOOD.items()}
    _, others = COMPANY.get((table, key), ("", {}))
    for other, line in others.items():
        place, name = other if isinstance(other, tuple) else (table, other)
        tables.setdefault(place, {}).pop(name, None)
        if line is not None:
            tables[place][name] = line
    tables.setdefault(table, {})[key] = value
    return "\n".join(
        (f"[{name}]\n" if name else "") + "".join(f"{k} = {v}\n" for k, v in lines.items())
        for name, lines in tables.items()
    )


def good(table, key):
    return COMPANY[table, key][0] if (table, key) in COMPANY else GOOD[table][key]


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("g.csv").write_text("s,ratio\n0,1\n1,2\n")
    Path("h.csv").write_text("0\n1\n3\n")
    Path("s.csv").write_text("height,radius\n0,1e-5\n1e-6,2e-5\n3e-6,3e-5\n")


def test_the_list_of_keys_is_whole(monkeypatch):
    """Whatever key any scene is asked for stands in the lists above."""
    asked = set()
    plain = Section._take

    def noted(self, key, default, unit=""):
        asked.add((self.name, key))
        return plain(self, key, default, unit)

    monkeypatch.setattr(Section, "_take", noted)
    for table, key in keys():
        mcgw.scene_from(text_of(table, key, good(table, key)))
    inner = {("contact.separations", name) for name in ("start", "stop", "num")}
    inner |= {("contact.tangential", name) for name in ("friction", "poisson", "displacements")}
    tables = {("", name) for name in (*GOOD, "summits", "interaction") if name}
    assert asked - inner - tables == set(keys())


@pytest.mark.parametrize(("table", "key"), keys())
def test_every_wrong_value_of_every_key_names_it(table, key):
    mcgw.scene_from(text_of(table, key, good(table, key)))
    path = f"{table}.{key}" if table else key
    for value in WRONG_HERE.get((table, key)) or WRONG[key]:
        with pytest.raises(SceneError) as caught:
            mcgw.scene_from(text_of(table, key, value))
        said = caught.value.problems
        named = {path, f"{table}.s"} if key in ("share", "ratio") else {path}
        if key in ("radii", "ratios"):  # lists of two lengths are told by the first
            named.add("summits.heights")
        if key == "left_out":
            named.add("ensemble.n_asperities")
        if key == "law":  # of another law other keys are unknown
            named.add(f"{table}.")
        assert all(any(line.startswith(name) for name in named) for line in said), (value, said)
        assert all("\n" not in line and len(line) < 300 for line in said)


@pytest.mark.parametrize(("table", "key"), keys())
def test_an_unknown_key_beside_every_key_is_named(table, key):
    """A misspelling of this very key, which would be its default in silence."""
    text = text_of(table, key, good(table, key))
    start = f"[{table}]\n" if table else ""
    at = text.index(start) + len(start) if start else 0
    with pytest.raises(SceneError) as caught:
        mcgw.scene_from(f"{text[:at]}{key}x = 1\n{text[at:]}")
    (line,) = caught.value.problems
    path = f"{table}.{key}x" if table else f"{key}x"
    assert line.startswith(f"{path}: unknown key; did you mean ")


def test_a_singular_for_a_plural_is_no_default():
    text = text_of("ensemble", "n_surfaces", "10").replace("n_surfaces = 10", "n_surface = 5")
    with pytest.raises(SceneError, match=r"ensemble\.n_surface: unknown key; did you mean n_surfaces\?"):
        mcgw.scene_from(text)


def test_an_unknown_table_is_named():
    for name in GOOD:
        if name:
            with pytest.raises(SceneError, match=f"{name}x: unknown key; did you mean {name}"):
                mcgw.scene_from(text_of("", "title", "'x'") + f"[{name}x]\n")


RANGE = {"start": "0.0", "stop": "1.0", "num": "3"}


@pytest.mark.parametrize("key", RANGE)
def test_inside_of_separations(key):
    def of(lines):
        inside = ", ".join(f"{k} = {v}" for k, v in lines.items())
        return text_of("contact", "separations", f"{{{inside}}}")

    assert mcgw.scene_from(of(RANGE)).separations == (0.0, 0.5, 1.0)
    wrong = {"num": ["0", "-3", "1.5", "true", "100001", "'3'"]}.get(key, ["nan", "inf", "'1'", "true"])
    for value in wrong:
        with pytest.raises(SceneError) as caught:
            mcgw.scene_from(of(RANGE | {key: value}))
        (line,) = caught.value.problems
        assert line.startswith(f"contact.separations.{key} = ")
    with pytest.raises(SceneError, match=re.escape(f"contact.separations.{key}x: unknown key")):
        mcgw.scene_from(of(RANGE | {f"{key}x": "1"}))
    with pytest.raises(SceneError, match=re.escape(f"contact.separations.{key}: missing")):
        mcgw.scene_from(of({k: v for k, v in RANGE.items() if k != key}))


# --- what was left out --------------------------------------------------------------------------------

SURFACE = analytic.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e11)
LARGE = replace(SURFACE, nominal_area=1e-5)


def test_n_follows_the_surface_unless_it_was_given():
    left_out = Scene(surface=SURFACE, separations=(1.0,), seed=1)
    given = Scene(surface=SURFACE, separations=(1.0,), n_asperities=1000, seed=1)
    assert left_out == given  # the same ensemble, by whatever way
    assert hash(left_out.n_asperities) == hash(1000)
    assert repr(left_out) == repr(given)
    changes = (
        lambda s: replace(s, surface=LARGE),
        lambda s: s.replace(surface=LARGE),
        lambda s: s.replace(nominal_area=1e-5),
        lambda s: s.replace(nominal_area="10 mm²"),
    )
    for change in changes:
        assert change(left_out).n_asperities == 10_000
        assert change(replace(left_out, title="between")).n_asperities == 10_000
        assert change(given).n_asperities == 1000
        assert change(left_out.replace(n_asperities=1000)).n_asperities == 1000
        assert change(mcgw.scene_from(mcgw.scene_text(left_out))).n_asperities == 10_000
        assert change(mcgw.scene_from(mcgw.scene_text(given))).n_asperities == 1000
    assert left_out.replace(eta="2000/mm^2", nominal_area="1 cm^2").n_asperities == 200_000


def test_a_changed_surface_keeps_the_pressure():
    """Ten times the area, ten times the asperities: what the theory says of pressures is what is drawn."""
    scene = Scene(surface=SURFACE, separations=(0.5,), n_surfaces=400, seed=3)
    small, large = mcgw.simulate(scene), mcgw.simulate(scene.replace(nominal_area=1e-5))
    ratio = large.mean("load")[0] / small.mean("load")[0]
    error = ratio * (
        large.stderr("load")[0] / large.mean("load")[0] + small.stderr("load")[0] / small.mean("load")[0]
    )
    assert abs(ratio - 10) < 5 * error
    assert 5 * error < 5  # N that stays would give 1


def test_the_text_marks_what_nobody_gave_and_older_texts_read_the_same():
    scene = Scene(surface=SURFACE, separations=(1.0,), seed=1)
    text = mcgw.scene_text(scene)
    assert "n_asperities = 1000\n" in text
    assert re.search(r'left_out = \[\s*"n_asperities",\s*\]', text)
    again = mcgw.scene_from(text)
    assert again == scene
    assert again.left_out == ("n_asperities",)
    assert mcgw.scene_text(again) == text
    older = mcgw.scene_text(scene, left_out=False)
    assert "left_out" not in older
    assert mcgw.scene_from(older) == scene
    assert mcgw.scene_from(older).left_out == ()


def test_a_mark_that_no_longer_holds_is_refused():
    text = mcgw.scene_text(Scene(surface=SURFACE, separations=(1.0,)))
    for old, new in (
        ("n_asperities = 1000", "n_asperities = 500"),
        ("nominal_area = 1e-06", "nominal_area = 1e-05"),
    ):
        with pytest.raises(SceneError, match="take it out of left_out, or leave n_asperities out"):
            mcgw.scene_from(text.replace(old, new))


def test_a_drawn_seed_is_marked_and_stays():
    text = text_of("", "title", "'x'").replace("seed = 1\n", "").replace("left_out = ['seed']\n", "")
    scene = mcgw.scene_from(text)
    assert scene.left_out == ("seed",)
    again = mcgw.scene_from(mcgw.scene_text(scene))
    assert (again.seed, again.left_out) == (scene.seed, ("seed",))
    assert scene.replace(title="y").seed == scene.seed
    assert scene.replace(seed=5).left_out == ()


def test_the_most_surfaces_of_a_stop_rule_are_not_those_without_it():
    ruled = Scene(surface=SURFACE, separations=(1.0,), rel_err=0.01)
    assert (ruled.n_surfaces, replace(ruled, rel_err=None).n_surfaces) == (10**9, 1000)
    assert replace(ruled, n_surfaces=50).replace(rel_err=None).n_surfaces == 50
    text = mcgw.scene_text(ruled).replace("max_surfaces = 1000000000\n", "")
    assert mcgw.scene_from(text).replace(rel_err=None).n_surfaces == 1000
    with pytest.raises(SceneError, match=r"ensemble\.n_surfaces = 0"):
        Scene(surface=SURFACE, separations=(1.0,), n_surfaces=0)


def test_a_run_goes_on_whoever_gave_the_numbers(tmp_path):
    scene = Scene(surface=SURFACE, separations=(1.0,), n_surfaces=5, seed=LeftOut(7))
    from mcgw.jobs.running import run

    first = run(scene, tmp_path / "e.h5")
    load = first.load.tobytes()
    assert first.scene.left_out == ("n_asperities", "seed")
    assert first.scene.replace(nominal_area=1e-5).n_asperities == 10_000
    given = replace(scene, n_asperities=1000, seed=7, n_surfaces=9)
    assert run(given, tmp_path / "e.h5").load[:5].tobytes() == load


def test_replace_takes_fields_of_scene_and_surface_only():
    scene = Scene(surface=SURFACE, separations=(1.0,))
    every = {f.name for f in fields(Scene)} | SURFACE_UNITS.keys()
    assert every >= {"title", "sigma", "E_star"}
    assert scene.replace(sigma="2 um", title="t", max_seconds="1 min").surface.sigma == 2e-6
    assert scene.replace(max_seconds="1 min").max_seconds == 60
    assert scene.replace(surface=LARGE, sigma=3e-6).surface == replace(LARGE, sigma=3e-6)
    with pytest.raises(TypeError):
        scene.replace(sigam=1.0)
    with pytest.raises(ValueError, match=r"^surface\.sigma = '2 N': give a finite number > 0"):
        scene.replace(sigma="2 N")


# --- units that are doubted ----------------------------------------------------------------------------

DOUBTED = {
    "E_star": (50.0, "surface.E_star = 50: 50 Pa is softer than any gel; did you mean 50 GPa = 5e+10?"),
    "sigma": (
        0.8,
        "surface.sigma = 0.8: 0.8 m is higher than the summits of any ground surface; did you mean 0.8",
    ),
    "eta": (
        300.0,
        "surface.eta = 300: 300 1/m^2 is less than a summit a square centimetre; did you mean 300/",
    ),
    "radius": (13.0, "surface.radius = 13: 13 m is not a radius of a summit; did you mean 13 um = 1.3e-05?"),
    "nominal_area": (
        100.0,
        "surface.nominal_area = 100: 100 m^2 is larger than two bodies in contact; did you",
    ),
}


@pytest.mark.parametrize("key", RANGES)
def test_a_value_in_another_unit_is_asked_about_in_one_line(key):
    value, asked = DOUBTED[key]
    scene = Scene(surface=replace(SURFACE, **{key: value}), separations=(1.0,), n_asperities=100)
    (line,) = perhaps_other_units(scene)
    assert line.startswith(asked)
    assert len(line) < 150
    tiny = Scene(surface=replace(SURFACE, **{key: RANGES[key].low / 2}), separations=(1.0,), n_asperities=100)
    (line,) = perhaps_other_units(tiny)
    assert line.startswith(f"surface.{key} = ")


def test_every_key_of_the_surface_has_a_range():
    assert RANGES.keys() == SURFACE_UNITS.keys() == DOUBTED.keys()


def test_separations_in_metres_are_asked_about():
    scene = Scene(surface=SURFACE, separations=(0.0, 1e-6, 2e-6))
    (line,) = perhaps_other_units(scene)
    assert "did you mean 2e-06 m = 2 sigma?" in line
    assert perhaps_other_units(replace(scene, separations=(0.0,))) == []
    assert perhaps_other_units(replace(scene, separations=(1e-6, 1.0))) == []


@pytest.mark.parametrize(
    "path", sorted((Path(__file__).parent.parent).glob("**/*.toml")), ids=lambda p: p.name
)
def test_no_scene_of_ours_is_doubted(path):
    if "[surface]" in path.read_text():
        assert perhaps_other_units(mcgw.load_scene(path)) == []

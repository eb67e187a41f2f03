"""Sixty inputs and what each must get: works, fails in one line that names it, or degrades as stated."""

import os
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from said import call

import analytic
import mcgw
from mcgw.errors import StoreError
from mcgw.formats.files import check_output
from mcgw.jobs.disk_space import check_space
from mcgw.jobs.job import Job
from mcgw.jobs.running import run
from mcgw.machine.memory import memory_available
from mcgw.scene.cautions import cautions
from mcgw.scene.scene import SceneError

GOOD = """
title = "table"
[surface]
sigma = 1e-6
radius = 1e-5
eta = 1e9
nominal_area = 1e-6
E_star = 1e11
[contact]
separations = [0.0, 2.0]
[ensemble]
n_surfaces = 10
seed = 5
"""
TESTS = Path(__file__).parent


def changed(old, new):
    assert old in GOOD
    return GOOD.replace(old, new)


def put(section, line):
    return GOOD.replace(f"[{section}]", f"[{section}]\n{line}")


def separations(text):
    return changed("[0.0, 2.0]", text)


# Row, text of a scene, what its error must say: the key, and what would do.
WRONG = [
    *((3, separations(f"[0.0, {x}]"), "contact.separations") for x in ("nan", "inf", "-inf", "1e400")),
    (7, separations("[]"), "give at least one separation"),
    (9, separations("[[1.0], [2.0]]"), "contact.separations"),
    (9, separations('[1.0, "a", true]'), "contact.separations"),
    (9, separations('"0 1 2"'), "contact.separations"),
    (10, separations("{start = 0, stop = 4, num = 1000000}"), "at most 100000"),
    (25, separations("[1.0, -5e-324]"), "contact.separations: -4.94066e-324 is too close to 0"),
    (11, put("ensemble", "n_asperities = 0"), "ensemble.n_asperities = 0"),
    (11, put("ensemble", "n_asperities = -3"), "ensemble.n_asperities = -3"),
    (14, put("ensemble", "n_asperities = 9007199254740993"), "between 1 and 2^53"),
    (14, put("ensemble", "n_asperities = 99999999999999999999"), "between 1 and 2^53"),
    (15, put("ensemble", "n_asperities = 1.5e0"), "give a whole number"),
    (16, put("ensemble", "n_asperities = true"), "give a whole number"),
    (17, put("ensemble", 'n_asperities = "1000"'), "give a whole number"),
    (18, changed("n_surfaces = 10", "n_surfaces = 0"), "ensemble.n_surfaces = 0"),
    (18, changed("n_surfaces = 10", "n_surfaces = -1"), "ensemble.n_surfaces = -1"),
    *((23, changed("sigma = 1e-6", f"sigma = {x}"), "surface.sigma") for x in ("0", "-1.0", "nan", "inf")),
    *((23, changed("radius = 1e-5", f"radius = {x}"), "surface.radius") for x in ("0.0", "-1", "nan", "inf")),
    (25, changed("sigma = 1e-6", "sigma = 1e-320"), "beyond double precision"),
    (25, changed("E_star = 1e11", "E_star = 1e308"), "beyond double precision"),
    *((27, changed("E_star = 1e11", f"E_star = {x}"), "surface.E_star") for x in ("0.0", "-1.0", "nan")),
    (28, GOOD + '[grading]\nlaw = "table"\ns = [0.0, 9.0]\nratio = [1.0, -1.0]', "negative from s = 4.5"),
    *((30, GOOD + f"[grading]\ngamma = {x}", "grading.gamma") for x in ("nan", "inf", "-0.5")),
    *((31, changed("seed = 5", f"seed = {x}"), "ensemble.seed") for x in ("-1", "1.5", '"a"', str(2**64))),
    (32, changed("sigma = 1e-6", "sigam = 1e-6"), "surface.sigam: unknown key; did you mean sigma?"),
    (33, put("surface", "sigma = 2e-6"), "not a TOML scene"),
    (33, GOOD + "[surface]\n", "not a TOML scene"),
    (34, "", "surface.sigma: missing"),
    (34, changed("[contact]", "[contatc]"), "contact.separations: missing"),
    (35, b"\xef\xbb\xbf" + GOOD.encode(), "not a TOML scene"),
    (35, GOOD.encode() + b"\0", "not a TOML scene"),
    (35, GOOD.encode("utf-16"), "not a TOML scene"),
    (35, bytes(range(256)), "not a TOML scene"),
    (37, put("ensemble", f"n_asperities = {'9' * 5000}"), "not a TOML scene"),
    (37, changed("sigma = 1e-6", f"sigma = {10**400}"), "surface.sigma"),
    (38, separations("[" * 5000 + "]" * 5000), "not a TOML scene"),
    (39, changed("sigma = 1e-6", "sigma = 2026-11-21"), "surface.sigma"),
    (39, separations("[2026-11-21]"), "contact.separations"),
]


@pytest.mark.parametrize(("row", "text", "message"), WRONG)
def test_rows_that_are_refused(row, text, message):
    with pytest.raises(SceneError) as caught:
        mcgw.scene_from(text)
    assert any(message in line for line in caught.value.problems), caught.value.problems
    assert all("\n" not in line and len(line) < 300 for line in caught.value.problems)


@pytest.fixture
def make(make_scene):
    return make_scene


def load_share(scene):
    """Load in units of what one asperity carries at unit approach, a surface and asperity."""
    unit = analytic.QUANTITIES["load"].scale(scene.surface)
    return mcgw.simulate(scene).load / (unit * scene.n_asperities)


def test_row_1_all_touch(make):
    scene = make(separations=(-40.0,), grading=analytic.Homogeneous(), n_surfaces=50)
    share = load_share(scene)
    error = share.std() / np.sqrt(share.size)
    assert abs(share.mean() - 253.042) < 5 * error + 5e-4  # the last digit of the reference
    ensemble = mcgw.simulate(scene)
    assert (ensemble.contacts == scene.n_asperities).all()


def test_row_2_nothing_touches(make):
    ensemble = mcgw.simulate(make(separations=(38.6, 40.0, 1e3)))
    for name in ensemble.scene.quantities:
        assert not ensemble.values(name).any()
        assert not ensemble.stderr(name).any()
    assert np.isfinite(analytic.fn(1.5, 40.0, log=True))


def test_row_4_negative_zero(make):
    a, b = (mcgw.simulate(make(separations=(h, 1.0), n_surfaces=5)).load for h in (0.0, -0.0))
    assert a.tobytes() == b.tobytes()


def test_row_5_unsorted(make):
    ensemble = mcgw.simulate(make(separations=(2.0, 0.0, 1.0), n_surfaces=5))
    np.testing.assert_array_equal(ensemble.separations, [2.0, 0.0, 1.0])
    assert (np.argsort(-ensemble.load, axis=1) == [1, 2, 0]).all()


def test_row_6_repeated(make):
    load = mcgw.simulate(make(separations=(1.0, 2.0, 1.0), n_surfaces=5)).load
    np.testing.assert_array_equal(load[:, 0], load[:, 2])


def test_row_8_one_number(make):
    assert mcgw.simulate(mcgw.scene_from(separations("1.0"))).load.shape == (10, 1)


def test_row_12_one_asperity(make):
    ensemble = mcgw.simulate(make(n_asperities=1, separations=(0.0, 1.0)))
    assert set(np.unique(ensemble.contacts)) == {0, 1}


def test_row_13_many_asperities(make):
    """Far up, where few touch, drawn one by one; with aggregated cells anywhere."""
    for change in ({"separations": (6.5,)}, {"separations": (1.0,), "sampler": "aggregate"}):
        scene = make(n_asperities=10**12, n_surfaces=3, **change)
        contacts = mcgw.simulate(scene).contacts
        expected = 10**12 * float(scene.heights.above(np.array(scene.lowest)))
        assert (np.abs(contacts - expected) < 6 * np.sqrt(expected)).all()


def test_row_15_whole_floats(make):
    assert mcgw.scene_from(put("ensemble", "n_asperities = 1e6")).n_asperities == 10**6


def test_row_19_one_surface(make):
    ensemble = mcgw.simulate(make(n_surfaces=1))
    assert np.isnan(ensemble.std("load")).all()
    assert np.isnan(ensemble.stderr("load")).all()
    assert np.isfinite(ensemble.mean("load")).all()


def test_row_20_beyond_64_bits(make, tmp_path):
    scene = make(n_surfaces=10**12, n_asperities=10**8, separations=(6.0,))
    with pytest.raises(StoreError, match=r"n_surfaces \* n_asperities = 1e\+20 is more than 2\^63 - 1"):
        run(scene, tmp_path / "e.h5")
    assert not list(tmp_path.iterdir())


def test_row_21_more_asperities_than_memory(make, tmp_path):
    scene = make(n_surfaces=4, n_asperities=memory_available() // 8, separations=(4.0,), sampler="aggregate")
    assert run(scene, tmp_path / "e.h5").n_surfaces == 4
    with pytest.raises(ValueError, match=r"the heights of one surface needs .* GiB of memory and .* GiB are"):
        mcgw.heights(replace(scene, sampler="cells"), 0, untouched=True)
    with pytest.raises(StoreError, match=r"a block of 4 surfaces needs .* GiB of memory"):
        check_space(scene, tmp_path / "e.h5", rows=4, columns=memory_available())


def test_row_22_more_than_the_disk(make, tmp_path):
    scene = make(n_surfaces=10**12, n_asperities=1000, separations=(3.0,))
    with pytest.raises(StoreError, match=r"needs up to .* GiB more on the disk while made and .* are free"):
        run(scene, tmp_path / "e.h5")
    assert not list(tmp_path.iterdir())


def test_row_24_units(make):
    """Lengths of 1 nm ... 1 mm: powers of two change no bit of the sums in units of one asperity."""
    base = make(n_surfaces=5)
    s = base.surface
    for scale in (2.0**-10, 2.0**10):
        values = (s.sigma * scale, s.radius * scale, s.eta / scale**2, s.nominal_area * scale**2, s.E_star)
        other = replace(base, surface=analytic.Surface(*values))
        np.testing.assert_array_equal(load_share(base), load_share(other))


def test_row_26_beyond_hertz(make):
    surface = analytic.Surface(sigma=2e-5, radius=1e-5, eta=1e8, nominal_area=1e-6, E_star=1e9)
    start = "surface.radius = 1e-05 m: at d/sigma = 0 a share of 0.62 of the contacts"
    assert any(line.startswith(start) for line in cautions(make(surface=surface, n_surfaces=2)))
    assert not any("compressed by more" in line for line in cautions(make()))


def test_row_28_grading_that_is_not_finite(make):
    bad = analytic.Custom(lambda s: np.where(s > 1, np.nan, 1.0))
    with pytest.raises((SceneError, ValueError), match=r"not finite at s = 1"):
        make(grading=bad)


def test_row_29_grading_that_fails(make):
    def broken(s):
        raise ValueError("no data above 2 sigma")

    with pytest.raises((SceneError, ValueError), match="no data above 2 sigma"):
        make(grading=analytic.Custom(broken))


def test_row_30_extreme_gamma(make):
    for gamma in (1e300, 1e308):  # the sums of stiffness, or all, would be infinite
        with pytest.raises(SceneError, match=r"grading.gamma = 1e\+30\d: .* leave double precision"):
            make(grading=analytic.Exponential(gamma))
    for gamma in (0.0, 1e-300, 1e280):
        ensemble = mcgw.simulate(make(grading=analytic.Exponential(gamma), n_surfaces=3))
        assert np.isfinite(ensemble.load).all()


def test_row_31_seed_zero(make):
    assert mcgw.scene_from(changed("seed = 5", "seed = 0")).seed == 0


def test_row_36_ways_to_write_numbers(make):
    text = put("ensemble", "n_asperities = 1_000").replace("seed = 5", "seed = 0x10")
    scene = mcgw.scene_from(text.replace("\n", "\r\n").encode())
    assert (scene.n_asperities, scene.seed) == (1000, 16)


def test_row_38_too_long(make, tmp_path):
    (tmp_path / "long.toml").write_text(GOOD + "#" * 2**21)
    with pytest.raises(SceneError, match="longer than 2097152 bytes"):
        mcgw.load_scene(tmp_path / "long.toml")


def test_row_40_names_that_are_none(make, tmp_path):
    for name in ("..", "a\0b", "x" * 300, "a\nb"):
        with pytest.raises(StoreError):
            run(make(n_surfaces=2), tmp_path / name)
    with pytest.raises(StoreError, match="is not a name for a file"):
        run(make(n_surfaces=2), "")
    assert not list(tmp_path.iterdir())


def test_row_41_output_that_is_a_link(make, tmp_path):
    victim = tmp_path / "victim"
    victim.write_bytes(b"precious")
    (tmp_path / "e.h5").symlink_to(victim)
    with pytest.raises(StoreError, match="is not a regular file"):
        run(make(n_surfaces=2), tmp_path / "e.h5")
    assert victim.read_bytes() == b"precious"


def test_row_43_inputs_that_are_no_files(make, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, Path("/dev/zero")):
        with pytest.raises(SceneError, match="is not a regular file"):
            mcgw.load_scene(path)
        with pytest.raises(StoreError, match=r"is not a regular file|Is a directory"):
            mcgw.open_ensemble(path)


def test_row_44_folders_that_are_none(make, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(StoreError, match=r"cannot be written|Not a directory"):
        run(make(n_surfaces=2), tmp_path / "file" / "e.h5")
    folder = tmp_path / "closed"
    folder.mkdir(mode=0o500)
    if not os.access(folder, os.W_OK):  # the superuser may write anywhere
        with pytest.raises(StoreError, match="read-only"):
            check_output(folder / "e.h5")
    with pytest.raises(StoreError, match=r"0 GiB are free|cannot be written"):
        run(make(n_surfaces=2), "/proc/e.h5")


def test_row_55_threads(make, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(GOOD)
    words = ["run", scene, "-o", tmp_path / "e.h5", "--threads"]
    for bad in ("0", "max"):
        assert call(*words, bad).returncode == 2
        assert not (tmp_path / "e.h5").exists()
    done = call(*words, "1000")
    assert done.returncode == 0
    assert "note: --threads 1000: this machine has" in done.stderr


def test_row_56_block_sizes(make, tmp_path, monkeypatch):
    scene, found = make(n_surfaces=23, sampler="tail", separations=(2.0, 3.0)), set()
    for size in (7, 23, 1000):
        monkeypatch.setattr(Job, "rows", size)
        run(scene, tmp_path / f"{size}.h5")
        with h5py.File(tmp_path / f"{size}.h5") as file:
            found.add(file.attrs["digest"])
    assert len(found) == 1


def test_row_58_clocks(make, tmp_path, monkeypatch):
    found = []
    for date in ("1970-01-01T00:00:00+00:00", "2038-01-20T00:00:00+00:00"):
        monkeypatch.setattr("mcgw.store.layout.now", lambda date=date: date)
        run(make(n_surfaces=3), tmp_path / f"{len(found)}.h5")
        with h5py.File(tmp_path / f"{len(found)}.h5") as file:
            assert file.attrs["date"] == date
            found.append(file.attrs["digest"])
    assert found[0] == found[1]


ELSEWHERE = {
    42: ("test_store_shards.py", "test_a_planted_link_is_replaced_not_followed"),
    45: ("test_store_runs.py", "test_another_scene_or_seed_in_that_place_is_refused"),
    46: ("test_store_runs.py", "test_two_drivers"),
    47: ("test_store_runs.py", "test_damage_is_put_aside_and_drawn_again"),
    48: ("test_store_runs.py", "test_damage_is_put_aside_and_drawn_again"),
    49: ("test_input_files.py", "test_hostile_files_are_refused"),
    50: ("test_input_files.py", "test_hostile_files_are_refused"),
    51: ("test_input_files.py", "test_hostile_files_are_refused"),
    52: ("test_input_files.py", "test_hostile_files_are_refused"),
    53: ("test_store_shards.py", "test_numbers_that_are_not_finite_are_never_committed"),
    54: ("test_input_files.py", "test_other_formats_are_named"),
    57: ("test_store_runs.py", "test_signals_stop_a_run_that_then_goes_on"),
    59: ("test_store_runs.py", "test_the_folder_of_a_run_vanishes"),
    60: ("test_engines.py", "test_addresses_that_are_not"),
}


def test_no_row_is_left_out():
    here = {int(name.split("_")[2]) for name in globals() if name.startswith("test_row_")}
    assert {row for row, _, _ in WRONG} | here | set(ELSEWHERE) == set(range(1, 61))
    for file, name in ELSEWHERE.values():
        assert f"def {name}(" in (TESTS / file).read_text()

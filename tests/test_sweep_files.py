"""Sweeps in files: whole or not at all, the same bits wherever they were interrupted, and drawn once."""

import os
import signal
import subprocess
import sys
import time

import h5py
import numpy as np
import pytest

import mcgw
from mcgw.cli import main
from mcgw.sweeps import chunk_task, drawing
from mcgw.sweeps.file import read_attributes
from mcgw.sweeps.folder import folder_of

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(SURFACE, separations=[0.0, 1.0, 2.5], n_surfaces=300, n_asperities=2000, seed=7)
GAMMA, N = "grading.gamma", "ensemble.n_asperities"
OVER = {GAMMA: np.linspace(0.5, 1.7, 9), N: [200, 2000]}
TOML = """
surface = {sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11}
contact = {separations = [0.0, 1.0]}
ensemble = {n_surfaces = 40, n_asperities = 300}
"""


def digest(path):
    return read_attributes(path)["digest"]


@pytest.fixture
def chunks(monkeypatch):
    """Chunks of few surfaces: six for each group."""
    monkeypatch.setattr(drawing, "_ROWS", 50)


def test_a_file_has_the_bits_of_memory(tmp_path):
    tables = [mcgw.Table((-1, k, 6), (1.0, 1.5, 3.0)) for k in (0.33, 0.7)]
    for over in (OVER, {"grading": tables, "surface.E_star": ["70 GPa", 8e10]}):
        path = tmp_path / f"{len(over)}-{'grading' in over}.h5"
        held, memory = mcgw.sweep(SCENE, over, path=path), mcgw.sweep(SCENE, over)
        opened = mcgw.open_sweep(path)
        for sweep in (held, opened):
            for name in memory.quantities:
                assert np.array_equal(sweep.mean(name), memory.mean(name))
                assert np.array_equal(sweep.std(name), memory.std(name))
            assert list(sweep.scenes) == list(memory.scenes)
            assert repr(sweep) == repr(memory)
            assert sweep.to_xarray().identical(memory.to_xarray())
        last = tuple(n - 1 for n in memory.shape)
        found, other = (x.difference("load", (0, 0), (last[0], 0)) for x in (opened, memory))
        assert np.array_equal(found.stderr, other.stderr)
        assert not (tmp_path / f"{path.name}.parts").exists()


def test_other_programs_read_it(tmp_path):
    import xarray

    sweep = mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5")
    with xarray.open_dataset(tmp_path / "a.h5", engine="h5netcdf") as data:
        assert data.load_std.dims == ("point", "separation")
        assert np.array_equal(data.load_std.values.reshape(9, 2, 3), sweep.std("load"))
        assert data[N].values.tolist() == [200, 2000] * 9
        assert data.attrs["filetype"] == "mcgw-sweep"


def test_again_draws_nothing(tmp_path, monkeypatch):
    mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5")
    written = (tmp_path / "a.h5").read_bytes()

    def never(*_):
        raise AssertionError("drawn again")

    monkeypatch.setattr(chunk_task, "shared", never)
    mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5", threads=1)
    assert (tmp_path / "a.h5").read_bytes() == written
    with pytest.raises(AssertionError, match="drawn again"):  # so it would have shown
        mcgw.sweep(SCENE, OVER, path=tmp_path / "b.h5")


def committed(path, number):
    """The shards, once there are so many: the last chunk may still be on its way to the disk."""
    until = time.monotonic() + 30
    while len(shards := sorted(folder_of(path).glob("block-*.h5"))) < number and time.monotonic() < until:
        time.sleep(0.01)
    assert len(shards) == number
    return shards


@pytest.mark.parametrize("after", [1, 5, 6, 11])
def test_interrupted_anywhere_it_goes_on_to_the_same_digest(tmp_path, monkeypatch, chunks, after):
    mcgw.sweep(SCENE, OVER, path=tmp_path / "whole.h5")
    drawn = []
    plain = chunk_task.pooled_chunk

    def stopped(group, source, chunk):
        if len(drawn) == after:
            raise KeyboardInterrupt
        drawn.append(chunk.number)
        return plain(group, source, chunk)

    monkeypatch.setattr(chunk_task, "pooled_chunk", stopped)
    path = tmp_path / "a.h5"
    with pytest.raises(KeyboardInterrupt):
        mcgw.sweep(SCENE, OVER, path=path)
    assert not path.exists()
    shards = committed(path, after)
    data = bytearray(shards[0].read_bytes())
    data[len(data) // 2] ^= 1
    shards[0].write_bytes(bytes(data))  # a damaged one is drawn again
    after = 99
    mcgw.sweep(SCENE, OVER, path=path, threads=1)
    assert drawn == [*range(len(shards)), 0, *range(len(shards), 12)]
    assert digest(path) == digest(tmp_path / "whole.h5")
    assert not (tmp_path / "a.h5.parts").exists()


SWEEPING = """
import sys, numpy as np
import mcgw
from mcgw.sweeps import drawing
drawing._ROWS = 20
scene = mcgw.scene_from(open(sys.argv[1]).read())
over = {"grading.gamma": np.linspace(0.5, 1.7, 9), "ensemble.n_asperities": [200, 2000]}
mcgw.sweep(scene.replace(n_surfaces=20), over)  # so that loops are loaded
print("begun", flush=True)
mcgw.sweep(scene, over, path="a.h5")
"""


def test_killed_at_random_moments(tmp_path, monkeypatch):
    monkeypatch.setattr(drawing, "_ROWS", 20)
    mcgw.sweep(SCENE, OVER, path=tmp_path / "whole.h5")
    (tmp_path / "s.toml").write_text(mcgw.scene_text(SCENE))
    random, kills = np.random.default_rng(3), 0
    while not (tmp_path / "a.h5").exists():
        call = [sys.executable, "-c", SWEEPING, "s.toml"]
        with subprocess.Popen(call, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as child:
            child.stdout.readline()
            time.sleep(random.uniform(0.0, 0.2 + 0.1 * kills))
            child.send_signal(signal.SIGTERM if kills % 2 else signal.SIGKILL)
        kills += child.returncode != 0
    assert kills
    assert digest(tmp_path / "a.h5") == digest(tmp_path / "whole.h5")
    mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5")
    assert not list(tmp_path.glob("*.parts"))


def test_another_sweep_is_left_alone(tmp_path, monkeypatch):
    mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5")
    for scene, over in ((SCENE, {GAMMA: [1.0]}), (SCENE.replace(seed=8), OVER)):
        with pytest.raises(mcgw.StoreError, match=r"a\.h5: holds a different sweep; choose another -o"):
            mcgw.sweep(scene, over, path=tmp_path / "a.h5")
    e = mcgw.simulate(SCENE, n_surfaces=3)
    mcgw.save(e, tmp_path / "e.h5")
    with pytest.raises(mcgw.StoreError, match="not the file of a sweep"):
        mcgw.sweep(SCENE, OVER, path=tmp_path / "e.h5")
    with pytest.raises(mcgw.StoreError, match="not an ensemble file"):
        mcgw.open_ensemble(tmp_path / "a.h5")

    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(chunk_task, "pooled_chunk", stopped)
    with pytest.raises(KeyboardInterrupt):
        mcgw.sweep(SCENE, OVER, path=tmp_path / "b.h5")
    with pytest.raises(mcgw.StoreError, match="a different sweep was begun there"):
        mcgw.sweep(SCENE, {GAMMA: [1.0]}, path=tmp_path / "b.h5")


def test_a_seed_that_nobody_gave_is_that_of_the_file(tmp_path):
    scene = mcgw.Scene(SURFACE, separations=[0.0], n_surfaces=5)
    first = mcgw.sweep(scene, {GAMMA: [1.0, 2.0]}, path=tmp_path / "a.h5")
    other = mcgw.Scene(SURFACE, separations=[0.0], n_surfaces=5)
    again = mcgw.sweep(other, {GAMMA: [1.0, 2.0]}, path=tmp_path / "a.h5")
    assert again.scenes[0].seed == first.scenes[0].seed == scene.seed != other.seed


@pytest.mark.parametrize("share", [0.02, 0.3, 0.6, 0.9, 0.999])
def test_damage_is_found(tmp_path, capsys, share):
    path = tmp_path / "a.h5"
    mcgw.sweep(SCENE, OVER, path=path)
    assert main(["show", str(path), "--verify"]) == 0
    data = bytearray(path.read_bytes())
    data[int(share * len(data))] ^= 4
    path.write_bytes(bytes(data))
    assert main(["show", str(path), "--verify"]) in (1, 2)
    assert "a.h5" in "".join(capsys.readouterr())


def test_values_that_were_changed_with_care_are_found(tmp_path):
    path = tmp_path / "a.h5"
    mcgw.sweep(SCENE, OVER, path=path)
    with h5py.File(path, "r+") as file:
        file["drawn/load_means"][0, 0] *= 2
    with pytest.raises(mcgw.StoreError):
        mcgw.open_sweep(path)


@pytest.fixture
def shell(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(TOML)

    def call(*words, code=0):
        assert main(list(words)) == code
        return capsys.readouterr()

    return call


def test_the_command(shell, tmp_path):
    over = ["--over", f"{GAMMA}=0.5:1.5:3", "--over", f"{N}=200,1e3"]
    plan = shell("sweep", "s.toml", *over, "--plan").out
    assert "6 scenes" in plan
    assert "80, with" in plan
    assert os.listdir(tmp_path) == ["s.toml"]
    assert "out/s.sweep.h5: 6 scenes" in shell("sweep", "s.toml", *over).out
    sweep = mcgw.open_sweep("out/s.sweep.h5")
    assert sweep.axes.values == {GAMMA: (0.5, 1.0, 1.5), N: (200, 1000.0)}
    assert sweep.scene((0, 1)).n_asperities == 1000
    shown = shell("show", "out/s.sweep.h5", "--csv", "t.csv").out
    assert "Sweep of 6 scenes" in shown
    table = np.genfromtxt("t.csv", delimiter=",", names=True)
    assert np.array_equal(table["load_mean"].reshape(3, 2, 2), sweep.mean("load"))
    assert shell("show", "out/s.sweep.h5", "--digest").out.strip() == digest(tmp_path / "out/s.sweep.h5")
    assert mcgw.scene_from(shell("show", "out/s.sweep.h5", "--scene").out).seed == sweep.scenes[0].seed
    assert "intact" in shell("show", "out/s.sweep.h5", "--verify").out


def test_the_command_with_zipped_axes_and_texts(shell):
    over = ["--over", "surface.sigma=1 um,2 um", "--over", "ensemble.count=fixed,poisson"]
    shell("sweep", "s.toml", *over, "--zip", "-o", "z.h5", "--threads", "1")
    sweep = mcgw.open_sweep("z.h5")
    assert sweep.shape == (2,)
    assert (sweep.scene(1).surface.sigma, sweep.scene(1).count) == (2e-6, "poisson")


@pytest.mark.parametrize(
    ("over", "words"),
    [
        ("grading.gamma", "--over grading.gamma: give KEY=VALUES"),
        ("grading.gamma=1:2:0", "0 values; give a whole number"),
        ("grading.gamma=1:2:2.5", "2.5 values; give a whole number"),
        ("grading.gama=1,2", "grading.gama: unknown key"),
        ("contact.separations=1", "all points have the same"),
        ("surface.sigma=1 kg", "surface.sigma = '1 kg'"),
    ],
)
def test_mistakes_of_the_command(shell, over, words):
    assert words in shell("sweep", "s.toml", "--over", over, code=2).err


def test_a_disk_that_is_full(tmp_path, monkeypatch):
    from mcgw.sweeps import folder

    def full(*_):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(folder, "commit_shard", full)
        with pytest.raises(mcgw.RunError, match="No space left on device; what is done is kept in"):
            mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5")
    assert not (tmp_path / "a.h5").exists()
    assert mcgw.sweep(SCENE, OVER, path=tmp_path / "a.h5").shape == (9, 2)

"""Inputs made to do harm, of every kind of map and scene: one line each, and nothing outside is read.

The file that hostile HDF5 leads to is a pipe that nobody writes: whoever opens it waits until the test fails.
"""

import json
import os
import random
import subprocess
import sys
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest
from test_gate import HOSTILE

from mcgw.maps import Topography, write_map

SECONDS, BYTES = 2.0, 400 * 2**20
MAP = Topography(1e-6 * np.random.default_rng(1).normal(size=(16, 16)), (1e-6, 1e-6))
WORDS = [
    "1.5", "-2", "nan", "1e999", "9" * 400, "0x10", "x", "", "1,5", "1_0", "\0", "é", "--", "1e-400", "BAD",
]  # fmt: skip
SCENE = (Path(__file__).parents[2] / "runs" / "quick.toml").read_text(encoding="utf-8")


def hdf5(folder, name, dice):
    """A map of ours with one thing in it that leads elsewhere or declares too much; or with bytes changed."""
    path = folder / f"{name}.{dice.choice(['h5', 'nc'])}"
    write_map(MAP, folder / "m.h5")
    os.replace(folder / "m.h5", path)
    if dice.random() < 0.6:
        make = dice.choice(list(HOSTILE.values()))
        with h5py.File(path, "r+") as file:
            del file["height"]
            (folder / "secret").write_bytes(b"correct horse battery staple" * 64)
            make[0](file, folder)
        return
    content = bytearray(path.read_bytes())
    for _ in range(dice.randint(1, 4)):
        content[dice.randrange(len(content))] = dice.randrange(256)
    path.write_bytes(content[: dice.choice([len(content), len(content) - dice.randrange(900)])])


def text(folder, name, dice):
    """Lines of words, some with more or fewer, or very long, or very many."""
    mark, lines = dice.choice([" ", ",", ";", "\t"]), []
    for _ in range(dice.choice([1, 5, 40])):
        number = dice.choice([3, 5, 5, 5, 2000])
        lines.append(mark.join(dice.choice(WORDS) if dice.random() < 0.1 else "0.5" for _ in range(number)))
    heads = ["", "# Width: 1-2 um\n", "x (um) y (um) z (A)\n", "[" * 1000 + "\n", "# Width: 9e999 m\n"]
    head = dice.choice(heads)
    (folder / f"{name}.{dice.choice(['txt', 'csv', 'xyz'])}").write_text(
        head + "\n".join(lines), encoding="utf-8"
    )


def archive(folder, name, dice):
    """What looks like X3P: bombs, entities, members that lie outside, sizes that are not there."""
    entity = '<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]>' if dice.random() < 0.4 else ""
    size = dice.choice(["3", "99999999", "-1", "x"])
    sizes = f"<SizeX>{size}</SizeX><SizeY>{size}</SizeY>"
    main = f"<?xml version='1.0'?>{entity}<p><Record3>{sizes}</Record3>&x;</p>"
    with zipfile.ZipFile(folder / f"{name}.x3p", "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr(dice.choice(["main.xml", "../main.xml"]), main)
        file.writestr(
            dice.choice(["bindata/data.bin", "/etc/mcgw"]), bytes(dice.choice([72, 10**6, 2 * 10**7]))
        )


def sidecar(folder, name, dice):
    """An array whose sidecar is no such thing."""
    np.save(folder / f"{name}.npy", MAP.heights)
    (folder / f"{name}.json").write_text(dice.choice([
        "[" * 10**5, '{"pixel": [' + "9" * 400 + ", 1]}", '{"pixel": [NaN, 1]}', '{"pixel": [1e999, 1]}',
        "{" * 9,
        '{"pixel": ["1", "1"]}', '{"pixel": [1e-6, 1e-6], "unit": "A"}', "\0" * 100, '{"pixel": {"a": 1}}',
    ]))  # fmt: skip


def toml(folder, name, dice):
    """A scene with one word that stops a parser."""
    line = dice.choice([
        "x = " + "[" * 10**5, "a." * 10**5 + "b = 1", "x = 0x" + "f" * 10**5, "x = " + "1" * 10**5,
        "x = " + "{a=" * 5000,
        "x = '''" + "a" * 1000, '"' * 1001, "[" + "a." * 5000 + "b]", "x = 1979-99-99", "x = nan", "\0",
        "sigma = 1e-400",
    ])  # fmt: skip
    before, after = SCENE.split("eta", 1)
    (folder / f"{name}.toml").write_text(before + line + "\neta" + after)


def array(folder, name, dice):
    """An array with bytes of its header changed."""
    np.save(folder / "a.npy", MAP.heights)
    content = bytearray((folder / "a.npy").read_bytes())
    (folder / "a.npy").unlink()
    for _ in range(dice.randint(1, 3)):
        content[dice.randrange(130)] = dice.randrange(256)
    (folder / f"{name}.npy").write_bytes(content)


KINDS = (hdf5, text, archive, sidecar, toml, array)


def check(folder, number, seed):
    dice = random.Random(seed)
    for k in range(number):
        kind = KINDS[k % len(KINDS)]
        kind(folder, f"{kind.__name__}{k}", dice)
    (folder / "secret").unlink(missing_ok=True)
    os.mkfifo(folder / "secret")
    script = Path(__file__).parents[1] / "oracles" / "hostile_maps.py"
    done = subprocess.run(
        [sys.executable, str(script), str(folder)], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    *files, (peak, outside, started) = map(json.loads, done.stdout.splitlines())
    assert len(files) >= number
    for name, said, seconds in files:
        assert len(said.splitlines()) <= 1, name
        assert "Traceback" not in said
        assert seconds < SECONDS, (name, seconds, said)
    assert peak < BYTES
    assert (outside, started) == ([], [])
    refused = sum(bool(said) for _, said, _ in files)
    assert refused > 0.6 * number  # some changed bytes do no harm


def test_some_inputs_made_to_do_harm(tmp_path):
    check(tmp_path, 42, 1)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2, 6))
def test_many_inputs_made_to_do_harm(seed, tmp_path):
    check(tmp_path, 150, seed)

"""Every printed table and every CSV, read as a reader would, against numbers made here."""

import csv
import math
import re

import numpy as np
import pytest
from oracles import exact
from oracles.study_by_hand import made_up

import mcgw
from mcgw.cli import main

pytestmark = pytest.mark.usefixtures("blank_figures")

H = (0.5, 0.0, 2.0, 1.0)
LONG = {  # in no usual order
    "conductance": "contact conductance, times the resistivity rho (m)",
    "load": "normal load (N)",
    "contacts": "number of contacts",
    "area": "real contact area (m^2)",
    "stiffness": "normal stiffness (N/m)",
}
QUANTITIES = tuple(LONG)


@pytest.fixture(scope="module")
def file(make_scene, tmp_path_factory):
    path = tmp_path_factory.mktemp("shown") / "e.h5"
    mcgw.run(make_scene(separations=H, quantities=QUANTITIES, n_surfaces=150, seed=2), path)
    return path


@pytest.fixture(scope="module")
def told(file):
    """By NumPy from the values, by quadrature from the scene."""
    found, ensemble = {}, mcgw.open_ensemble(file)
    for name in QUANTITIES:
        x = ensemble.values(name).astype(float)
        mean, std = x.mean(axis=0), x.std(axis=0, ddof=1)
        theory, spread = (how(ensemble.scene, name) for how in (exact.mean, exact.std))
        found[name] = {
            "d/sigma": np.array(H),
            "mean": mean,
            "std": std,
            "stderr": std / math.sqrt(len(x)),
            "theory": theory,
            "residual": (mean - theory) / (spread / math.sqrt(len(x))),
            "95 % interval": np.transpose(ensemble.interval(name)),
        }
    return found


def out_of(words, capsys):
    assert main([str(w) for w in words]) == 0
    return capsys.readouterr().out


def tables(text):
    """{title: (columns, rows)} of blocks: a title, a line of names, rows of numbers, all indented."""
    found, title = {}, ""
    for line in text.splitlines():
        if line and not line.startswith(" "):
            title = line
        elif title and "d/sigma" in line and title not in found:
            found[title] = (re.split(r" {2,}", line.strip()), [])
        elif title in found and re.match(r"  +-?\d", line):
            found[title][1].append(line.replace(" ... ", "...").split())
    return found


def rows_of(path):
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


COMPARED = "mean low_95 high_95 std theory residual"
TABLES = {"show -v": "mean std stderr", "compare -v -o c.png": COMPARED}


@pytest.mark.parametrize("words", TABLES)
def test_every_number_of_tables_and_files(words, file, told, capsys, in_tmp_path):
    """Means and their ends to the second digit of an error, a little wrong itself; in files all digits."""
    command, *options = words.split()
    found = tables(out_of([command, file, *options, "--csv", "x.csv"], capsys))
    assert list(found)[-len(QUANTITIES) :] == [LONG[name] for name in QUANTITIES]
    for name in QUANTITIES:
        header, rows = found[LONG[name]]
        columns = TABLES[words].replace("low_95 high_95", "95_%_interval").split()
        assert header == ["d/sigma", *(column.replace("_", " ") for column in columns)]
        for k, row in enumerate(rows):
            for column, text in zip(header, row, strict=True):
                seen = {"abs": 0.07 * told[name]["stderr"][k]}
                seen = {"std": {"rel": 6e-3}, "stderr": {"rel": 6e-3}, "residual": {"abs": 6e-3}}.get(
                    column, seen
                )
                numbers = np.array(text.split("..."), dtype=float)
                assert numbers == pytest.approx(np.ravel(told[name][column][k]), **seen), (name, column)
        assert len(rows) == len(H)
    rows = rows_of(in_tmp_path / "x.csv")
    assert list(rows[0]) == ["quantity", "unit", "separation", *TABLES[words].split()]
    for row, (name, k) in zip(rows, ((n, k) for n in QUANTITIES for k in range(len(H))), strict=True):
        assert (row.pop("quantity"), row.pop("unit")) == (name, exact.UNITS[name])
        wanted = {column: values[k] for column, values in told[name].items()}
        wanted["separation"], (wanted["low_95"], wanted["high_95"]) = H[k], wanted["95 % interval"]
        for column, text in row.items():
            assert float(text) == pytest.approx(wanted[column], rel=1e-7, abs=1e-6), (name, column)


def test_tradeoff(make_scene, tmp_path, capsys, monkeypatch):
    """Files hold what was measured and what is advised, in full; the terminal says the same in short."""
    study = made_up(make_scene(quantities=("load",), separations=(2.0,)))
    (tmp_path / "s.toml").write_text(mcgw.scene_text(study.scene))
    monkeypatch.setattr("mcgw.statistics.tradeoff.tradeoff", lambda scene, *, seconds: study)
    said = out_of(["tradeoff", tmp_path / "s.toml", "-o", tmp_path, "-v"], capsys)
    assert "The mean load needs no surfaces: 0.5 ms" in said
    assert f"{tmp_path / 's-tradeoff.csv'}: what to run for each error (12 s)" in said
    rows = rows_of(tmp_path / "s-tradeoff.csv")
    assert [row["way"] for row in rows[:6]] == ["theory"] * 6
    assert {row["way"] for row in rows if row["want"] == "standard deviation"} == {"none"}
    for row, p in zip(rows_of(tmp_path / "s-tradeoff-measured.csv"), study.points, strict=True):
        assert (row["way"], row["want"], int(row["n_surfaces"])) == (p.way, p.want, p.n_surfaces)
        for key in ("rms", "stderr", "bias", "seconds", "repeats"):
            assert float(row[key]) == getattr(p, key)


def test_run_says_how_many_and_what_is_not_known(make_scene, tmp_path, capsys):
    asked = make_scene(rel_err=1e-3, quantities=QUANTITIES, n_surfaces=70, separations=(0.0, 9.0))
    (tmp_path / "s.toml").write_text(mcgw.scene_text(asked))
    out = out_of(["run", tmp_path / "s.toml", "-o", tmp_path / "e.h5"], capsys)
    ensemble = mcgw.open_ensemble(tmp_path / "e.h5")
    told, unit = re.search(r"forecast: about 70 surfaces, (\S+) (ms|s); ", out).groups()
    assert 0 < float(told) * {"ms": 1e-3, "s": 1.0}[unit] < 60
    assert f"{tmp_path / 'e.h5'}: 70 surfaces of 3000 asperities, seed 1" in out
    limit = -math.log(0.05) / 70
    assert f"d/sigma = 9: no contact in 70 surfaces, mean below {limit:.3g} contacts per surface" in out
    assert f"{limit / 3000:.3g} per asperity" in out
    known = re.findall(r"(\w+) at d/sigma = 0 has a relative error of (\S+), not 0.001", out)
    assert [name for name, _ in known] == list(QUANTITIES)
    for name, width in known:
        _, high = ensemble.interval(name)
        assert float(width) == pytest.approx(high[0] / ensemble.mean(name)[0] - 1, rel=0.06)

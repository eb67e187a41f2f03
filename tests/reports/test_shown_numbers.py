"""Every printed table and every CSV, read as a reader would, against numbers made here."""

import csv
import math
import re

import numpy as np
import pytest
from oracles import exact
from scipy.stats import t as student

import mcgw
from mcgw import run
from mcgw.cli import main

pytestmark = pytest.mark.usefixtures("blank_figures")

QUANTITIES = ("conductance", "load", "contacts", "area", "stiffness")  # in no usual order
H = (0.5, 0.0, 2.0, 1.0)
LONG = {
    "load": "normal load (N)",
    "area": "real contact area (m^2)",
    "stiffness": "normal stiffness (N/m)",
    "contacts": "number of contacts",
    "conductance": "contact conductance, times the resistivity rho (m)",
}
TITLES = {name: LONG[name].partition(" (")[0] for name in LONG}


@pytest.fixture(scope="module")
def file(make_scene, tmp_path_factory):
    scene = make_scene(separations=H, quantities=QUANTITIES, n_surfaces=150, seed=2)
    path = tmp_path_factory.mktemp("shown") / "e.h5"
    run(scene, path)
    return path


@pytest.fixture(scope="module")
def scene(file):
    return mcgw.open_ensemble(file).scene


@pytest.fixture(scope="module")
def told(file, scene):
    """By NumPy from the values, by quadrature from the scene."""
    found = {}
    for name in QUANTITIES:
        x = mcgw.open_ensemble(file).values(name).astype(float)
        m = len(x)
        mean, std = x.mean(axis=0), x.std(axis=0, ddof=1)
        theory, spread = exact.mean(scene, name), exact.std(scene, name)
        found[name] = {
            "d/sigma": np.array(H),
            "separation": np.array(H),
            "mean": mean,
            "Monte Carlo": mean,
            "std": std,
            "stderr": std / math.sqrt(m),
            "theory": theory,
            "residual": (mean - theory) / (spread / math.sqrt(m)),
            "interval": mcgw.open_ensemble(file).interval(name),
        }
    return found


def out_of(words, capsys, code=0):
    assert main([str(w) for w in words]) == code
    return capsys.readouterr().out


def tables(text):
    """{title: {column: values}} of blocks: a title, a line of names, rows of numbers, all indented."""
    found, title = {}, ""
    for line in text.splitlines():
        if line and not line.startswith(" "):
            title = line
        elif title and "d/sigma" in line and title not in found:
            found[title] = (re.split(r" {2,}", line.strip()), [])
        elif title in found and re.match(r"  +-?\d", line):
            numbers = line.replace(" ... ", "...").split()
            found[title][1].append(numbers)
    return found


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as opened:
        return list(csv.DictReader(opened))


def check_csv(path, told, columns):
    """Every row of every quantity: its name, its unit and each column."""
    rows = rows_of(path)
    assert list(rows[0]) == ["quantity", "unit", "separation", *columns]
    assert [(r["quantity"], float(r["separation"])) for r in rows] == [(n, h) for n in QUANTITIES for h in H]
    for row in rows:
        name, k = row["quantity"], H.index(float(row["separation"]))
        assert row["unit"] == exact.UNITS[name]
        for column in set(columns) - {"low_95", "high_95"}:
            assert float(row[column]) == pytest.approx(told[name][column][k], rel=1e-7, abs=1e-6), row
        for column, end in zip(("low_95", "high_95"), told[name]["interval"], strict=True):
            assert column not in columns or float(row[column]) == pytest.approx(end[k], rel=1e-7)


def test_show(file, scene, told, tmp_path, capsys):
    lines = out_of(["show", file], capsys).splitlines()
    at = next(k for k, line in enumerate(lines) if line.split()[:1] == ["d/sigma"])
    brief = np.array([line.split() for line in lines[at + 1 : at + 1 + len(H)]], dtype=float)
    wanted = np.column_stack([H, *(told[name]["mean"] for name in QUANTITIES)])
    assert np.all(
        np.abs(brief - wanted)[:, 1:] <= 0.06 * np.column_stack([x["stderr"] for x in told.values()])
    )
    out = out_of(["show", file, "-v", "--csv", tmp_path / "s.csv"], capsys)
    check_csv(tmp_path / "s.csv", told, ["mean", "std", "stderr"])
    assert f"  surfaces      150 of {scene.n_asperities} asperities each (fixed)" in out
    assert "  separations   4 from 0 to 2 (d/sigma)" in out
    assert "seed 2" in out
    assert "  complete      yes" in out
    found = tables(out)
    assert list(found)[-5:] == [LONG[name] for name in QUANTITIES]
    for name in QUANTITIES:
        header, rows = found[LONG[name]]
        assert header == ["d/sigma", "mean", "std", "stderr"]
        for k, column in enumerate(header):
            shown = [float(row[k]) for row in rows]
            rtol, atol = (0, 0.06 * told[name]["stderr"]) if column == "mean" else (6e-3, 0)
            assert np.all(np.abs(shown - told[name][column]) <= rtol * told[name][column] + atol)


def test_compare(file, told, tmp_path, capsys):
    out = out_of(["compare", file, "--table", "-o", tmp_path / "c.png", "--csv", tmp_path / "c.csv"], capsys)
    check_csv(tmp_path / "c.csv", told, ["mean", "low_95", "high_95", "std", "theory", "residual"])
    found = tables(out)
    assert list(found) == [LONG[name] for name in QUANTITIES]
    for name in QUANTITIES:
        header, rows = found[LONG[name]]
        assert [x for x in header if x] == ["d/sigma", "mean", "95 % interval", "std", "theory", "residual"]
        expected = told[name]
        for k, row in enumerate(rows):
            h, mean, interval, std, theory, residual = row
            assert float(std) == pytest.approx(expected["std"][k], rel=6e-3)
            assert float(h) == H[k]
            seen = 0.07 * expected["stderr"][k]  # half of the second digit of an error, a little wrong itself
            assert float(mean) == pytest.approx(expected["mean"][k], rel=0, abs=seen)
            assert float(theory) == pytest.approx(expected["theory"][k], rel=0, abs=seen)
            assert float(residual) == pytest.approx(expected["residual"][k], abs=6e-3)
            ends = [end[k] for end in expected["interval"]]
            assert [float(end) for end in interval.split("...")] == pytest.approx(ends, rel=0, abs=seen)
        assert len(rows) == len(H)


def test_tradeoff(scene, tmp_path, capsys, monkeypatch):
    """Files hold what was measured and what is advised, in full; the terminal says the same in short."""
    from oracles.study_by_hand import made_up

    small = scene.replace(keep="sums", quantities=("load",), separations=(2.0,))
    study = made_up(small)
    (tmp_path / "s.toml").write_text(mcgw.scene_text(small))
    monkeypatch.setattr("mcgw.statistics.tradeoff.tradeoff", lambda scene, *, seconds: study)
    said = out_of(["tradeoff", tmp_path / "s.toml", "-o", tmp_path, "-v"], capsys)
    assert "The mean load needs no surfaces: 0.5 ms" in said
    assert f"{tmp_path / 's-tradeoff.csv'}: what to run for each error (12 s)" in said
    rows = rows_of(tmp_path / "s-tradeoff.csv")
    assert len(rows) == 36
    assert [row["way"] for row in rows[:6]] == ["theory"] * 6
    assert {row["way"] for row in rows if row["want"] == "standard deviation"} == {"none"}
    for row, p in zip(rows_of(tmp_path / "s-tradeoff-measured.csv"), study.points, strict=True):
        assert (row["way"], row["want"], int(row["n_surfaces"])) == (p.way, p.want, p.n_surfaces)
        assert [float(row[key]) for key in ("rms", "stderr", "bias", "seconds", "repeats")] == [
            p.rms, p.stderr, p.bias, p.seconds, p.repeats
        ]  # fmt: skip


def test_run_says_how_many_and_what_is_not_known(scene, tmp_path, capsys):
    asked = scene.replace(keep="sums", rel_err=1e-3, n_surfaces=70, separations=(0.0, 9.0))
    (tmp_path / "s.toml").write_text(mcgw.scene_text(asked))
    out = out_of(["run", tmp_path / "s.toml", "-o", tmp_path / "e.h5"], capsys)
    ensemble = mcgw.open_ensemble(tmp_path / "e.h5")
    assert ensemble.n_surfaces == 70
    assert f"{tmp_path / 'e.h5'}: 70 surfaces of 3000 asperities, seed 2" in out
    limit = -math.log(0.05) / 70
    assert f"d/sigma = 9: no contact in 70 surfaces, mean below {limit:.3g} contacts per surface" in out
    assert f"{limit / 3000:.3g} per asperity" in out
    known = re.findall(r"(\w+) at d/sigma = 0 has a relative error of (\S+), not 0.001", out)
    assert [name for name, _ in known] == list(QUANTITIES)
    for name, width in known:
        x = ensemble.values(name)[:, 0]
        students = student.ppf(0.975, 69) * x.std(ddof=1) / math.sqrt(70) / x.mean()
        assert float(width) == pytest.approx(students, rel=0.15)
        _, high = ensemble.interval(name)
        assert float(width) == pytest.approx(high[0] / x.mean() - 1, rel=0.06)

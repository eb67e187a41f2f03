"""`keep = "statistics"`: what follows from surfaces follows without them, in the same bits whoever draws."""

from fractions import Fraction

import numpy as np
import pytest
from conftest import SURFACE
from oracles.flipped import flip_a_number
from oracles.inside import verify
from oracles.memory_growth import peak_growth
from oracles.scenes import scene_by

import mcgw
from mcgw.cli import main
from mcgw.ensemble import drawing, simulation

H = [0.0, 1.0, 2.5]


def scene(**changes):
    given = {"separations": H, "seed": 3, "n_surfaces": 300, "n_asperities": 300, **changes}
    return scene_by(given.pop("surface", SURFACE), **given)


YIELDS = mcgw.KogutEtsion(hardness=1.2e9, poisson=0.3)
SPECTRUM = mcgw.SpectralSurface(m0=1e-12, m2=1e-3, m4=1e7, nominal_area="1 mm^2", E_star="80 GPa")
SCENES = {
    "graded, poisson": scene(grading=mcgw.Exponential(2.0), count="poisson"),
    "yields, and back": scene(
        law=YIELDS, unload_from=-0.5, quantities=["load", "yielded", "contacts", "area"]
    ),
    "interacting": scene(interaction="body"),
    "crowds": scene(sampler="aggregate", n_asperities=10**7),
    "rare": scene(separations=[4.0, 6.0, 9.0], n_asperities=300),
    "own radii": scene(surface=SPECTRUM, n_surfaces=100),
    "one surface": scene(n_surfaces=1),
    "joint": scene(joint=mcgw.Joint((200.0, 16.0), gas="air", rms="2 um")),
}


@pytest.fixture
def small_blocks(monkeypatch):
    """Blocks of 128 surfaces, of four pieces: as many as a long run has."""
    monkeypatch.setattr(drawing, "_PIECE_ROWS", 32)
    monkeypatch.setattr(drawing, "_MOST_ROWS", 128)


# --- joining --------------------------------------------------------------------------------------------


def exactly(x):
    """Mean and sum of the squares of deviations in exact arithmetic, rounded once."""
    x = [Fraction(v) for v in x.tolist()]
    mean = sum(x) / len(x)
    return [float(mean), float(sum((v - mean) ** 2 for v in x))]


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("name", SCENES)
def test_statistics_are_those_of_the_surfaces(name):
    """Mean and deviation against exact arithmetic, covariances against extended precision."""
    full, kept = (mcgw.simulate(SCENES[name], keep=keep) for keep in ("sums", "statistics"))
    m, first = full.n_surfaces, full.scene.tables[0]
    assert kept.n_surfaces == m
    apart = {q: full[q].reshape(m, -1).astype(np.longdouble) for q in full.scene.tables}
    apart = {q: x - x.mean(axis=0) for q, x in apart.items()}
    for q in full.scene.tables:
        mean, squares = np.transpose([exactly(x) for x in full[q].T])
        np.testing.assert_allclose(kept.mean(q).ravel(), mean, rtol=1e-13)
        if m == 1:
            assert np.isnan(kept.std(q)).all()
            assert np.isnan(kept.covariance(q, first)).all()
            continue
        std = np.sqrt(squares / (m - 1))  # of which rounding of the mean takes digits where it is small
        lost = np.abs(mean / np.where(std > 0, std, np.inf))
        off = np.abs(kept.std(q).ravel() / np.where(std > 0, std, 1) - (std > 0))
        assert np.all(off <= 1e-13 + 1e-15 * lost)
        found = kept.covariance(q, first).reshape(len(mean), -1) * (m - 1)
        size = [np.sqrt((apart[k] ** 2).sum(axis=0)) for k in (q, first)]
        limit = (1e-13 + 1e-15 * lost.max()) * np.outer(*size)
        assert np.all(np.abs(found - apart[q].T @ apart[first]) <= limit)


def test_the_file_is_read_by_others_and_says_when_it_is_damaged(tmp_path):
    xarray = pytest.importorskip("xarray")
    for package in ("h5netcdf", "pandas"):
        pytest.importorskip(package)
    path = tmp_path / "a.h5"
    e = mcgw.run(scene(), path, keep="statistics")
    with xarray.open_dataset(path, engine="h5netcdf") as file:
        np.testing.assert_array_equal(file["load_mean"], e.mean("load"))
        assert file["load_std"].dims == ("separation",)
        assert file["load_std"].units == "N"
        xarray.testing.assert_equal(file[list(e.to_xarray())].load(), e.to_xarray())
        full = mcgw.simulate(scene())
        columns = np.concatenate([full[name] for name in full.scene.tables], axis=1)
        np.testing.assert_allclose(file["covariance"], np.cov(columns.T), rtol=1e-9, atol=1e-300)
        order = ", ".join(f"{name} 3" for name in full.scene.tables)
        assert file["covariance"].long_name == f"covariance of {order}"
    assert e.to_dataframe()["load_std"].tolist() == e.std("load").tolist()
    assert verify(path)[0] == ""
    flip_a_number(path, "drawn/numbers_means")
    assert verify(path)[0] != ""


def test_what_does_not_fit_is_refused(monkeypatch):
    monkeypatch.setattr("mcgw.machine.process.memory_available", lambda: 2**28)
    with pytest.raises(ValueError, match="covariances between 3200 numbers needs"):
        mcgw.simulate(scene(separations=np.linspace(0, 4, 800), n_surfaces=2, keep="statistics"))


@pytest.mark.slow
def test_memory_does_not_grow_with_surfaces():
    few, many = (
        peak_growth(lambda n=n: mcgw.simulate(scene(n_asperities=5, n_surfaces=n, keep="statistics")))
        for n in (40_000, 400_000)
    )
    assert not many > few + 2**24  # 16 MiB, of 38 MB of values; nan where the system does not tell


@pytest.mark.usefixtures("small_blocks")
def test_time_ends_between_pieces_and_the_same_number_gives_the_same_bits(monkeypatch):
    """By a clock that stands still until 1000 surfaces are drawn, and is late then."""
    told = []
    monkeypatch.setattr(simulation, "monotonic", lambda: float(max(told, default=0) >= 1000) * 1e12)
    asked = scene(n_surfaces=10**5, keep="statistics", max_seconds=1e9)
    e = mcgw.simulate(asked, progress=lambda done, _: told.append(done))
    assert e.n_surfaces == told[-1] == 32 * 32
    assert len(told) > 32
    again = mcgw.simulate(asked, max_seconds=None, n_surfaces=e.n_surfaces)
    for q in asked.tables:
        np.testing.assert_array_equal(e.mean(q), again.mean(q))
        np.testing.assert_array_equal(e.covariance(q, "load"), again.covariance(q, "load"))


@pytest.mark.usefixtures("blank_figures", "no_pressures")
@pytest.mark.parametrize("command", ["report", "compare", "show --csv"])
def test_commands_take_the_file(command, tmp_path, capsys):
    mcgw.run(scene(separations=np.linspace(0, 3, 5), n_surfaces=100), tmp_path / "a.h5", keep="statistics")
    name, *words = command.split()
    output = tmp_path / {"report": "a.html", "compare": "a.png"}.get(name, "a.csv")
    flag = [] if "--csv" in words else ["-o"]
    assert main([name, str(tmp_path / "a.h5"), *words, *flag, str(output)]) == 0
    assert output.exists()
    if name == "show":
        assert "statistics alone" in capsys.readouterr().out

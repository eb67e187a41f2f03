import io
import os
import sys
from contextlib import chdir
from pathlib import Path

# Workers share the cores: threads of BLAS that wait for each other spin.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import pytest
from matplotlib.figure import Figure
from oracles.inside import Values
from oracles.interacting_by_hand import QUANTITIES, SEPARATIONS, interaction
from oracles.scenes import scene_by
from oracles.told import ANSWERS, apart

import analytic
import mcgw
from mcgw.commands.starting import warm

SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3.0e8, nominal_area=1e-4, E_star=78.6e9)


def pytest_addoption(parser):
    group = parser.getgroup("mcgw")
    group.addoption("--record", action="store_true", help="write tests/answers anew, to be read")


def forget_old_loops(folder):
    """Remove compiled loops older than the newest source: Numba looks at none but the own file of a loop."""
    newest = max(path.stat().st_mtime for path in folder.rglob("*.py") if "njit" in path.read_text())
    for kept in folder.rglob("*.nbi"):
        if kept.stat().st_mtime < newest:
            kept.unlink()


def pytest_configure(config):
    if not hasattr(config, "workerinput"):
        forget_old_loops(Path(mcgw.__file__).parent)


@pytest.hookimpl(wrapper=True)
def pytest_sessionstart(session):
    """Compile all loops while the workers, which have begun, collect."""
    yield
    if session.config.getoption("numprocesses", None):
        warm()


@pytest.fixture(scope="session")
def make_scene():
    """Scenes of one surface, whatever else is asked."""

    def make(**changes):
        values = {
            "surface": SURFACE,
            "separations": tuple(np.linspace(0, 4, 9)),
            "grading": analytic.Exponential(2.0),
            "n_asperities": 3000,
            "n_surfaces": 200,
            "seed": 1,
        }
        return scene_by(**(values | changes))

    return make


@pytest.fixture
def pressed(make_scene):
    """The same whose asperities press each other down, by an interaction of some strength."""

    def make(strength, **changes):
        values = {"separations": SEPARATIONS, "quantities": QUANTITIES, "n_surfaces": 4}
        scene = make_scene(**(values | changes))
        return scene.replace(interaction=interaction(strength, scene.surface, scene.n_asperities))

    return make


@pytest.fixture
def without_caps(monkeypatch):
    """Fits of maps leave out the estimate of hidden caps, which takes most of their time."""
    monkeypatch.setattr("mcgw.maps.fit.by_caps", lambda *_: None)


def blank(figure, target, **_):
    """In place of `Figure.savefig`, which takes a second each: the file, and nothing drawn in it."""
    if isinstance(target, Path):
        target.touch()
    else:
        target.write(b"" if isinstance(target, io.BytesIO) else "<svg></svg>")


@pytest.fixture
def in_tmp_path(tmp_path):
    """Work in an empty folder."""
    with chdir(tmp_path):
        yield tmp_path


@pytest.fixture
def missing(monkeypatch):
    """Make a package one that cannot be imported."""
    return lambda package: monkeypatch.setitem(sys.modules, package, None)


@pytest.fixture
def blocks_of(monkeypatch):
    """Set the number of surfaces in a block."""
    return lambda rows: monkeypatch.setattr(Values, "rows", rows)


@pytest.fixture
def small_blocks(monkeypatch):
    """Runs are drawn in blocks of 16 surfaces, in chunks of 8."""
    from oracles.begun_runs import in_small_blocks

    in_small_blocks(monkeypatch)


@pytest.fixture
def blank_figures(monkeypatch):
    """Figures are made and their files written, but nothing is laid out or drawn in them."""
    monkeypatch.setattr(Figure, "savefig", blank)
    monkeypatch.setattr("matplotlib.layout_engine.ConstrainedLayoutEngine.execute", lambda *_: None)


@pytest.fixture
def kept(monkeypatch):
    """A list of the figures that are saved, as they are then; nothing is drawn."""
    figures = []

    def keep(self, path, **_):
        path.touch()
        figures.append(self)

    monkeypatch.setattr(Figure, "savefig", keep)
    return figures


@pytest.fixture
def recorded(request):
    """Compare lines with those of a file in `answers`; with `--record`, write them there."""

    def check(name, said):
        text, path = "\n".join(said) + "\n", ANSWERS / f"{name}.txt"
        if request.config.getoption("--record") and (not path.exists() or apart(path.read_text(), text)):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        moved = apart(path.read_text(), text)
        assert not moved, "\n".join(["is it meant? then --record, and read the difference", *moved])

    return check


@pytest.fixture
def pressures(monkeypatch):
    """Set at how many pressures reports solve: each takes half a second."""
    return lambda number: monkeypatch.setattr("mcgw.reports.html._PRESSURES", number)


@pytest.fixture
def one_pressure(pressures):
    pressures(1)


@pytest.fixture
def no_pressures(pressures):
    pressures(0)


@pytest.fixture
def cheap(monkeypatch):
    """Boundary elements that are a known multiple of what located summits say."""
    from oracles.inside import LEVELS, Level, located

    def solve(pressed):
        return {name: 1.25 * value for name, value in located(pressed).items()}

    levels = (*LEVELS[:2], Level("elastic", "stand-in", solve, 1.0))
    monkeypatch.setattr("mcgw.elasticity.elastic.LEVELS", levels)


@pytest.fixture
def rng():
    return np.random.default_rng(20261124)

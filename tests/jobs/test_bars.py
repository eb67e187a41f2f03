"""Long work has a bar on the terminal of who waits for it: commands and ``progress=True``, nobody else."""

import io
import sys
import time
from contextlib import nullcontext, suppress

import numpy as np
import pytest

import mcgw
from mcgw.cli import main
from mcgw.machine.progress import steps, told as asked, watched

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "0.1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(SURFACE, separations=[0.0, 1.0], n_surfaces=4, seed=1)


class Stream(io.StringIO):
    """Standard error of a person, or of a log."""

    def __init__(self, terminal):
        super().__init__()
        self.terminal = terminal

    def isatty(self):
        return self.terminal


@pytest.mark.usefixtures("without_caps")
@pytest.mark.parametrize(
    ("words", "bars"),
    [
        ("solve s.toml --pressure 1MPa -v", ["4 [", " surfaces/s"]),
        ("fit map.npy --cutoff none --pixel 1um -o f.toml", ["/3 [", " steps/s"]),
        ("sweep s.toml --over grading.gamma=0.2:1:7 -o w.h5", ["/7 [", "? points/s"]),
    ],
)
def test_commands_draw_one_on_terminals(words, bars, in_tmp_path, monkeypatch):
    """What they say elsewhere is recorded, see `test_what_users_read`: there are none."""
    (in_tmp_path / "s.toml").write_text(mcgw.scene_text(SCENE))
    z = np.random.default_rng(1).normal(size=(64, 64))
    np.save("map.npy", 1e-7 * (z + np.roll(z, 1, 0) + np.roll(z, 1, 1)))
    monkeypatch.setattr(sys, "stderr", Stream(terminal=True))
    assert main(words.split()) == 0
    assert all(part in sys.stderr.getvalue() for part in bars)


def test_python_waits_only_if_it_says_so(monkeypatch):
    stream, calls = Stream(terminal=True), []
    monkeypatch.setattr(sys, "stderr", stream)
    over = {"grading.gamma": [0.5, 1.5]}
    mcgw.sweep(SCENE, over)
    assert not stream.getvalue()
    mcgw.sweep(SCENE, over, progress=True)
    assert " points/s" in stream.getvalue()
    mcgw.solve(SCENE, pressure=1e6, progress=lambda *pair: calls.append(pair))
    assert not calls  # nothing is drawn where answers are exact
    mcgw.solve(SCENE.replace(interaction="body"), pressure=1e6, progress=lambda *pair: calls.append(pair))
    assert calls[-1] == (4, 4)


@pytest.mark.parametrize("terminal", [True, False])
@pytest.mark.parametrize("person", [True, False])
@pytest.mark.parametrize("progress", [True, False, None, print])
def test_who_has_a_bar(terminal, person, progress, monkeypatch):
    """Who asks for one, or a person who waits at a terminal; calls within it draw none beside it."""
    stream = Stream(terminal)
    monkeypatch.setattr(sys, "stderr", stream)
    with watched() if person else nullcontext(), asked(progress, "surfaces") as tell:
        assert not stream.getvalue()  # nothing is drawn before the first number
        assert progress is not print or tell is print
        if progress is not print:
            tell(1, 3)
        assert list(steps([4, 5], "things")) == [4, 5]
    drawn = progress is True or (progress is None and terminal and person)
    assert ("1/3 [" in stream.getvalue()) == drawn
    assert ("things/s" in stream.getvalue()) == (progress in (print, False) and terminal and person)
    stream.truncate(0)
    assert list(steps([4, 5], "things")) == [4, 5]  # nobody waits any more
    assert not stream.getvalue()


@pytest.mark.parametrize("progress", [3, "bar"])
def test_what_is_no_function_is_refused(progress):
    with pytest.raises(ValueError, match=f"progress = {progress!r}: give True, or a function"):
        mcgw.simulate(SCENE, progress=progress)


def test_a_bar_goes_on_from_what_was_done_before_and_ends_with_an_error(monkeypatch):
    for _ in range(2):
        monkeypatch.setattr(sys, "stderr", Stream(terminal=True))
        with suppress(KeyError), asked(True, "surfaces") as show:
            for done in (50, 60, 100):
                show(done, 100)
                time.sleep(0.11)  # so often it is drawn
            raise KeyError
        shown = sys.stderr.getvalue()
        assert all(part in shown for part in (" 50/100 [", " 60/100 [", " 100/100 [", " surfaces/s]"))
        assert shown.endswith("\r")  # it leaves nothing

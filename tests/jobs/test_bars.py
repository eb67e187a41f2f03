"""Long work has a bar on the terminal of who waits for it: commands and ``progress=True``, nobody else."""

import io
import time
from contextlib import nullcontext, redirect_stderr, suppress

import numpy as np
import pytest

import mcgw
from mcgw.cli import main
from mcgw.machine.process import steps, told as asked, watched

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "0.1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(SURFACE, separations=[0.0, 1.0], n_surfaces=4, seed=1)


def stream(terminal):
    """Standard error of a person, or of a log."""
    made = io.StringIO()
    made.isatty = lambda: terminal
    return made


@pytest.mark.usefixtures("without_caps")
@pytest.mark.parametrize(
    ("words", "bars"),
    [
        ("solve s.toml --pressure 1MPa -v", ["4 [", " surfaces/s"]),
        ("fit map.npy --cutoff none --pixel 1um -o f.toml", ["/3 [", " steps/s"]),
        ("sweep s.toml --over grading.gamma=0.2:1:7 -o w.h5", ["/7 [", "? points/s"]),
    ],
)
def test_commands_draw_one_on_terminals(words, bars, in_tmp_path):
    """What they say elsewhere is recorded, see `test_what_users_read`: there are none."""
    (in_tmp_path / "s.toml").write_text(mcgw.scene_text(SCENE))
    z = np.random.default_rng(1).normal(size=(64, 64))
    np.save("map.npy", 1e-7 * (z + np.roll(z, 1, 0) + np.roll(z, 1, 1)))
    with redirect_stderr(stream(terminal=True)) as shown:
        assert main(words.split()) == 0
    assert all(part in shown.getvalue() for part in bars)


def test_python_waits_only_if_it_says_so():
    over, calls = {"grading.gamma": [0.5, 1.5]}, []
    with redirect_stderr(stream(terminal=True)) as shown:
        mcgw.sweep(SCENE, over)
        assert not shown.getvalue()
        mcgw.sweep(SCENE, over, progress=True)
    assert " points/s" in shown.getvalue()
    mcgw.solve(SCENE.replace(interaction="body"), pressure=1e6, progress=lambda *pair: calls.append(pair))
    assert calls[-1] == (4, 4)


@pytest.mark.parametrize("terminal", [True, False])
@pytest.mark.parametrize("person", [True, False])
@pytest.mark.parametrize("progress", [True, False, None, print])
def test_who_has_a_bar(terminal, person, progress):
    """Who asks for one, or a person who waits at a terminal; calls within it draw none beside it."""
    with redirect_stderr(stream(terminal)) as shown:
        with watched() if person else nullcontext(), asked(progress, "surfaces") as tell:
            assert not shown.getvalue()  # nothing is drawn before the first number
            assert progress is not print or tell is print
            if progress is not print:
                tell(1, 3)
            assert list(steps([4, 5], "things")) == [4, 5]
        said = shown.getvalue()
        assert list(steps([4, 5], "things")) == [4, 5]  # nobody waits any more
    assert shown.getvalue() == said
    assert ("1/3 [" in said) == (progress is True or (progress is None and terminal and person))
    assert ("things/s" in said) == (progress in (print, False) and terminal and person)


def test_a_bar_goes_on_from_what_was_done_before_and_ends_with_an_error():
    for _ in range(2):
        with (
            redirect_stderr(stream(terminal=True)) as shown,
            suppress(KeyError),
            asked(True, "surfaces") as show,
        ):
            for done in (50, 60, 100):
                show(done, 100)
                time.sleep(0.11)  # so often it is drawn
            raise KeyError
        parts = (" 50/100 [", " 60/100 [", " 100/100 [", " surfaces/s]")
        assert all(part in shown.getvalue() for part in parts)
        assert shown.getvalue().endswith("\r")  # it leaves nothing

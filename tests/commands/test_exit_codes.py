"""Exit codes are those of the work: who reads what a command says decides nothing.

Every command, standard output and standard error, each closed, full, or a pipe whose reader has left.
"""

import os
import subprocess
import sys
import warnings

import pytest

from mcgw.cli import main
from mcgw.errors import RunError

PRINTED = ("show e.h5", "solve a.toml --load 1N", "elastic a.toml --pressure 1MPa", "completion bash")
LINES = ("run a.toml -o r.h5", "merge e.h5", *PRINTED)  # the product of the last ones is what they print
STATES = ("closed", "full", "broken")
# What a full standard output means differs between commands; all else is of every command alike.
DISTURBED = [(line, "stdout", "full") for line in LINES]
DISTURBED += [(line, "stderr", state) for line in ("merge e.h5", "show e.h5") for state in STATES]
DISTURBED += [
    (line, "stdout", state) for line in ("merge e.h5", "show e.h5") for state in ("closed", "broken")
]
streams = pytest.mark.parametrize("state", STATES)
pytestmark = pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")


@pytest.fixture
def disturbed(monkeypatch):
    """Give a standard stream a state, as Python has it at the start of a process."""
    opened = []

    def disturb(stream, state):
        if state == "full":
            opened.append(os.fdopen(os.open("/dev/full", os.O_WRONLY), "w"))
        elif state == "broken":
            reader, writer = os.pipe()
            os.close(reader)
            opened.append(os.fdopen(writer, "w"))
        monkeypatch.setattr(sys, stream, None if state == "closed" else opened[-1])

    yield disturb
    for stream in opened:
        stream.close()


@pytest.fixture
def instead(monkeypatch):
    """Let something else stand in for the work of every command; it gets what was typed."""
    return lambda work: monkeypatch.setattr("mcgw.cli.execute", lambda _, args: work(args))


@pytest.mark.parametrize(("line", "stream", "state"), DISTURBED)
def test_what_is_said_decides_nothing(line, stream, state, disturbed, instead):
    """The work stands in for that of the command: it says much before and after, and ends in every way."""
    ends = {0: None, 1: None, 2: ValueError("bad"), 3: RunError("failed", code=3), 130: KeyboardInterrupt()}
    done = []

    def work(args):
        for number in range(2):
            for where in (sys.stdout, sys.stderr):
                print("said\n" * 4000, file=where)
                where.flush()
            done.append(number)
        if ends[code] is not None:
            raise ends[code]
        return code

    instead(work)
    for code in ends:
        disturbed(stream, state)
        lost = line in PRINTED and (stream, state) == ("stdout", "full")
        assert main(line.split()) == (code or int(lost))
    assert done == [0, 1] * 5


@pytest.mark.parametrize(
    ("end", "code", "told"),
    [
        (None, 0, ""),
        (KeyboardInterrupt(), 130, "mcgw: interrupted\n"),
        (RunError("failed", code=3), 3, "mcgw: failed\n"),
        (RunError("failed"), 1, "mcgw: failed\n"),
        (MemoryError("of 3\nGiB"), 1, "mcgw: not enough memory (of 3\\nGiB); reduce the scene\n"),
        (ValueError("one\ntwo"), 2, "mcgw: one\nmcgw: two\n"),
        (OSError("no disk"), 2, "mcgw: no disk\n"),
        (BrokenPipeError(32, "Broken pipe", "a worker"), 2, "mcgw: a worker: Broken pipe\n"),
    ],
)
@pytest.mark.filterwarnings("always")
def test_each_end_has_its_line_after_those_of_the_warnings(end, code, told, instead, capsys):
    def work(args):
        warnings.warn("two\nlines", stacklevel=1)
        warnings.warn_explicit("said as a note", UserWarning, "", 1, module="mcgw.scene.surface")
        if end is not None:
            raise end
        return 0

    instead(work)
    for quiet, warned in ([], "mcgw: warning: two\\nlines\n"), (["--quiet"], ""):
        assert main(["show", "e.h5", *quiet]) == code
        assert capsys.readouterr() == ("", warned + told)


@streams
@pytest.mark.parametrize(
    ("stream", "words"), [("stdout", "--version"), ("stdout", "show --help"), ("stderr", "show --none")]
)
def test_help_is_what_was_asked_for_and_other_words_bad_input(stream, words, state, disturbed):
    disturbed(stream, state)
    assert main(words.split()) == (2 if stream == "stderr" else int(state == "full"))


TERMINATED = """
import os, signal, sys
from mcgw import cli
cli.execute = lambda *_: os.kill(os.getpid(), signal.SIGTERM)
sys.argv = ["mcgw", "merge", "e.h5"]
cli.process()
"""


def test_a_termination_is_told_in_one_line():
    done = subprocess.run([sys.executable, "-c", TERMINATED], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (143, "", "mcgw: terminated\n")

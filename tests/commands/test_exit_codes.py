"""Exit codes are those of the work: who reads what a command says decides nothing.

Every command, standard output and standard error, each closed, full, or a pipe whose reader has left.
"""

import gc
import importlib.metadata
import os
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import pytest

import mcgw
from mcgw.cli import COMMANDS, main, process
from mcgw.errors import RunError

WORDS = {
    "init": "init demo -o new/i.toml",
    "run": "run scene.toml -o new/r.h5",
    "sweep": "sweep plain.toml --over grading.gamma=1.1,1.2 -o new/s.h5",
    "show": "show e.h5 --verify",
    "compare": "compare e.h5 -o new/c.png --csv new/c.csv",
    "converge": "converge plain.toml -o new",
    "tradeoff": "tradeoff plain.toml --seconds 2 -o new",
    "merge": "merge e.h5",
    "solve": "solve plain.toml --load 1N --csv new/v.csv",
    "export": "export plain.toml --to abaqus -o new/x.inp",
    "figures": "figures --scene plain.toml -o new",
    "report": "report e.h5 -o new/r.html",
    "surface": "surface plain.toml --shape 16 -o new/m.h5",
    "fit": "fit map.npy --cutoff none -o new/f.toml",
    "elastic": "elastic plain.toml --pressure 1MPa -o new/e.jsonl",
    "warm": "warm",
    "completion": "completion bash",
}
PRINTED = {"show", "solve", "elastic", "completion"}  # the product stands on standard output
STATES = ("closed", "full", "broken")
streams = pytest.mark.parametrize("state", STATES)
has_full = pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")
pytestmark = has_full


def expected(command, stream, state, code):
    """Only a full disk is a failure, and only of what has no other product."""
    return code or int(command in PRINTED and (stream, state) == ("stdout", "full"))


@pytest.fixture
def disturbed():
    """A stream of that state, as Python has it at the start of a process."""
    opened = []

    def make(state):
        if state == "closed":
            return None
        if state == "full":
            opened.append(os.fdopen(os.open("/dev/full", os.O_WRONLY), "w"))
        else:
            reader, writer = os.pipe()
            os.close(reader)
            opened.append(os.fdopen(writer, "w"))
        return opened[-1]

    yield make
    for stream in opened:
        stream.close()


@pytest.fixture
def instead(monkeypatch):
    """Let something else stand in for the work of every command; it gets what was typed."""
    return lambda work: monkeypatch.setattr("mcgw.cli.execute", lambda _, args: work(args))


def test_all_commands_are_here():
    assert tuple(WORDS) == COMMANDS


# What a full standard output means differs between commands; all else is of every command alike.
DISTURBED = [(command, "stdout", "full") for command in COMMANDS]
DISTURBED += [
    (command, x, state) for command in ("run", "show") for x in ("stdout", "stderr") for state in STATES
]


@pytest.mark.parametrize(("command", "stream", "state"), sorted(set(DISTURBED)))
def test_what_is_said_decides_nothing(command, stream, state, disturbed, tmp_path, monkeypatch, instead):
    """The work stands in for that of the command: it says much before and after, and ends in every way."""
    ends = {0: None, 1: None, 2: ValueError("bad"), 3: RunError("failed", code=3), 130: KeyboardInterrupt()}

    def work(args):
        for number in range(2):
            for where in (sys.stdout, sys.stderr):
                print("said\n" * 4000, file=where)
                where.flush()
            (tmp_path / f"done{number}").touch()
        if ends[code] is not None:
            raise ends[code]
        return code

    instead(work)
    for code in ends:
        monkeypatch.setattr(sys, stream, disturbed(state))
        assert main(WORDS[command].split()) == expected(command, stream, state, code)
        for number in range(2):
            (tmp_path / f"done{number}").unlink()


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
    ],
)
@pytest.mark.filterwarnings("always")
def test_each_end_has_its_line_after_those_of_the_warnings(end, code, told, instead, capsys):
    def work(args):
        warnings.warn("two\nlines", stacklevel=1)
        warnings.warn_explicit("said as a note", UserWarning, "", 1, module="mcgw.scene.plausible")
        if end is not None:
            raise end
        return 0

    instead(work)
    for quiet, warned in ([], "mcgw: warning: two\\nlines\n"), (["--quiet"], ""):
        assert main(["show", "e.h5", *quiet]) == code
        assert capsys.readouterr() == ("", warned + told)


def test_a_process_ends_with_the_code_of_its_command_and_looks_for_no_garbage(monkeypatch, capsys):
    frozen = []
    monkeypatch.setattr(gc, "freeze", lambda: frozen.append(True))
    monkeypatch.setattr("mcgw.cli.execute", lambda *_: 3)
    monkeypatch.setattr(sys, "argv", ["mcgw", "show", "e.h5"])
    with pytest.raises(SystemExit) as end:
        process()
    assert (end.value.code, frozen) == (3, [True])

    def unknown(name):
        raise importlib.metadata.PackageNotFoundError(name)

    for version, said in (unknown, "mcgw unknown\n"), (lambda name: f"1.2 of {name}", "mcgw 1.2 of mcgw\n"):
        monkeypatch.setattr(importlib.metadata, "version", version)
        with pytest.raises(SystemExit) as end:
            main(["--version"])
        assert (end.value.code, capsys.readouterr().out) == (0, said)


@pytest.mark.parametrize(("given", "used"), [(None, "1"), ("3", "3")])
def test_a_process_has_one_thread_of_blas_unless_told_otherwise(given, used):
    """It is read when NumPy is imported, so that must come later: two that wait took half of a report."""
    words = "import os, sys; import mcgw.cli as c; assert 'numpy' not in sys.modules; c.main = lambda: 0\n"
    words += "try: c.process()\nfinally: print(os.environ['OPENBLAS_NUM_THREADS'])"
    others = {name: x for name, x in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    asked = others | ({} if given is None else {"OPENBLAS_NUM_THREADS": given})
    done = subprocess.run([sys.executable, "-c", words], env=asked, capture_output=True, text=True)
    assert done.stdout.split() == [used]


@streams
@pytest.mark.parametrize("words", ["--version", "--help", "show --help"])
def test_help_is_what_was_asked_for(words, state, disturbed, monkeypatch):
    monkeypatch.setattr(sys, "stdout", disturbed(state))
    with pytest.raises(SystemExit) as end:
        main(words.split())
    assert end.value.code == (1 if state == "full" else 0)


@streams
def test_words_that_are_none_are_bad_input_all_the_same(state, disturbed, monkeypatch):
    monkeypatch.setattr(sys, "stderr", disturbed(state))
    with pytest.raises(SystemExit) as end:
        main(["show", "--none"])
    assert end.value.code == 2


def test_a_pipe_that_breaks_elsewhere_is_an_error(instead, capsys):
    def work(args):
        raise BrokenPipeError(32, "Broken pipe", "a worker")

    instead(work)
    assert main(["run", "s.toml"]) == 2
    assert capsys.readouterr().err == "mcgw: a worker: Broken pipe\n"


# --- whole processes --------------------------------------------------------------------------------------


@pytest.mark.parametrize("command", ["run", "show"])
def test_a_termination_is_told_in_one_line(command, instead, monkeypatch, capsys):
    def work(args):
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(5)

    before = signal.getsignal(signal.SIGTERM)
    instead(work)
    monkeypatch.chdir(Path(mcgw.__file__).parents[1])
    assert main(WORDS[command].split()) == 143
    assert capsys.readouterr().err == "mcgw: terminated\n"
    assert signal.getsignal(signal.SIGTERM) is before

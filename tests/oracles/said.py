"""What a command says."""

from contextlib import chdir, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from subprocess import CompletedProcess

from mcgw.cli import main


def call(*words, cwd="."):
    """A command in this process, answered as `subprocess.run` answers: a child takes a second to start."""
    out, err = StringIO(), StringIO()
    with chdir(Path(cwd)), redirect_stdout(out), redirect_stderr(err):
        code = main([str(word) for word in words])
    return CompletedProcess(words, code, out.getvalue(), err.getvalue())


def without_notes(text):
    """All but the notes on the scene: what is empty where nothing went wrong on standard error."""
    return "\n".join(line for line in text.splitlines() if not line.startswith("mcgw: note: "))

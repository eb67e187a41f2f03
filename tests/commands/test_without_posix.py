"""Import, run and compare where `fcntl`, `resource` and `/proc` are missing, as on Windows."""

import subprocess
import sys

import pytest
from oracles.docs_site import ROOT

import mcgw

HIDDEN = """
import builtins, io, os, sys
sys.modules["fcntl"] = sys.modules["resource"] = None
for module, name in ((builtins, "open"), (io, "open"), (os, "stat"), (os, "open")):
    def hiding(path, *more, _real=getattr(module, name), **options):
        if str(path).startswith("/proc"):
            raise FileNotFoundError(2, "No such file or directory", str(path))
        return _real(path, *more, **options)
    setattr(module, name, hiding)
"""
WORK = """
from mcgw.cli import main
assert main(["run", sys.argv[1], "-o", "q.h5"]) == 0
assert main(["compare", "q.h5", "-o", "q.png"]) == 0
"""
PROOF = """
for name in ("fcntl", "resource"):
    try:
        __import__(name)
    except ImportError:
        continue
    raise SystemExit("is there")
from pathlib import Path
assert not Path("/proc/cpuinfo").exists()
"""


def python(text, *words, cwd):
    return subprocess.run(
        [sys.executable, "-c", text, *words], cwd=cwd, capture_output=True, text=True, check=False
    )


def test_they_are_hidden(tmp_path):
    assert python(HIDDEN + PROOF, cwd=tmp_path).returncode == 0
    assert python("import sys\n" + PROOF, cwd=tmp_path).returncode == 1


@pytest.mark.slow
def test_run_and_compare(tmp_path):
    done = python(HIDDEN + WORK, str(ROOT / "runs" / "quick.toml"), cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "agree" in done.stdout
    assert mcgw.open_ensemble(tmp_path / "q.h5").n_surfaces > 0


def test_the_version_is_that_of_the_package():
    from importlib.metadata import version

    assert mcgw.__version__ == version("mcgw")

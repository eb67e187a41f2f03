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
assert not os.path.exists("/proc/cpuinfo") and sys.modules["fcntl"] is None
from mcgw.cli import main
assert main(["run", sys.argv[1], "-o", "q.h5"]) == 0
assert main(["compare", "q.h5", "-o", "q.png"]) == 0
"""


@pytest.mark.slow
def test_run_and_compare(tmp_path):
    words = [sys.executable, "-c", HIDDEN + WORK, str(ROOT / "runs" / "quick.toml")]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "agree" in done.stdout
    assert mcgw.open_ensemble(tmp_path / "q.h5").n_surfaces > 0


def test_the_version_is_that_of_the_package():
    from importlib.metadata import version

    assert mcgw.__version__ == version("mcgw")

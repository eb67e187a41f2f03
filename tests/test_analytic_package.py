"""The package as such: its table of equations, and what it may import."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import analytic

ROW = re.compile(r"^Eq\. \((\d+)\)\s+((?:`[\w.]+`(?:, )?)+)\s+\S", re.MULTILINE)
SOURCES = sorted(Path(analytic.__file__).parent.rglob("*.py"))


def test_every_equation_has_its_function():
    rows = {int(number): re.findall(r"`([\w.]+)`", names) for number, names in ROW.findall(analytic.__doc__)}
    assert sorted(rows) == list(range(1, 16))
    for names in rows.values():
        assert names
        for name in names:
            package, attribute = name.split(".")
            assert package == "analytic"
            assert attribute in analytic.__all__
            assert callable(getattr(analytic, attribute))


def test_public_names_exist_and_are_documented():
    for name in analytic.__all__:
        assert getattr(analytic, name).__doc__, name


def modules_after_import() -> set[str]:
    code = "import sys, analytic; print(*sys.modules)"
    run = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        cwd=SOURCES[0].parent.parent,
    )
    return {name.split(".")[0] for name in run.stdout.split()}


def test_import_brings_in_numpy_and_scipy_only():
    loaded = modules_after_import()
    assert {"analytic", "numpy", "scipy"} <= loaded
    assert not loaded & {"mcgw", "matplotlib", "h5py", "numba", "mpmath", "tqdm"}


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: p.name)
def test_no_source_imports_the_simulator(path):
    imported = re.findall(r"^\s*(?:from|import)\s+(\w+)", path.read_text(encoding="utf-8"), re.MULTILINE)
    assert set(imported) <= {"analytic", "numpy", "scipy", *sys.stdlib_module_names}

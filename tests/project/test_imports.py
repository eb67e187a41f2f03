"""What is imported when: one process answers all questions, each before the next import would blur it.

Every module costs its users time: who needs one imports it in a function.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from oracles.inside import SAMPLERS

import mcgw

ROOT = Path(mcgw.__file__).parents[1]
SCENE = ROOT / "runs" / "quick.toml"

# Steps of one process; what it has imported after each of them is printed. A branch goes on in a fork.
CHILD = """
import json, os, sys
scene, file, picture, made = sys.argv[1:]

def tell(step):
    os.write(out, (json.dumps([step, sorted(sys.modules)]) + "\\n").encode())

def main(*words):
    from mcgw.cli import main
    assert main([*words]) == 0

def branch(steps):
    pid = os.fork()
    if not pid:
        code = 1
        try:
            steps()
            code = 0
        finally:
            os._exit(code)
    assert os.waitpid(pid, 0)[1] == 0

def theory():
    import analytic
    tell("analytic")

def plans():
    mcgw.Scene(mcgw.Surface(1e-6, 1e-5, 3e8, 1e-4, 8e10), separations=[0.0, 1.0], seed=1)
    tell("scene")
    main("show", scene)
    main("solve", scene, "--pressure", "1MPa")
    tell("plan")

def looks():
    main("show", file)
    tell("show")
    main("compare", file, "-o", picture)
    tell("compare")

out = os.dup(1)
os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
branch(theory)
import mcgw
from mcgw.cli import parser_of
parser_of()
tell("parser")
branch(plans)
branch(looks)
main("run", scene, "-o", made)
tell("run")
surface = mcgw.Surface(1e-6, 1e-5, 3e8, 1e-4, 8e10)
def simulate(**wish):
    return mcgw.simulate(mcgw.Scene(surface, separations=[0.0, 1.0], n_surfaces=2, seed=1), **wish)

for sampler in ("cells", "tail", "direct"):
    simulate(sampler=sampler, n_asperities=10**5)
repr(simulate())
simulate().mean("load")
tell("simulate")
simulate(sampler="aggregate", n_asperities=10**5)
simulate(n_asperities=10**5, accuracy=1e-2)
tell("accuracy")
simulate(keep="statistics")
tell("statistics")
"""


@pytest.fixture(scope="module")
def after(tmp_path_factory):
    """Modules that were imported after each step."""
    folder = tmp_path_factory.mktemp("imports")
    scene = mcgw.load_scene(SCENE)
    mcgw.run(scene, folder / "e.h5")
    for sampler in SAMPLERS[1:]:  # what is compiled already is run without the compiler
        mcgw.simulate(scene, sampler=sampler, n_surfaces=2, n_asperities=10**5)
    words = [SCENE, *(folder / name for name in ("e.h5", "e.png", "made.h5"))]
    call = [sys.executable, "-W", "ignore::DeprecationWarning", "-c", CHILD, *map(str, words)]
    done = subprocess.run(call, capture_output=True, text=True, cwd=ROOT, check=False)
    assert done.returncode == 0, done.stderr
    return {step: set(names) for step, names in map(json.loads, done.stdout.splitlines())}


VALIDITY = [path for path in ROOT.glob("mcgw/validity/*.py") if path.stem != "__init__"]
# None of them may be there after a step.
NOT_THERE = {
    "analytic": {"mcgw", "matplotlib", "h5py", "numba", "mpmath", "tqdm", "scipy.special"},
    "parser": {"numpy", "numba", "h5py", "matplotlib", "scipy"},
    "scene": {
        "numba",
        "h5py",
        "matplotlib",
        "scipy.special",
        *(f"mcgw.validity.{path.stem}" for path in VALIDITY),
    },
    "show": {"matplotlib", "numba", "scipy.optimize", "scipy.stats"},
    "compare": {"matplotlib.pyplot", "numba", "scipy.optimize", "scipy.stats"},
    "run": {"matplotlib", "scipy.optimize", "scipy.stats"},
    "plan": {"matplotlib", "numba", "h5py", "filelock", "scipy.optimize", "scipy.stats"},
    "simulate": {"pandas", "xarray", "matplotlib"},
}
# What a scene that does not ask for it pays nothing for; and the step that asks, if one does.
FEATURES = {
    "mcgw.ensemble.pooled": "statistics",
    "mcgw.sampling.crowds": "accuracy",
    "mcgw.sampling.own_radii": None, "mcgw.sampling.shared": None,
    "mcgw.sampling.weighted_sums": None, "mcgw.sweeps.sweep": None,
}  # fmt: skip


@pytest.mark.parametrize("step", NOT_THERE)
def test_nothing_needless_is_imported(after, step):
    assert not NOT_THERE[step] & after[step]


def test_who_does_not_ask_for_a_feature_imports_nothing_of_it(after):
    for step in ("compare", "run", "simulate"):
        assert sorted(FEATURES.keys() & after[step]) == [], step
    for name, step in FEATURES.items():
        assert (ROOT / f"{name.replace('.', '/')}.py").exists(), name
        assert step is None or name in after[step], name


def test_what_is_imported_would_be_seen(after):
    """And of packages from elsewhere the theory takes NumPy and SciPy alone."""
    assert {"analytic", "numpy", "scipy"} <= after["analytic"]
    assert "numba" in after["run"]
    assert "matplotlib.figure" in after["compare"]
    assert "mcgw.commands.maps" in after["parser"]
    assert VALIDITY

"""Every command told to write over what it reads, under every name: a test and `runs/reliability` use it."""

import os
from contextlib import chdir
from pathlib import Path

import numpy as np

SURFACE = "surface = {sigma = 1.37e-6, radius = 13e-6, eta = 3.0e8, nominal_area = 1e-6, E_star = 78.6e9}\n"
SCENE = f"""{SURFACE}grading = {{law = "table", file = "table.csv"}}
heights = {{law = "table", file = "heights.npy"}}
contact = {{separations = [0.0, 1.0]}}
ensemble = {{n_surfaces = 8, seed = 1}}
"""
PLAIN = f"""{SURFACE}contact = {{separations = [0.0, 1.0], quantities = ["load"]}}
ensemble = {{n_surfaces = 8, seed = 1, sampler = "cells"}}
"""

# By name: the file that is read; the command, with OUT or DIR for where it is told to write; and what the
# name of its output ends in, or the name of a file that it writes in DIR.
CASES = {
    "run": ("scene.toml", "run scene.toml -o OUT", ".h5"),
    "run, table": ("table.csv", "run scene.toml -o OUT", ".h5"),
    "run, heights": ("heights.npy", "run scene.toml -o OUT", ".h5"),
    "run --shard": ("scene.toml", "run scene.toml --shard 1/2 -o OUT", ".h5"),
    "run --jobs": ("table.csv", "run scene.toml --jobs 1 -o OUT", ".h5"),
    "compare": ("e.h5", "compare e.h5 -o OUT", ".png"),
    "compare --csv": ("e.h5", "compare e.h5 --csv OUT", ".csv"),
    "show --csv": ("e.h5", "show e.h5 --csv OUT", ".csv"),
    "export": ("e.h5", "export e.h5 --to moose -o OUT", ".csv"),
    "export, scene": ("scene.toml", "export scene.toml --to abaqus -o OUT", ".inp"),
    "export, quantile": ("table.csv", "export scene.toml --to moose -o DIR/t.csv", "t.q05.csv"),
    "report": ("e.h5", "report e.h5 -o OUT", ".html"),
    "solve": ("scene.toml", "solve scene.toml --pressure 1MPa --csv OUT", ".csv"),
    "solve, table": ("table.csv", "solve scene.toml --pressure 1MPa --csv OUT", ".csv"),
    "surface": ("scene.toml", "surface scene.toml --shape 16 -o OUT", ".sdf"),
    "surface, heights": ("heights.npy", "surface scene.toml --shape 16 -o OUT", ".npy"),
    "surface, to HDF5": ("table.csv", "surface scene.toml --shape 16 -o OUT", ".h5"),
    "surface, sidecar": ("table.csv", "surface scene.toml --shape 16 -o DIR/m.npy", "m.json"),
    "fit": ("map.npy", "fit map.npy --cutoff none -o OUT", ".toml"),
    "fit, sidecar": ("map.json", "fit map.npy --cutoff none -o OUT", ".toml"),
    "fit, heights": (
        "map.npy", "fit map.npy --cutoff none --heights measured -o DIR/f.toml", "f.heights.npy",
    ),
    "fit --summits": ("map.npy", "fit map.npy --cutoff none -o f.toml --summits OUT", ".csv"),
    "fit --tiles": ("map.npy", "fit map.npy --cutoff none -o f.toml --tiles OUT", ".csv"),
    "converge": ("table.csv", "converge scene.toml -o DIR", "scene-converge.png"),
    "tradeoff": ("table.csv", "tradeoff scene.toml -o DIR", "scene-tradeoff.csv"),
    "tradeoff, measured": ("table.csv", "tradeoff scene.toml -o DIR", "scene-tradeoff-measured.csv"),
    "tradeoff, figure": ("scene.toml", "tradeoff scene.toml -o DIR", "scene-tradeoff.png"),
    "figures": ("scene.toml", "figures --scene scene.toml -o DIR --format png svg", "equal-load.svg"),
    "figures --csv": ("table.csv", "figures --scene scene.toml --csv -o DIR", "figure-6.csv"),
}  # fmt: skip
WAYS = ("its name", "dots", "absolute", "linked folder", "symbolic link", "hard link")


def ways(case):
    """Names under which a case can be tried: a file in a folder has no other spelling than its own."""
    return WAYS if "OUT" in CASES[case][1] else WAYS[-2:]


def prepare(folder):
    """Lay out inputs of every command."""
    from mcgw.cli import main

    (folder / "table.csv").write_text("s,ratio\n-5,0.9\n5,1.1\n")
    rng = np.random.default_rng(1)
    np.save(folder / "heights.npy", np.sort(rng.normal(size=300)))
    (folder / "scene.toml").write_text(SCENE)
    (folder / "plain.toml").write_text(PLAIN)
    words = [
        "run plain.toml -o e.h5",
        "surface --from-spectrum rms=1um,long=50um,short=5um --pixel 1um --shape 64 -o map.npy",
    ]
    with chdir(folder):
        for line in words:
            assert main(line.split()) == 0


def attempt(case, way):
    """Run a case in the current folder: exit code, and the files that changed, came or went."""
    from mcgw.cli import main

    read, words, ending = CASES[case]
    given = name_of(read, way, ending)
    before = contents()
    words = words.replace("OUT", str(given)).replace("DIR", "there")
    code = main(words.split())
    after = contents()
    changed = {str(name) for name in before.keys() | after.keys() if before.get(name) != after.get(name)}
    return code, sorted(changed)


def name_of(read, way, ending):
    """Another name of a file, made if need be."""
    folder = Path("there")
    folder.mkdir(exist_ok=True)
    alias = folder / (ending if not ending.startswith(".") else f"alias{ending}")
    match way:
        case "its name":
            return Path(read)
        case "dots":
            return Path(f"there/../{read}")
        case "absolute":
            return Path(read).absolute()
        case "linked folder":
            (folder / "here").symlink_to(Path().absolute())
            return folder / "here" / read
        case "symbolic link":
            alias.symlink_to(Path(read).absolute())
        case "hard link":
            os.link(read, alias)
    return alias


def contents():
    """Bytes of all files."""
    return {path: path.read_bytes() for path in Path().rglob("*") if path.is_file()}

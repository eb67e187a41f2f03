"""What it costs that asperities press each other down: ``python interaction.py [--rounds 7] [--first]``.

Scene S1 (`scenes.py`) and the same with 10^4 asperities, timed in turn without and with interaction; ratios
are medians over rounds. The half-space is so soft that the interaction matters: sunk by the mean load at h =
0, asperities feel 1 more where the body is the reference, and 0.3 less where the mean plane is. With
``--first``: seconds of the processor until the first block of a new process, its loops compiled or, the
second time, read.
"""

import argparse
import math
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from functools import partial

from scenes import S1, block, script
from timing import Job, against, parser_of, show, timed

from analytic import Interaction
from mcgw.ensemble.drawing import kept
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.scene import Scene

SIZES = (10**6, 10**4)
PEER = "NumPy script"
FELT = {"body": 1.0, "mean-plane": -0.3}  # at h = 0, d/sigma


def pressed(scene: Scene, reference: str) -> Scene:
    """The scene with an interaction by which its mean surface feels at h = 0 what `FELT` says."""
    hard = Interaction(reference, bulk_modulus=scene.surface.E_star)
    model = replace(scene.theory, interaction=hard)
    sunk = model.compliance * float(model.alone.mean("load", FELT[reference]))
    softer = scene.surface.E_star * sunk / FELT[reference]
    return scene.replace(interaction=replace(hard, bulk_modulus=softer))


def cases(scene: Scene) -> dict[str, Scene]:
    """What is compared."""
    return {
        "without": scene,
        "from the body": pressed(scene, "body"),
        "from the mean plane": pressed(scene, "mean-plane"),
    }


def jobs(n: int) -> dict[str, Job]:
    """Surfaces of so many asperities drawn and kept as a run does, and by the script without interaction."""
    scenes = cases(S1.replace(n_asperities=n))
    return {name: block(scene, partial(kept, scene)) for name, scene in scenes.items()} | {PEER: script(n)}


def first_block() -> None:
    """Processor's seconds until a first block, without interaction and then with it."""
    for title, scene in (("without", S1), ("and with it", pressed(S1, "body"))):
        start = time.process_time()
        sampler_of(scene).block(0, 1)
        print(f"  {title:30s} {time.process_time() - start:6.1f} s")


def first_uses() -> None:
    """In new processes with an empty folder of compiled loops, and again with what is kept there."""
    with tempfile.TemporaryDirectory() as folder:
        for what in ("compiled", "read"):
            print(f"\nfirst block, loops {what}", flush=True)
            environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
            subprocess.run([sys.executable, __file__, "--first-block"], env=environment, check=True)


def ratios(rounds: int) -> dict[str, float]:
    """Seconds a surface, to those of the script: lower is better."""
    found = {}
    for n in SIZES:
        *names, peer = jobs(n)
        new = against(timed(jobs(n), rounds), peer, names)
        found |= {f"{name}, N = 1e{round(math.log10(n))}": value for name, value in new.items()}
    return found


def main() -> None:
    """Print every ratio."""
    parser = parser_of(__doc__)
    parser.add_argument("--first", action="store_true", help="also the first use, which compiles")
    parser.add_argument("--first-block", action="store_true", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.first_block:
        first_block()
        return
    for n in SIZES:
        show(f"N = 1e{round(math.log10(n))}, 41 separations", timed(jobs(n), asked.rounds), "without")
    if asked.first:
        first_uses()


if __name__ == "__main__":
    main()

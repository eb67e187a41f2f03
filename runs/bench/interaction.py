"""What it costs that asperities press each other down: ``python interaction.py [--quick] [--first]``.

Scene S1 (`samplers.py`) and the same with 10^4 asperities, timed in turn without interaction, with it at
effective separations, and at nominal ones, where each surface finds its own balance; ratios are medians over
rounds. The half-space is so soft that the interaction matters: sunk by the mean load at h = 0, asperities
feel 1 more where the body is the reference, and 0.3 less where the mean plane is. With ``--first``: seconds
of the processor until the first block of a new process, its loops compiled or, the second time, read.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from samplers import S1, compare

from analytic import InteractingModel, Interaction
from mcgw.ensemble.simulation import at_a_time, block_size, drawn_blocks, kept
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.scene import Scene

FELT = {"body": 1.0, "mean-plane": -0.3}  # at h = 0, d/sigma


def pressed(scene: Scene, reference: str, at: str) -> Scene:
    """The scene with an interaction by which its mean surface feels at h = 0 what `FELT` says."""
    hard = Interaction(reference, at=at, bulk_modulus=scene.surface.E_star)
    model = InteractingModel.of(scene.theory, hard)
    sunk = model.compliance * float(model.alone.mean("load", FELT[reference]))
    softer = scene.surface.E_star * sunk / FELT[reference]
    return replace(scene, interaction=replace(hard, bulk_modulus=softer))


def cases(scene: Scene) -> dict[str, Scene]:
    """What is compared."""
    return {
        "without": scene,
        "effective separations, body": pressed(scene, "body", "effective"),
        "nominal separations, body": pressed(scene, "body", "nominal"),
        "nominal separations, mean plane": pressed(scene, "mean-plane", "nominal"),
    }


def block(scene: Scene) -> tuple[Callable[[], object], int]:
    """Blocks as a run draws and keeps them, all that is prepared made beforehand."""
    sampler = sampler_of(scene)
    size = block_size(scene, sampler)
    surfaces = at_a_time(size)
    return (lambda: [kept(scene, part) for part in drawn_blocks(sampler, 0, surfaces, size)]), surfaces


def first_block() -> None:
    """Processor's seconds until a first block, without interaction and then with it."""
    for title, scene in (("without", S1), ("and at nominal separations", pressed(S1, "body", "nominal"))):
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


def main() -> None:
    """Print every ratio."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="three rounds in place of seven")
    parser.add_argument("--first", action="store_true", help="also the first use, which compiles")
    parser.add_argument("--first-block", action="store_true", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.first_block:
        first_block()
        return
    for n in (10**6, 10**4):
        scenes = cases(replace(S1, n_asperities=n))
        jobs = {name: block(scene) for name, scene in scenes.items()}
        compare(f"N = 1e{round(np.log10(n))}, 41 separations", jobs, "without", 3 if asked.quick else 7)
    if asked.first:
        first_uses()


if __name__ == "__main__":
    main()

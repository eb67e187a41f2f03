"""Speed and accuracy of three scenes, and whether what `mcgw tradeoff` advises holds.

``python runs/speed_and_accuracy.py [--seconds 20]`` writes to ``runs/speed`` the two pictures of each scene,
its prices and advice, and ``carried_out.csv``: every advice carried out 100 times (dear ones 5), in turn
with all other ways to the same answer. Times are medians of CPU time, all cores together, which other work
on the machine hardly changes.
"""

import argparse
import csv
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

import mcgw
from mcgw.figures.panels import save
from mcgw.figures.studies import tradeoff_figure
from mcgw.statistics.measured_ways import Answers, moved
from mcgw.statistics.tradeoff import Tradeoff, tradeoff
from mcgw.statistics.ways import TARGETS, WANTS, Advice, Way, advise, surfaces_for

HERE = Path(__file__).parent
FOLDER = HERE / "speed"
DEAREST, CHEAP = 60.0, 2.0  # CPU seconds of an advice that is carried out; of one carried out often
REPEATS, FEW = 100, 5  # how often it is; dear ones, and other ways in turn with it
SLOWER, WRONG = 10.0, 0.01


def scenes() -> dict[str, mcgw.Scene]:
    """The demo; the same with a hundredth of its area; and with 1e12 asperities."""
    demo = mcgw.load_scene(HERE / "demo.toml")
    return {
        "demo": demo,
        "few": demo.replace(n_asperities=300, title="Few contacts"),
        "many": demo.replace(
            n_asperities=10**12, n_surfaces=10, sampler="aggregate", title="1e12 asperities"
        ),
    }


def advised(study: Tradeoff) -> Iterator[tuple[Advice, list[float]]]:
    """Each advice that draws another number of surfaces or takes another way, with all its targets."""
    for want in WANTS:
        last: tuple[Advice, list[float]] | None = None
        for target in TARGETS:
            found = study.advice(want, target)
            if found.way is None or found.seconds > DEAREST:
                continue
            if last and (last[0].way, last[0].n_surfaces) == (found.way, found.n_surfaces):
                last[1].append(target)
                continue
            if last:
                yield last
            last = found, [target]
        if last:
            yield last


def carried_out(name: str, study: Tradeoff) -> Iterator[dict[str, Any]]:
    """A row for each advice: how often its target was reached, and seconds over what was said."""
    scene, answers = study.scene, Answers(study.scene)
    for advice, targets in advised(study):
        way, target = advice.way, min(targets)
        assert way is not None
        own = runner(answers, scene, way, advice.n_surfaces)
        others = {}
        for other in study.ways:
            if (
                (other.want, other.name) == (way.want, way.name)
                or other.want != way.want
                or other.floor > target
            ):
                continue
            n = surfaces_for(scene, way.want, target - other.floor) if other.draws else 0
            if other.measured and other.seconds(n) <= CHEAP:
                others[other.name] = runner(answers, scene, other, int(n))
        seconds, errors = [], []
        rival: dict[str, list[float]] = {other: [] for other in others}
        repeats = REPEATS if advice.seconds <= CHEAP else FEW
        for k in range(repeats):
            took, error = own(moved(scene, 1000 + k))
            seconds.append(took)
            errors.append(error)
            if k % (repeats // FEW) == 0:
                for other, run in others.items():
                    rival[other].append(run(moved(scene, 2000 + k))[0])
        medians = {other: float(np.median(times)) for other, times in rival.items()}
        best = min(medians, key=lambda other: medians[other], default="")
        reached: int | str = int(np.sum(np.array(errors) <= target)) if way.draws else ""
        yield {
            "scene": name, "want": way.want, "targets": " ".join(f"{x:g}" for x in targets), "way": way.name,
            "n_surfaces": advice.n_surfaces, "said_s": f"{advice.seconds:.3g}",
            "median_s": f"{np.median(seconds):.3g}",
            "ratio": f"{np.median(seconds) / advice.seconds:.2f}", "repeats": repeats,
            "reached": "exact" if way.want == "values" else reached,
            "next_best": best, "next_over_it": f"{medians[best] / np.median(seconds):.2f}" if best else "",
        }  # fmt: skip


def runner(answers: Answers, scene: mcgw.Scene, way: Way, n_surfaces: int) -> Any:
    """A function of a scene: seconds, and the error of one answer."""
    if way.draws:
        tasks = [answers.sampled(way.name, max(n_surfaces, 2))]
    else:
        tasks = [task for task in answers.without_surfaces() if task.way == way.name]
        tasks = [task for task in tasks if way.want in task.compare(task.call(moved(scene, 999)))]

    def run(moved_scene: mcgw.Scene) -> tuple[float, float]:
        (task,) = tasks
        start = process_time()
        found = task.call(moved_scene)
        took = process_time() - start
        errors = task.compare(found)
        return took, abs(errors.get(way.want, 0.0))

    run(moved(scene, 999))
    return run


def companions(name: str, study: Tradeoff) -> Iterator[dict[str, Any]]:
    """Advice for single surfaces if the way that is advised were 1 % wrong, or ten times slower."""
    first = study.advice("values", 1e-6)
    if first.way is None:
        return
    changes = {"1 % wrong": {"floor": WRONG}, "10 times slower": {
        "set_up": SLOWER * first.way.set_up, "each": SLOWER * first.way.each
    }}  # fmt: skip
    for what, change in changes.items():
        ways = [replace(w, **change) if w.name == first.way.name else w for w in study.ways]
        then = advise("values", 1e-6, ways, study.scene)
        yield {
            "scene": name,
            "advised": first.way.name,
            "were it": what,
            "advised then": then.way and then.way.name,
        }


def write(path: Path, rows: list[dict[str, Any]]) -> None:
    """A table of rows with the same keys."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main() -> None:
    """Write all files, and print the rows."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=20.0, help="time of each study (default: 20)")
    seconds = parser.parse_args().seconds
    FOLDER.mkdir(exist_ok=True)
    rows, changed = [], []
    for name, scene in scenes().items():
        study = tradeoff(scene, seconds=seconds)
        print(study.sheet(TARGETS).text(), flush=True)
        save(tradeoff_figure(study), FOLDER / f"{name}.png")
        study.table().write(FOLDER / f"{name}.csv")
        study.measurements().write(FOLDER / f"{name}-measured.csv")
        for row in carried_out(name, study):
            rows.append(row)
            print(*row.values(), flush=True)
        changed += companions(name, study)
        write(FOLDER / "carried_out.csv", rows)
        write(FOLDER / "companions.csv", changed)
    reached = [row["reached"] for row in rows if isinstance(row["reached"], int)]
    least, mean = min(reached), np.mean(reached)
    print(f"{len(rows)} rows; {len(reached)} draw: {least} of {REPEATS} at least, {mean:.1f} in the mean")


if __name__ == "__main__":
    main()

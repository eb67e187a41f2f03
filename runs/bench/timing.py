"""Jobs timed side by side in one process, in turn: what all benches share.

A job does its work once and returns the seconds that a unit of it took: a surface, a pixel, a value. A ratio
is the median, over the rounds, of the ratios within a round, so that whatever else the machine does for a
while weighs on both.
"""

import argparse
from collections.abc import Callable, Iterable
from time import perf_counter

import numpy as np

Job = Callable[[], float]
Times = dict[str, np.ndarray]  # seconds a unit, shape (rounds,)


def seconds(call: Callable[[], object], units: float = 1) -> float:
    """Wall time of a call, a unit."""
    start = perf_counter()
    call()
    return (perf_counter() - start) / units


def job(call: Callable[[], object], units: float = 1) -> Job:
    """A job that is a call, of so many units."""
    return lambda: seconds(call, units)


def timed(jobs: dict[str, Job], rounds: int) -> Times:
    """Every job once a round, after one that does not count: there loops compile and scenes are prepared."""
    turns = [[each() for each in jobs.values()] for _ in range(rounds + 1)][1:]
    return dict(zip(jobs, np.array(turns).T, strict=True))


def ratio(times: Times, name: str, peer: str) -> float:
    """How many times as long as its peer a job takes."""
    return float(np.median(times[name] / times[peer]))


def against(times: Times, peer: str, names: Iterable[str] | None = None) -> dict[str, float]:
    """Ratios of some jobs, or of all others, to a peer, by their names in the history: lower is better."""
    chosen = [name for name in times if name != peer] if names is None else names
    return {f"{name} / {peer}": ratio(times, name, peer) for name in chosen}


def show(title: str, times: Times, base: str) -> None:
    """Print what a unit of each job takes, and its ratio to one of them."""
    print(f"\n{title}")
    for name, values in times.items():
        low, middle, high = np.quantile(values / times[base], [0, 0.5, 1])
        print(f"  {name:42} {np.median(values) * 1e6:12.1f} us   {middle:8.3g} x  ({low:.3g} ... {high:.3g})")


def parser_of(doc: str) -> argparse.ArgumentParser:
    """Options of a bench that is run by itself."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=7, help="how often each job is timed (default: 7)")
    return parser

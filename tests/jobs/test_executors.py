"""Executors: threads, processes and dask give the same digest, whatever happens to their workers."""

import multiprocessing
import os
import signal
import time
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from contextlib import nullcontext
from pathlib import Path

import pytest
from oracles.begun_runs import digest
from oracles.inside import Jobs, Signals, Span, Values, dask_executor, drive, heed_signals
from oracles.lost_workers import deadly, deadly_once

import mcgw
from mcgw.errors import RunError, StoppedError

SIZE = 8
HERE = Path(__file__).parents[1]
SPANS = [Span(8 * i, 8) for i in range(6)]


@pytest.fixture(autouse=True)
def _small_blocks(blocks_of, monkeypatch):
    blocks_of(SIZE)
    # Spawned workers import this package from here.
    monkeypatch.setenv("PYTHONPATH", str(HERE.parent))


@pytest.mark.site
def test_killed_dask_workers_are_replaced(make_scene, tmp_path):
    """One each time a few more blocks are done, of some tenths of a second: long enough to be killed in."""
    distributed = pytest.importorskip("distributed")
    scene = make_scene(sampler="direct", n_asperities=250_000, n_surfaces=9 * SIZE, separations=(1.0, 2.0))
    killed = []

    def kill(done, _):
        if done and done % (3 * SIZE) == 0:
            pids = [nanny.process.process.pid for nanny in cluster.workers.values()]
            killed.append(next(pid for pid in pids if pid not in killed))
            os.kill(killed[-1], signal.SIGKILL)

    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs="CRITICAL"
        ) as cluster,
        dask_executor(cluster.scheduler_address) as executor,
    ):
        mcgw.run(scene, tmp_path / "e.h5", executor=executor, progress=kill)
        assert executor.submit(sum, (1, 2)).result(timeout=30) == 3  # it stays open
    assert len(killed) == 3
    mcgw.run(scene, tmp_path / "threads.h5")
    assert digest(tmp_path / "e.h5") == digest(tmp_path / "threads.h5")


def test_dask_that_is_not_there_is_one_line(missing):
    told = r"^--dask ftp://x: no scheduler answers|^dask is not installed"
    with pytest.raises(RunError, match=told), dask_executor("ftp://x"):
        pass
    missing("distributed")
    told = r"dask is not installed: in a clone of mcgw, pip install -e '\.\["
    with pytest.raises(RunError, match=told), dask_executor("tcp://127.0.0.1:1"):
        pass


def test_any_executor_draws_the_surfaces_that_this_process_draws(make_scene, tmp_path):
    scene = make_scene(n_surfaces=5 * SIZE)
    with ThreadPoolExecutor(3) as pool:
        drawn = mcgw.run(scene, tmp_path / "e.h5", executor=pool)
        assert pool.submit(abs, -1).result(timeout=60) == 1  # it stays open
    assert (drawn.load == mcgw.simulate(scene).load).all()


class Now(Executor):
    """Does a task when it is submitted; some blocks are lost so many times, after some it is broken."""

    def __init__(self, lost=None, takes=99):
        self.lost, self.takes, self.begun = dict(lost or {}), takes, []

    def submit(self, task, /, *arguments):
        if len(self.begun) == self.takes:
            raise BrokenExecutor("no worker\nis left")
        first = arguments[1]
        self.begun.append(first)
        future = Future()
        if self.lost.get(first, 0):
            self.lost[first] -= 1
            future.set_exception(KeyError("worker 7\nwas lost"))
        else:
            future.set_result(task(*arguments))
        return future


def driven(executor, done, task=abs):
    drive(
        executor, SPANS, task, lambda span: (span.first,), lambda span, _: done.append(span.first), Signals()
    )


@pytest.mark.parametrize(
    ("executor", "told", "kept"),
    [
        (Now(lost={8: 1, 24: 1}), None, [0, 8, 16, 24, 32, 40]),
        (Now(lost={8: 2, 24: 2}), r"^surfaces 24 \.\.\. 31 were lost twice by the executor \(KeyError: ",
         [0, 16, 32, 40]),
        (Now(takes=3), r"^the executor takes no more work \(BrokenExecutor: no worker\); finished", [])
    ]
)  # fmt: skip
def test_a_block_that_is_lost_is_submitted_once_more_when_the_others_are_done(executor, told, kept):
    done = []
    with pytest.raises(RunError, match=told) if told else nullcontext():
        driven(executor, done)
    assert sorted(done) == kept
    assert told or sorted(executor.begun) == [0, 8, 8, 16, 24, 24, 32, 40]


@pytest.mark.parametrize("mark", ["once", None])
def test_a_task_that_kills_its_worker_is_tried_once_more_and_given_up(mark, tmp_path):
    """A worker that is killed is replaced; a task that kills two is the only one that is not done."""
    done, given_up = [], r"16 \.\.\. 23 were lost twice by the executor \(BrokenProcessPool"
    task, words = (deadly_once, (str(tmp_path / mark),)) if mark else (deadly, ())
    with Jobs(1) as executor, nullcontext() if mark else pytest.raises(RunError, match=given_up):
        drive(executor, SPANS[:3], task, lambda s: (s.first, *words), lambda s, _: done.append(s), Signals())
    assert sorted(done) == [span for span in SPANS[:3] if mark or span.first != 16]


@pytest.mark.parametrize("pool", [ThreadPoolExecutor(1), Now()])
def test_an_error_of_a_task_ends_the_run_and_what_is_not_begun_is_dropped(pool):
    begun = []

    def task(first):
        begun.append(first)
        time.sleep(0.01)
        return 1 / first

    with pool, pytest.raises(ZeroDivisionError):
        driven(pool, [], task)
    assert len(begun) < len(SPANS) or isinstance(pool, Now)


def test_a_long_block_is_left_when_the_run_is_interrupted(make_scene, tmp_path):
    """It asks between two surfaces whether to go on."""
    scene = make_scene(sampler="direct", n_asperities=1_000_000, n_surfaces=64 * SIZE)

    def stop(done, _):
        signal.raise_signal(signal.SIGTERM)

    begin = time.monotonic()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Values, "rows", 32 * SIZE)
        with pytest.raises(StoppedError, match=r"^terminated: 0 of 512 surfaces are kept"):
            mcgw.run(scene, tmp_path / "e.h5", progress=stop)
    assert time.monotonic() - begin < 10


def test_workers_are_killed_at_the_end_whatever_they_do():
    before = set(multiprocessing.active_children())
    with Jobs(1) as executor:
        executor.submit(time.sleep, 600)
        (worker,) = set(multiprocessing.active_children()) - before
    end = time.monotonic() + 30
    while worker.exitcode is None and time.monotonic() < end:  # the pool's own thread waits for it, too
        time.sleep(0.01)
    assert worker.exitcode == -signal.SIGKILL


@pytest.mark.parametrize(
    ("number", "word", "code"), [(signal.SIGINT, "interrupted", 130), (signal.SIGTERM, "terminated", 143)]
)
def test_a_signal_is_noted_and_a_second_one_acts_at_once(number, word, code):
    before = signal.getsignal(number)
    with heed_signals() as signals:
        signals.check("all is kept")
        signal.raise_signal(number)
        with pytest.raises(StoppedError, match=f"^{word}: all is kept$") as caught:
            signals.check("all is kept")
        assert caught.value.code == code
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(number)
    assert signal.getsignal(number) == before


def test_when_a_signal_comes_no_more_blocks_are_begun():
    signals, done = Signals(), []

    def note(span, first):
        done.append(first)
        signals.number = signal.SIGTERM

    drive(Now(), SPANS, abs, lambda span: (span.first,), note, signals, in_hand=2)
    assert done == [0, 8]

"""Engines: threads, processes and dask give the same digest, whatever happens to their workers."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import closing, nullcontext
from pathlib import Path

import pytest
from begun_runs import digest
from lost_workers import deadly, deadly_once

import mcgw
from mcgw.ensemble.simulation import Values
from mcgw.errors import RunError
from mcgw.jobs.dask_engine import Dask, check_address
from mcgw.jobs.driver import Signals, drive
from mcgw.jobs.engines import Processes, Threads
from mcgw.jobs.running import run
from mcgw.store.disk import parts_of
from mcgw.store.shards import Span

SIZE, SURFACES = 8, 72
HERE = Path(__file__).parent
SPANS = [Span(8 * i, 8) for i in range(6)]


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch):
    monkeypatch.setattr(Values, "rows", SIZE)
    # Spawned workers import this package from here.
    monkeypatch.setenv("PYTHONPATH", str(HERE.parent))


@pytest.fixture
def scene(make_scene):
    """Blocks of some tenths of a second: long enough to be killed in."""
    return make_scene(sampler="direct", n_asperities=250_000, n_surfaces=SURFACES, separations=(1.0, 2.0))


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """Digest from threads."""
    found = []

    def of(scene):
        if not found:
            path = tmp_path_factory.mktemp("threads") / "e.h5"
            run(scene, path)
            found.append(digest(path))
        return found[0]

    return of


def kill_one_now_and_then(pids, times):
    """Progress that kills a worker each time a few more blocks are done."""
    killed = []

    def progress(done, _):
        if done and done % (3 * SIZE) == 0 and len(killed) < times:
            alive = [pid for pid in pids() if pid not in killed]
            killed.append(alive[0])
            os.kill(alive[0], signal.SIGKILL)

    return progress, killed


@pytest.mark.slow
def test_a_killed_process_is_replaced(scene, tmp_path, expected):
    with closing(Processes(2)) as engine:
        progress, killed = kill_one_now_and_then(lambda: list(engine._pool._processes), 1)
        run(scene, tmp_path / "e.h5", engine=engine, progress=progress)
    assert len(killed) == 1
    assert digest(tmp_path / "e.h5") == expected(scene)


@pytest.mark.site
def test_killed_dask_workers_are_replaced(scene, tmp_path, expected):
    pytest.importorskip("distributed")
    with closing(Dask(workers=2)) as engine:
        nannies = engine._cluster.workers
        progress, killed = kill_one_now_and_then(lambda: [x.process.process.pid for x in nannies.values()], 3)
        run(scene, tmp_path / "e.h5", engine=engine, progress=progress)
    assert len(killed) == 3
    assert digest(tmp_path / "e.h5") == expected(scene)


@pytest.mark.parametrize("word", ["dask", "tcp://127.0.0.1:8786"])
def test_a_word_or_an_address_asks_for_dask(word, make_scene, tmp_path, monkeypatch):
    asked = []

    class Recorded(Threads):
        def __init__(self, *args, **options):
            super().__init__()
            asked.append((args, options))

        def close(self):
            super().close()
            asked.append("closed")

    monkeypatch.setattr("mcgw.jobs.dask_engine.Dask", Recorded)
    mcgw.run(make_scene(n_surfaces=3 * SIZE), tmp_path / "e.h5", engine=word, threads=3)
    assert asked == [((None if word == "dask" else word,), {"workers": 3}), "closed"]


def test_the_rest_of_a_task_is_done_beside_the_next_one_in_order():
    """Each rest waits until the next task has begun; with one thread for both this would wait for ever."""
    begun, finished = [threading.Event() for _ in range(4)], []

    def task(i):
        begun[i].set()

        def rest():
            assert i == 3 or begun[i + 1].wait(timeout=30)
            finished.append(i)
            return -i

        return rest

    with closing(Threads()) as engine:
        answers = [engine.submit(task, i) for i in range(4)]
        assert [answer.result(timeout=60) for answer in answers] == [0, -1, -2, -3]
    assert finished == [0, 1, 2, 3]


def test_an_error_in_either_half_is_the_task_s():
    def fail():
        raise OSError("full")

    with closing(Threads()) as engine:
        answers = [engine.submit(lambda: fail), engine.submit(fail), engine.submit(lambda: 3)]
        for answer in answers[:2]:
            with pytest.raises(OSError, match="full"):
                answer.result(timeout=30)
        assert answers[2].result(timeout=30) == 3


def free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


class Cluster:
    """A scheduler and two workers as processes of their own."""

    def __init__(self, folder):
        self.address = f"tcp://127.0.0.1:{free_port()}"
        self.folder = folder
        port = self.address.rsplit(":", 1)[1]
        self.scheduler = self._start("scheduler", "--port", port, "--host", "127.0.0.1", "--no-dashboard")
        words = ("worker", self.address, "--nworkers", "2", "--nthreads", "1", "--no-dashboard")
        self.workers = self._start(*words, "--host", "127.0.0.1", "--death-timeout", "20")

    def _start(self, *words):
        call = [sys.executable, "-m", "distributed.cli.dask_" + words[0], *words[1:]]
        env = os.environ | {"PYTHONPATH": str(HERE.parent), "PYTHONWARNINGS": "ignore"}
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": self.folder}
        return subprocess.Popen(call, env=env, start_new_session=True, **quiet)

    def close(self):
        for process in (self.scheduler, self.workers):
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def connected(cluster):
    """Wait for the scheduler: it needs a moment to start."""
    until = time.monotonic() + 30
    while True:
        try:
            return Dask(cluster.address)
        except RunError:
            assert time.monotonic() < until


@pytest.mark.site
def test_a_lost_scheduler_is_one_line_and_the_run_goes_on_with_another(scene, tmp_path, expected):
    pytest.importorskip("distributed")
    path, first = tmp_path / "e.h5", Cluster(tmp_path)

    def kill_midway(done, _):
        if done >= SURFACES // 3 and first.scheduler.poll() is None:
            os.killpg(first.scheduler.pid, signal.SIGKILL)

    lost = r"^scheduler lost \(\w+\); start it again and repeat the command$"
    with closing(first), closing(connected(first)) as engine, pytest.raises(RunError, match=lost):
        run(scene, path, engine=engine, progress=kill_midway)
    kept = len(list(parts_of(path).glob("shards/*.h5")))
    assert SURFACES // 3 // SIZE <= kept < SURFACES // SIZE
    with closing(Cluster(tmp_path)) as second, closing(connected(second)) as engine:
        run(scene, path, engine=engine)
    assert digest(path) == expected(scene)


@pytest.mark.parametrize("mark", ["once", None])
def test_a_task_that_kills_its_worker_is_tried_again_and_given_up(mark, tmp_path):
    """A worker that is killed is replaced; a task that kills three is the only one that is not done."""
    done, given_up = [], r"16 \.\.\. 23 killed the worker 3 times; 1 block is not"
    task, words = (deadly_once, (str(tmp_path / mark),)) if mark else (deadly, ())
    with closing(Processes(1)) as engine, nullcontext() if mark else pytest.raises(RunError, match=given_up):
        drive(engine, SPANS[:3], task, lambda s: (s.first, *words), lambda s, _: done.append(s), Signals())
    assert sorted(done) == [span for span in SPANS[:3] if mark or span.first != 16]


def test_an_error_of_a_task_ends_the_run():
    with closing(Threads()) as engine, pytest.raises(ZeroDivisionError):
        drive(engine, SPANS, lambda first: 1 / first, lambda s: (s.first,), lambda s, _: None, Signals())


def test_threads_stop_within_the_grace_of_a_long_block():
    signals, begin = Signals(), time.monotonic()
    signals.number = signal.SIGINT
    with closing(Threads()) as engine:
        drive(engine, SPANS, time.sleep, lambda s: (30,), lambda s, _: None, signals)
    assert time.monotonic() - begin < 10


def test_addresses_that_are_fit():
    for address in ("tcp://127.0.0.1:8786", "tcp://localhost:8786", "tcp://[::1]:8786", "tls://node7:8786"):
        check_address(address)
    check_address("tcp://10.1.2.3:8786", insecure=True)


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("tcp://10.1.2.3:8786", "a remote address without encryption; use tls://"),
        ("tcp://node7:8786", "--insecure"),
        ("tcp://0.0.0.0:8786", "a remote address"),
        ("tcp://127.0.0.1.example.org:8786", "a remote address"),
        ("http://127.0.0.1:8786", "give tcp://HOST:PORT or tls://HOST:PORT"),
        ("127.0.0.1:8786", "give tcp://"),
        ("tcp://127.0.0.1", "give tcp://"),
        ("tcp://[::1", "give tcp://"),
        ("tcp://127.0.0.1:99999", "give tcp://"),
    ],
)
def test_addresses_that_are_not(address, message):
    with pytest.raises(ValueError, match="--scheduler") as caught:
        check_address(address)
    assert message in str(caught.value)


def test_dask_without_its_scheduler_is_one_line(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)  # it cannot be imported
    with pytest.raises(RunError, match=r'dask is not installed: pip install "mcgw\[dask\]"'):
        Dask(workers=1)


@pytest.mark.parametrize("engine", [Processes, lambda n: Dask(workers=n)])
def test_no_workers_are_an_error(engine):
    with pytest.raises(ValueError, match="= 0: give a whole number >= 1"):
        engine(0)

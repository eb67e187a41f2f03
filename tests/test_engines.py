"""Engines: threads, processes and dask give the same digest, whatever happens to their workers."""

import multiprocessing
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from concurrent.futures import CancelledError, Future
from contextlib import closing, nullcontext
from pathlib import Path
from types import SimpleNamespace

import numba
import pytest
from begun_runs import digest
from lost_workers import deadly, deadly_once

import mcgw
from mcgw.ensemble.simulation import Values
from mcgw.errors import RunError, StoppedError
from mcgw.jobs import dask_engine
from mcgw.jobs.dask_engine import Dask, check_address
from mcgw.jobs.driver import Signals, drive, heed_signals
from mcgw.jobs.engines import EngineLostError, Processes, Threads, WorkerDiedError
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


WORDS = {
    "dask": ("dask_engine.Dask", (None,), "workers"),
    "tcp://127.0.0.1:8786": ("dask_engine.Dask", ("tcp://127.0.0.1:8786",), "workers"),
    "processes": ("driver.Processes", (), None),
}


@pytest.mark.parametrize("threads", [3, None])
@pytest.mark.parametrize("word", WORDS)
def test_a_word_or_an_address_asks_for_workers(word, threads, make_scene, tmp_path, monkeypatch):
    """As many as there are threads, unless their number is given."""
    asked, (name, arguments, option) = [], WORDS[word]

    class Recorded(Threads):
        def __init__(self, *args, **options):
            super().__init__()
            asked.append((args, options))

        def close(self):
            super().close()
            asked.append("closed")

    monkeypatch.setattr(f"mcgw.jobs.{name}", Recorded)
    mcgw.run(make_scene(n_surfaces=3 * SIZE), tmp_path / "e.h5", engine=word, threads=threads)
    many = threads or numba.get_num_threads()
    assert asked == [((*arguments, *(() if option else (many,))), {option: many} if option else {}), "closed"]


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


class Slow:
    """Answers when so many tasks wait; workers die of some."""

    width = 2

    def __init__(self, patience, deadly=()):
        self.patience, self.deadly, self.waiting, self.events = patience, deadly, [], []

    def submit(self, task, first):
        future = Future()
        self.events.append(f"begin {first}")
        self.waiting.append((future, first))
        if len(self.waiting) == self.patience:
            for answer, number in self.waiting:
                if number in self.deadly:
                    answer.set_exception(WorkerDiedError())
                else:
                    answer.set_result(task(number))
            self.waiting.clear()
        return future


def test_as_many_blocks_are_in_hand_as_an_engine_asks_for():
    engine, done = Slow(2), []

    def note(span, answer):
        assert answer == -span.first
        engine.events.append(f"end {span.first}")
        done.append(span)

    drive(engine, SPANS, lambda first: -first, lambda span: (span.first,), note, Signals())
    order = [f"begin {k}" for k in (0, 8)]
    order += [word for k in (0, 8, 16, 24) for word in (f"end {k}", f"begin {k + 16}")]
    assert engine.events == [*order, "end 32", "end 40"]
    assert done == SPANS


def test_blocks_that_kill_their_workers_are_counted():
    """Each is tried three times, alone; the others are done all the same."""
    engine, done = Slow(1, deadly=(8, 24)), []
    told = r"^surfaces 8 \.\.\. 15 killed the worker 3 times; 2 blocks are not done, all others are$"
    with pytest.raises(RunError, match=told):
        drive(
            engine, SPANS, abs, lambda span: (span.first,), lambda span, _: done.append(span.first), Signals()
        )
    assert sorted(done) == [0, 16, 32, 40]
    begun = [event.split()[1] for event in engine.events]
    assert {first: begun.count(first) for first in begun} == {
        "0": 1,
        "8": 3,
        "16": 1,
        "24": 3,
        "32": 1,
        "40": 1,
    }


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


def test_workers_are_killed_at_the_end_whatever_they_do():
    before = set(multiprocessing.active_children())
    engine = Processes(1)
    assert engine.width == 2
    engine.submit(time.sleep, 600)
    (worker,) = set(multiprocessing.active_children()) - before
    engine.close()
    end = time.monotonic() + 30
    while worker.exitcode is None and time.monotonic() < end:  # the pool's own thread waits for it, too
        time.sleep(0.01)
    assert worker.exitcode == -signal.SIGKILL


@pytest.mark.parametrize("engine", [Processes, lambda n: Dask(workers=n)])
def test_no_workers_are_an_error(engine):
    with pytest.raises(ValueError, match="= 0: give a whole number >= 1"):
        engine(0)


# --- dask by a stand-in: what is asked of it, and what becomes of its answers ---------------------------


class Inner(Future):
    """A future of dask; it can be released."""

    released = 0

    def release(self):
        self.released += 1


@pytest.fixture
def dask(monkeypatch):
    """In place of `distributed`, which need not be there: it notes what it is asked, and computes nothing."""
    noted, answers = [], []

    class Client:
        asynchronous, status, threads = False, "running", [3, 2]

        def __init__(self, *args, **options):
            noted.append(("client", *args, options))

        def nthreads(self):
            if self.threads is None:
                raise OSError
            return dict(enumerate(self.threads))

        def submit(self, task, *arguments, **options):
            answers.append(Inner())
            noted.append((task, arguments, options))
            return answers[-1]

        def close(self, **options):
            noted.append(("client closed", options))

    class LocalCluster:
        dashboard_link = "http://127.0.0.1:1/status"

        def __init__(self, **options):
            noted.append(("cluster", options))

        def close(self, **options):
            noted.append(("cluster closed", options))

    errors = {name: type(name, (Exception,), {}) for name in ("Killed", "Closed", "Cancelled")}
    stand_in = SimpleNamespace(
        Client=Client, LocalCluster=LocalCluster, KilledWorker=errors["Killed"], noted=noted, answers=answers,
        comm=SimpleNamespace(CommClosedError=errors["Closed"]),
        client=SimpleNamespace(FutureCancelledError=errors["Cancelled"]),
    )  # fmt: skip
    monkeypatch.setitem(sys.modules, "distributed", stand_in)
    return stand_in


@pytest.mark.parametrize("pages", [True, False])
@pytest.mark.parametrize("quiet", [True, False])
def test_a_cluster_of_our_own_is_on_this_machine_alone(quiet, pages, dask, monkeypatch):
    monkeypatch.setattr(dask_engine, "find_spec", lambda name: name if pages and name == "bokeh" else None)
    engine = Dask(workers=3, quiet=quiet)
    (_, options), (_, cluster, client) = dask.noted
    assert options == {
        "n_workers": 3,
        "threads_per_worker": 1,
        "processes": True,
        "host": "127.0.0.1",
        "dashboard_address": "127.0.0.1:0",
        "scheduler_kwargs": {"dashboard": pages},
        "silence_logs": "CRITICAL" if quiet else "WARNING",
        "config": {"distributed.worker.profile.enabled": False},
    }
    assert (type(cluster), client) == (dask.LocalCluster, {"timeout": "10s", "set_as_default": False})
    assert engine.dashboard == ("http://127.0.0.1:1/status" if pages else "")
    dask.noted.clear()
    engine.close()
    assert dask.noted == [("client closed", {"timeout": 2}), ("cluster closed", {"timeout": 5})]


def test_a_scheduler_elsewhere_is_left_at_work(dask, monkeypatch):
    engine, address = Dask("tcp://127.0.0.1:8786"), "tcp://127.0.0.1:8786"
    assert dask.noted == [("client", address, {"timeout": "10s", "set_as_default": False})]
    assert engine.dashboard == ""
    engine.close()
    assert dask.noted[1:] == [("client closed", {"timeout": 2})]

    def nobody(*_, **__):
        raise OSError

    monkeypatch.setattr(dask, "Client", nobody)
    with pytest.raises(RunError, match=f"^{address}: no scheduler answers; start it"):
        Dask(address)


def test_workers_are_counted_again_after_five_seconds(dask, monkeypatch):
    """Twice their threads; the old number as long as nobody answers, and two where there is none."""
    clock = [1.0]
    monkeypatch.setattr(dask_engine, "monotonic", lambda: clock[0])
    client = dask.Client()
    engine = Dask(client)
    for now, threads, width in (
        (1.0, [3, 2], 10), (5.9, [1], 10), (6.0, [1], 10), (6.1, [4], 8), (11.0, [1], 8), (11.2, None, 8),
        (99.0, [], 2),
    ):  # fmt: skip
        clock[0], client.threads = now, threads
        assert engine.width == width


OUTCOMES = {
    "Killed": (WorkerDiedError, ""),
    "Closed": (EngineLostError, "Closed"),
    "Cancelled": (EngineLostError, "Cancelled"),
    "CancelledError": (EngineLostError, "CancelledError"),
    "ZeroDivisionError": (ZeroDivisionError, ""),
}


def test_what_becomes_of_a_task_of_dask(dask):
    """Its result, or its error in our words; what it leaves with dask is let go of."""
    engine = Dask(dask.Client())
    raised = {"Killed": dask.KilledWorker, "Closed": dask.comm.CommClosedError}
    raised |= {"Cancelled": dask.client.FutureCancelledError, "CancelledError": CancelledError}
    for name, (kind, words) in OUTCOMES.items():
        outer = engine.submit(max, 1, 2)
        assert dask.noted[-1] == (max, (1, 2), {"pure": False})
        assert not outer.done()
        dask.answers[-1].set_exception(raised.get(name, ZeroDivisionError)())
        with pytest.raises(kind) as caught:
            outer.result(timeout=10)
        assert str(caught.value) == words
    outer = engine.submit(max, 1, 2)
    dask.answers[-1].set_result(2)
    assert outer.result(timeout=10) == 2
    engine.submit(max, 1, 2)  # which is not done when the run ends
    dask.noted.clear()
    engine.close()
    assert [answer.released for answer in dask.answers] == [1] * len(dask.answers)
    assert dask.noted == []  # the client stays open


@pytest.mark.parametrize("error", [OSError, RuntimeError, CancelledError])
def test_a_scheduler_that_takes_no_task_is_lost(error, dask, make_scene, tmp_path, monkeypatch):
    def submit(*_, **__):
        raise error

    monkeypatch.setattr(dask.Client, "submit", submit)
    lost = rf"^scheduler lost \({error.__name__}\); start it again and repeat the command$"
    with pytest.raises(RunError, match=lost):
        mcgw.run(make_scene(n_surfaces=3 * SIZE), tmp_path / "e.h5", engine=dask.Client())


def test_a_client_draws_the_surfaces_that_threads_draw(dask, make_scene, tmp_path, monkeypatch):
    def submit(_, task, *arguments, pure):
        dask.answers.append(Inner())
        dask.answers[-1].set_result(task(*arguments))
        return dask.answers[-1]

    monkeypatch.setattr(dask.Client, "submit", submit)
    scene = make_scene(n_surfaces=3 * SIZE)
    drawn = mcgw.run(scene, tmp_path / "e.h5", engine=dask.Client())
    assert (drawn.load == mcgw.simulate(scene).load).all()
    assert len(dask.answers) == 3


@pytest.mark.parametrize(
    ("fact", "told"),
    [({"asynchronous": True}, "client is asynchronous; give"), ({"status": "closed"}, "client is closed")],
)
def test_a_client_that_cannot_be_used_is_refused(fact, told, dask):
    client = dask.Client()
    vars(client).update(fact)
    with pytest.raises(ValueError, match=f"^engine: .*{told}"):
        Dask(client)


# --- signals ---------------------------------------------------------------------------------------------


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


def test_blocks_in_hand_when_a_signal_comes_are_kept():
    """Three of six: one that is done, and those that were begun with it, but for the one that fails."""
    signals, done = Signals(), []

    def note(span, first):
        done.append(first)
        signals.number = signal.SIGTERM

    def task(first):
        return lambda: first // (first != 8)

    with closing(Threads()) as engine:
        drive(engine, SPANS, task, lambda span: (span.first,), note, signals)
    assert done == [0, 16]

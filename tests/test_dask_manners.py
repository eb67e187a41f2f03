"""Dask as its users expect: a client is taken and left as it was, and so is all that the process shares."""

import copy
import logging
import socket
import warnings
from contextlib import ExitStack, closing, contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path

import pytest
from begun_runs import digest

import mcgw
from mcgw.ensemble.simulation import Values
from mcgw.jobs.dask_engine import Dask

distributed = pytest.importorskip("distributed")
pytestmark = pytest.mark.site
SIZE = 8
NO_PAGES = {"dashboard_address": "127.0.0.1:0", "scheduler_kwargs": {"dashboard": False}}  # 8787 may be busy


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch):
    monkeypatch.setattr(Values, "rows", SIZE)
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[1]))


@pytest.fixture(autouse=True, scope="module")
def _its_usual_port_is_taken():
    with ExitStack() as held:
        with suppress(OSError):  # somebody else has it: as good
            held.enter_context(socket.create_server(("", 8787)))
        yield


@pytest.fixture
def scene(make_scene):
    return make_scene(n_surfaces=6 * SIZE)


def shared_state():
    """What dask, logging and warnings have in common for the whole process."""
    import dask

    def handlers(logger):  # but for the records that each worker and scheduler of dask keeps of itself
        return [(id(h), h.level) for h in logger.handlers if not isinstance(h, distributed.node.DequeHandler)]

    loggers = {
        name: (logger.level, logger.disabled, logger.propagate, handlers(logger))
        for name, logger in {**logging.root.manager.loggerDict, "": logging.root}.items()
        if isinstance(logger, logging.Logger)
    }
    default = distributed.client._get_global_client()
    return {
        "configuration": copy.deepcopy(dask.config.config),
        "loggers": loggers,
        "disabled": logging.root.manager.disable,
        "warnings": list(warnings.filters),
        "default client": default,
    }


@pytest.fixture
def untouched():
    """All of it is after a test as it was before; loggers that are new are dask's own affair."""
    with distributed.LocalCluster(n_workers=0, processes=False, **NO_PAGES):
        pass  # whatever dask imports late
    before = shared_state()
    yield
    after = shared_state()
    assert before["loggers"] == {name: after["loggers"][name] for name in before["loggers"]}
    for name in before.keys() - {"loggers"}:
        assert after[name] == before[name], name


@contextmanager
def a_client(n):
    """Of a cluster of so many workers, each with as many threads, in this process."""
    options = {"n_workers": n, "threads_per_worker": n, **NO_PAGES}
    with (
        distributed.LocalCluster(**options, processes=False) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        yield client


def test_a_client_is_taken_and_left_open(scene, tmp_path):
    with a_client(2) as client:
        within, link = shared_state(), client.dashboard_link
        mcgw.run(scene, tmp_path / "client.h5", engine=client)
        found = shared_state()
        assert {**found, "loggers": None} == {**within, "loggers": None}
        assert all(found["loggers"][name] == within["loggers"][name] for name in within["loggers"])
        assert (client.status, client.dashboard_link) == ("running", link)
        assert client.submit(sum, (1, 2)).result(timeout=30) == 3
    mcgw.run(scene, tmp_path / "threads.h5")
    assert digest(tmp_path / "client.h5") == digest(tmp_path / "threads.h5")


def test_a_client_that_is_of_no_use(scene, tmp_path):
    with a_client(1) as client:
        client.close()
        with pytest.raises(ValueError, match=r"^engine: this client is closed; give a connected client$"):
            mcgw.run(scene, tmp_path / "e.h5", engine=client)
    assert not list(tmp_path.iterdir())


def test_what_is_not_done_is_dropped_and_the_client_lives(scene, tmp_path):
    with a_client(1) as client:

        def fail(done, total):
            if done > SIZE:
                raise ZeroDivisionError

        with pytest.raises(ZeroDivisionError):
            mcgw.run(scene, tmp_path / "e.h5", engine=client, progress=fail)
        assert client.submit(sum, (1, 2)).result(timeout=30) == 3
        assert all(key.startswith("sum") for key in client.futures)


def test_a_cluster_of_our_own(scene, tmp_path, untouched, capfd):
    """Four workers, more than there are cores."""
    mcgw.run(scene, tmp_path / "dask.h5", engine="dask", threads=4)
    mcgw.run(scene, tmp_path / "threads.h5")
    assert digest(tmp_path / "dask.h5") == digest(tmp_path / "threads.h5")
    assert capfd.readouterr().err == ""


def test_its_dashboard_is_on_this_machine_if_dask_can_draw_it():
    with closing(Dask(workers=1)) as engine:
        place = engine.dashboard[:17]
    assert place == ("http://127.0.0.1:" if find_spec("bokeh") else "")

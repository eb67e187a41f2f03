"""The engine of dask.distributed: workers on this machine or on a cluster with a shared disk."""

import ipaddress
import sys
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from contextlib import suppress
from importlib import import_module
from importlib.util import find_spec
from time import monotonic
from typing import Any
from urllib.parse import urlsplit

from mcgw.errors import RunError
from mcgw.jobs.engines import EngineLostError, pass_on

# For our own workers: the profiler keeps frames and thus HDF5 handles.
_WORKERS = {"distributed.worker.profile.enabled": False}
_ASK_AGAIN = 5.0  # seconds between counts of the workers


class Dask:
    """Workers behind a dask scheduler; nothing of dask's configuration or logging is changed.

    Parameters
    ----------
    scheduler : str or distributed.Client, optional
        Address of a running one, or a client of it, which is left open. Default: a cluster on this machine,
        that listens to it alone, and ends with `close`.
    workers : int, optional
        Processes of that cluster.
    insecure : bool, optional
        Talk to a scheduler elsewhere without encryption.
    quiet : bool, optional
        Whether that cluster logs nothing. Default: warnings, as dask's own.

    Raises
    ------
    ValueError
        If the address or the client is not fit for use.
    RunError
        If dask is not installed or nobody answers.
    """

    def __init__(
        self, scheduler: Any = None, *, workers: int = 2, insecure: bool = False, quiet: bool = False
    ) -> None:
        if isinstance(scheduler, str):
            check_address(scheduler, insecure=insecure)
        if workers < 1:
            raise ValueError(f"workers = {workers}: give a whole number >= 1")
        try:
            distributed: Any = import_module("distributed")
        except ImportError:
            raise RunError('dask is not installed: pip install "mcgw[dask]"') from None
        self._cluster: Any = None
        if scheduler is None:
            self._cluster = distributed.LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",  # not the default 8787, which may be taken
                scheduler_kwargs={"dashboard": _has_pages()},
                silence_logs="CRITICAL" if quiet else "WARNING",
                config=_WORKERS,
            )
        self._borrowed = scheduler is not None and not isinstance(scheduler, str)
        if self._borrowed:
            self._client: Any = _fit(scheduler)
        else:
            try:
                self._client = distributed.Client(
                    self._cluster or scheduler, timeout="10s", set_as_default=False
                )
            except OSError:
                raise RunError(
                    f"{scheduler}: no scheduler answers; start it (dask scheduler), then repeat the command"
                ) from None
        self._pending: set[Any] = set()
        self._asked, self._threads = -_ASK_AGAIN, 1
        self._died = distributed.KilledWorker
        closed = distributed.comm.CommClosedError
        self._lost = (CancelledError, distributed.client.FutureCancelledError, closed)

    @property
    def dashboard(self) -> str:
        """Address of the dashboard of our own cluster; empty if there is none."""
        return str(self._cluster.dashboard_link) if self._cluster is not None and _has_pages() else ""

    @property
    def width(self) -> int:
        """Twice the number of threads, so that none waits; workers may come and go."""
        if monotonic() > self._asked + _ASK_AGAIN:
            self._asked = monotonic()
            with suppress(*self._lost, OSError):  # the next task will show it
                self._threads = sum(self._client.nthreads().values())
        return 2 * max(self._threads, 1)

    def submit(self, task: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """Submit a task to the scheduler; its data are released when it is done."""
        outer: Future[Any] = Future()
        try:
            inner = self._client.submit(task, *arguments, pure=False)
        except (*self._lost, OSError, RuntimeError) as error:
            outer.set_exception(EngineLostError(type(error).__name__))
            return outer
        self._pending.add(inner)

        def finished(done: Any) -> None:
            self._pending.discard(done)
            pass_on(done, outer, self._died, self._lost)
            done.release()

        inner.add_done_callback(finished)
        return outer

    def close(self) -> None:
        """End our own cluster; for a given client, only cancel unfinished tasks."""
        if self._borrowed:
            for future in list(self._pending):
                future.release()
            return
        self._client.close(timeout=2)
        if self._cluster is not None:
            self._cluster.close(timeout=5)


def is_client(engine: Any) -> bool:
    """Whether something is a `distributed.Client`, without importing it."""
    distributed = sys.modules.get("distributed")
    return distributed is not None and isinstance(engine, distributed.Client)


def _has_pages() -> bool:
    """Whether dask has the packages of its dashboard."""
    return find_spec("bokeh") is not None


def _fit(client: Any) -> Any:
    """Return a client that responds."""
    if client.asynchronous:
        raise ValueError("engine: this client is asynchronous; give a client made without asynchronous=True")
    if client.status != "running":
        raise ValueError(f"engine: this client is {client.status}; give a connected client")
    return client


def check_address(address: str, *, insecure: bool = False) -> None:
    """Refuse a scheduler elsewhere without encryption (unless `insecure`): who reaches it can run programs.

    Raises
    ------
    ValueError
        If it is not an address, or neither of this machine nor encrypted.
    """
    try:
        parts = urlsplit(address)
        host, port = parts.hostname, parts.port
    except ValueError:
        parts, host, port = urlsplit(""), None, None
    if parts.scheme not in ("tcp", "tls") or not host or not port:
        raise ValueError(f"--scheduler {address}: give tcp://HOST:PORT or tls://HOST:PORT")
    try:
        here = ipaddress.ip_address(host).is_loopback
    except ValueError:
        here = host == "localhost"
    if not (here or insecure or parts.scheme == "tls"):
        raise ValueError(
            f"--scheduler {address}: is a remote address without encryption; use tls:// (certificates in "
            "dask's configuration), or --insecure on a network that you trust"
        )

"""The engine of dask.distributed: workers on this machine or on a cluster with a shared disk."""

import ipaddress
import logging
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from contextlib import suppress
from importlib import import_module
from time import monotonic
from typing import Any
from urllib.parse import urlsplit

from mcgw.errors import RunError
from mcgw.jobs.engines import EngineLostError, pass_on

__all__ = ["Dask", "check_address"]

_QUIET = {
    # The profiler holds frames, and with them HDF5 handles; results are digests and need no spilling.
    "distributed.worker.profile.enabled": False,
    "distributed.scheduler.work-stealing": False,
    "distributed.comm.timeouts.connect": "10s",
}
_ASK_AGAIN = 5.0  # seconds after which the workers are counted anew


class Dask:
    """Workers behind a dask scheduler.

    Parameters
    ----------
    address : str, optional
        Of a running scheduler. Default: a cluster on this machine, that listens to it alone.
    workers : int, optional
        Processes of that cluster.
    insecure : bool, optional
        Talk to a scheduler elsewhere without encryption.

    Raises
    ------
    ValueError
        If the address is not fit for use.
    RunError
        If dask is not installed or nobody answers.
    """

    def __init__(self, address: str | None = None, *, workers: int = 2, insecure: bool = False) -> None:
        if address is not None:
            check_address(address, insecure=insecure)
        if workers < 1:
            raise ValueError(f"workers = {workers}: give a whole number >= 1")
        try:
            dask: Any = import_module("dask")
            distributed: Any = import_module("distributed")
        except ImportError:
            raise RunError('dask is not installed: pip install "mcgw[dask]"') from None
        dask.config.set(_QUIET)
        for name in logging.root.manager.loggerDict:
            if name.startswith("distributed"):  # a lost worker or scheduler is one line, and that is ours
                logging.getLogger(name).setLevel(logging.CRITICAL)
        self._cluster: Any = None
        if address is None:
            self._cluster = distributed.LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address=None,
                silence_logs="CRITICAL",
            )
        try:
            self._client: Any = distributed.Client(self._cluster or address, timeout="10s")
        except OSError:
            raise RunError(
                f"{address}: no scheduler answers there; start it (dask scheduler), then repeat the command"
            ) from None
        self._asked, self._threads = -_ASK_AGAIN, 1
        self._died = distributed.KilledWorker
        closed = distributed.comm.CommClosedError
        self._lost = (CancelledError, distributed.client.FutureCancelledError, closed)

    @property
    def width(self) -> int:
        """Twice as many blocks as there are threads, so that none waits; workers may come and go."""
        if monotonic() > self._asked + _ASK_AGAIN:
            self._asked = monotonic()
            with suppress(*self._lost, OSError):  # what is submitted next will tell
                self._threads = sum(self._client.nthreads().values())
        return 2 * max(self._threads, 1)

    def submit(self, task: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        """Give a task to the scheduler; what a worker knows of it is forgotten once it is done."""
        outer: Future[Any] = Future()
        try:
            inner = self._client.submit(task, *arguments, pure=False)
        except (*self._lost, OSError, RuntimeError) as error:
            outer.set_exception(EngineLostError(type(error).__name__))
            return outer

        def finished(done: Any) -> None:
            pass_on(done, outer, self._died, self._lost)
            done.release()

        inner.add_done_callback(finished)
        return outer

    def close(self) -> None:
        """Leave the scheduler; end a cluster of our own."""
        self._client.close(timeout=2)
        if self._cluster is not None:
            self._cluster.close(timeout=5)


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
            f"--scheduler {address}: is not on this machine and not encrypted; use tls:// "
            "(certificates in dask's configuration), or say --insecure on a network you trust"
        )

"""The engine that a call asks for: by a word, an address, a client of dask or as it is."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from mcgw.jobs.engines import Engine, Processes

__all__ = ["chosen_engine", "dashboard_of"]

_ENGINES = ("threads", "processes", "dask")


@contextmanager
def chosen_engine(engine: Any, threads: int | None) -> Iterator[Engine | None]:
    """The engine that is given, or that a word or an address names; None for threads of this process.

    One that is made here is closed at the end; one that is given, a client of dask too, is left open.

    Raises
    ------
    ValueError
        If it is none of these.
    """
    draws = _engine_of(engine, threads)
    try:
        yield draws
    finally:
        if draws is not None and draws is not engine:
            draws.close()


def dashboard_of(engine: Engine | None) -> str:
    """What to say of where an engine is seen at work; empty if there is no such page."""
    link = getattr(engine, "dashboard", "")
    return f"dashboard: {link}" if link else ""


def _engine_of(engine: Any, threads: int | None) -> Engine | None:
    from mcgw.jobs.dask_engine import Dask, is_client

    match engine:
        case None | "threads":
            return None
        case "processes":
            return Processes(_cores() if threads is None else threads)
        case str() if engine == "dask" or "://" in engine:
            return Dask(
                None if engine == "dask" else engine, workers=_cores() if threads is None else threads
            )
        case _ if is_client(engine):
            return Dask(engine)
        case _ if not isinstance(engine, str) and hasattr(engine, "submit") and hasattr(engine, "width"):
            return engine  # type: ignore[no-any-return]
    raise ValueError(
        f"engine = {engine!r}: give one of {', '.join(_ENGINES)}, tcp://ADDRESS of a scheduler, or a "
        "distributed.Client"
    )


def _cores() -> int:
    import numba

    return int(numba.get_num_threads())

"""The lock of a file in the making: one process writes it, or several that each make a share of its blocks.

It lies in the folder of the run (`mcgw.store.disk.parts_of`) and goes together with the folder when nothing
else is left there. The system frees it when its holder dies, however that happens. It is the lock of an
SQLite file that stays empty, which every system has. Such a lock goes when *any* descriptor of its file is
closed, so nothing else may open that file: who holds it stands in another one. Where the disk keeps no locks,
names of files stand for them (`mcgw.store.lock_by_name`).
"""

import os
import socket
import sqlite3
from collections.abc import Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from pathlib import Path
from time import monotonic, sleep

from filelock import ReadWriteLock, Timeout

from mcgw.errors import StoreError
from mcgw.formats.files import write_whole
from mcgw.formats.untrusted import read_text
from mcgw.store.lock_by_name import hold_by_name, keeps_locks, names_of_locks

__all__ = ["LOCK_FILES", "LockedError", "locked", "refuse_link"]

PATIENCE = 1.0  # seconds: a process that was killed may need a moment to die

_LOCK, _HOLDER = "lock.db", "holder"
LOCK_FILES = (_HOLDER, _LOCK)
_MOST_BYTES = 200


class LockedError(StoreError):
    """Another process works on this file."""


@contextmanager
def locked(folder: Path, *, shared: bool = False, patience: float | None = None) -> Iterator[None]:
    """Hold the folder of a run, from `mcgw.store.disk.parts_of`; it is made if it is not there.

    `shared` is for one of several jobs that each make a share of the blocks; `patience` is how many seconds
    to wait for another holder, by default `PATIENCE`. The files `LOCK_FILES` in the folder go with it.

    Raises
    ------
    LockedError
        If another process or thread holds it.
    StoreError
        If something else than a folder is there, or it cannot be made or locked.
    """
    with ExitStack() as held:
        until = monotonic() + (PATIENCE if patience is None else patience)
        while (problem := _try(folder, shared, held)) is not None:
            if monotonic() >= until:
                raise LockedError(f"{folder}: {problem}")
            sleep(0.02)
        with suppress(OSError):  # a full disk; it is only for people
            if shared:
                (folder / _HOLDER).unlink(missing_ok=True)
            else:
                text = f"pid {os.getpid()} on {socket.gethostname()}\n"
                write_whole(folder / _HOLDER, (text.encode(),))
        try:
            yield
        finally:
            if not shared:
                _remove_if_empty(folder)


def _try(folder: Path, shared: bool, held: ExitStack) -> str | None:
    """Take the lock at once, or tell why it cannot be had now."""
    refuse_link(folder)
    new = not folder.exists()
    try:
        # Writable by its owner alone: otherwise the lock makes names of its own there, and may leave them.
        folder.mkdir(mode=0o755, parents=True, exist_ok=True)
        try:
            held.enter_context(_lock(folder, shared))
        except (Timeout, sqlite3.Error) as error:
            by_name = not keeps_locks(folder)
            if not by_name and isinstance(error, sqlite3.Error):
                if new:
                    _remove_if_empty(folder)
                raise StoreError(f"{folder}: cannot be locked ({error}); choose another -o") from None
            holder = hold_by_name(folder, shared, held) if by_name else _holder(folder)
            return holder and f"locked by {holder}, which works on this run"
    except OSError as error:
        if error.errno is None or isinstance(error, FileNotFoundError):
            return "its run has just ended; repeat the command"  # the folder went between two steps
        raise StoreError(f"{folder}: cannot be locked ({error.strerror or error})") from None
    return None


def _lock(folder: Path, shared: bool) -> AbstractContextManager[None]:
    lock = ReadWriteLock(folder / _LOCK, is_singleton=False)
    return (lock.read_lock if shared else lock.write_lock)(blocking=False)


def _remove_if_empty(folder: Path) -> None:
    with suppress(OSError):
        names = {*LOCK_FILES, *names_of_locks(folder)}
        if set(os.listdir(folder)) <= names:
            for name in names:
                (folder / name).unlink(missing_ok=True)
            folder.rmdir()


def _holder(folder: Path) -> str:
    try:
        return read_text(folder / _HOLDER, _MOST_BYTES).strip() or "another process"
    except StoreError:
        return "another process"


def refuse_link(folder: Path) -> None:
    """Refuse what stands in the place of a folder.

    Raises
    ------
    StoreError
        If it is a link or a file.
    """
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        raise StoreError(f"{folder}: is not a folder; remove it or choose another -o")

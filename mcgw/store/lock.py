"""The lock of a file being made: one process writes it, or several that each make a share of its blocks.

It lies in the folder of the run (`parts_of`) and goes together with the folder when nothing
else is left there. The system frees it when its holder dies, however that happens. It is the lock of an
SQLite file that stays empty, which every system has. Such a lock goes when *any* descriptor of its file is
closed, so nothing else may open that file: who holds it stands in another one.

A disk that keeps no locks, as NFS or Lustre without them, is refused.
"""

import os
import socket
import sqlite3
import stat
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from time import monotonic, sleep

from filelock import ReadWriteLock, Timeout

from mcgw.errors import StoreError
from mcgw.formats.files import write_whole
from mcgw.formats.named_files import read_text

PATIENCE = 1.0  # seconds: a process that was killed may need a moment to die
_LOCK, _HOLDER = "lock.db", "holder"
LOCK_FILES = (_HOLDER, _LOCK)
_MOST_BYTES = 200
_UNKNOWN = "another process (or by none, on a disk that keeps no locks)"


def parts_of(path: Path) -> Path:
    """Folder of the run that makes a file."""
    return path.with_name(f"{path.name}.parts")


class LockedError(StoreError):
    """Another process works on this file."""


@contextmanager
def locked(folder: Path, *, shared: bool = False, patience: float | None = None) -> Iterator[bool]:
    """Hold the folder of a run, from `parts_of`; tells whether it had to be made.

    `shared` is for one of several jobs that each make a share of the blocks; `patience` is how many seconds
    to wait for another holder, by default `PATIENCE`. The files `LOCK_FILES` in the folder go with it.
    """
    new = not folder.exists()
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
                write_whole(folder / _HOLDER, text.encode())
        try:
            yield new
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
            lock = ReadWriteLock(folder / _LOCK, is_singleton=False)
            held.enter_context((lock.read_lock if shared else lock.write_lock)(blocking=False))
        except Timeout:
            holder = ""
            with suppress(StoreError):
                holder = read_text(folder / _HOLDER, _MOST_BYTES).strip()
            return f"locked by {holder or _UNKNOWN}, which is working on this run"
        except (sqlite3.Error, ValueError) as error:  # the last: its file cannot be written
            if new:
                _remove_if_empty(folder)
            raise StoreError(
                f"{folder}: cannot be locked ({error}); choose another -o, on a disk that keeps locks"
            ) from None
    except OSError as error:
        if error.errno is None or isinstance(error, FileNotFoundError):
            return "its run has just ended; repeat the command"  # the folder went between two steps
        raise StoreError(f"{folder}: cannot be locked ({error.strerror or error})") from None
    return None


def _remove_if_empty(folder: Path) -> None:
    with suppress(OSError):
        names = os.listdir(folder)
        if all(name in LOCK_FILES for name in names):
            for name in names:
                (folder / name).unlink(missing_ok=True)
            folder.rmdir()


def refuse_link(folder: Path) -> None:
    """Refuse a link or a file in place of a folder."""
    with suppress(FileNotFoundError, NotADirectoryError):  # another process may just have removed it
        if not stat.S_ISDIR(os.lstat(folder).st_mode):
            raise StoreError(f"{folder}: is not a folder; remove it or choose another -o")

"""The lock of a file being made: one process writes it, or several that each make a share of its blocks.

It lies in the folder of the run (`mcgw.store.disk.parts_of`) and goes together with the folder when nothing
else is left there. The system frees it when its holder dies, however that happens. It is the lock of an
SQLite file that stays empty, which every system has. Such a lock goes when *any* descriptor of its file is
closed, so nothing else may open that file: who holds it stands in another one.

Where the disk keeps no locks, as NFS or Lustre without them, names of files stand for them. Only one process
can make a name. Who works alone makes ``lock.alone``, who shares makes a name of its own, and each looks for
the others before and after: of two that begin at once one goes on, or none. No system frees such a lock:
names that processes of this host left when they died are removed, and those of another host are for people
to remove. That two drivers work on one run harms no more than their time, for blocks are whole or not there,
and the same whoever draws them.
"""

import os
import re
import secrets
import socket
import sqlite3
from collections.abc import Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from pathlib import Path
from time import monotonic, sleep

from filelock import ReadWriteLock, Timeout

from mcgw.errors import StoreError
from mcgw.formats.files import alive, temporary_beside, write_whole
from mcgw.formats.named_files import read_text

PATIENCE = 1.0  # seconds: a process that was killed may need a moment to die
_LOCK, _HOLDER = "lock.db", "holder"
LOCK_FILES = (_HOLDER, _LOCK)
_MOST_BYTES = 200
_ALONE, _SHARED = "lock.alone", "lock.shared-"


class LockedError(StoreError):
    """Another process works on this file."""


@contextmanager
def locked(folder: Path, *, shared: bool = False, patience: float | None = None) -> Iterator[bool]:
    """Hold the folder of a run, from `mcgw.store.disk.parts_of`; tells whether it had to be made.

    `shared` is for one of several jobs that each make a share of the blocks; `patience` is how many seconds
    to wait for another holder, by default `PATIENCE`. The files `LOCK_FILES` in the folder go with it.

    Raises
    ------
    LockedError
        If another process or thread holds it.
    StoreError
        If something else than a folder is there, or it cannot be made or locked.
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
                write_whole(folder / _HOLDER, (text.encode(),))
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
            held.enter_context(_lock(folder, shared))
        except (Timeout, sqlite3.Error, ValueError) as error:  # the last: its file cannot be written
            by_name = not keeps_locks(folder)
            if not by_name and not isinstance(error, Timeout):
                if new:
                    _remove_if_empty(folder)
                raise StoreError(f"{folder}: cannot be locked ({error}); choose another -o") from None
            holder = hold_by_name(folder, shared, held) if by_name else _holder(folder)
            return holder and f"locked by {holder}, which is working on this run"
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
        names = os.listdir(folder)
        if all(name in LOCK_FILES or name.startswith((_ALONE, _SHARED)) for name in names):
            for name in names:
                (folder / name).unlink(missing_ok=True)
            folder.rmdir()


def _holder(folder: Path) -> str:
    try:
        return read_text(folder / _HOLDER, _MOST_BYTES).strip() or "another process"
    except StoreError:
        return "another process"


def refuse_link(folder: Path) -> None:
    """Refuse what stands in place of a folder.

    Raises
    ------
    StoreError
        If it is a link or a file.
    """
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        raise StoreError(f"{folder}: is not a folder; remove it or choose another -o")


def keeps_locks(folder: Path) -> bool:
    """Whether the disk of a folder grants locks to anybody, found out by one that nobody else can have."""
    try:
        import fcntl
    except ImportError:  # another system, whose disks do
        return True
    probe = temporary_beside(folder / "lock")
    fd = os.open(probe, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600)
    try:
        fcntl.lockf(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    finally:
        os.close(fd)
        probe.unlink(missing_ok=True)
    return True


def hold_by_name(folder: Path, shared: bool, held: ExitStack) -> str | None:
    """Hold a folder until `held` ends, or tell at once who holds it."""
    mine = folder / (f"{_SHARED}{secrets.token_hex(8)}" if shared else _ALONE)
    if (other := _other(folder, shared, mine)) is not None:
        return other
    try:
        fd = os.open(mine, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o644)
    except FileExistsError:
        return _holder_by_name(mine)
    with os.fdopen(fd, "w") as file:
        file.write(f"pid {os.getpid()} on {socket.gethostname()}\n")
    held.callback(mine.unlink, missing_ok=True)
    if (other := _other(folder, shared, mine)) is not None:
        mine.unlink(missing_ok=True)
    return other


def names_of_locks(folder: Path) -> set[str]:
    """Names that such locks have left in a folder, or hold it by."""
    return {name for name in os.listdir(folder) if name == _ALONE or name.startswith(_SHARED)}


def _other(folder: Path, shared: bool, mine: Path) -> str | None:
    """Who holds a folder, if this one does not go together with them."""
    for name in names_of_locks(folder) - {mine.name}:
        if (name == _ALONE or not shared) and (holder := _holder_by_name(folder / name)) is not None:
            return holder
    return None


def _holder_by_name(name: Path) -> str | None:
    """Whose name it is; None if that one is dead, and then the name goes."""
    try:
        text = read_text(name, _MOST_BYTES).strip()
    except (StoreError, OSError):
        return "another process"
    here = re.fullmatch(rf"pid (\d+) on {re.escape(socket.gethostname())}", text)
    if here is None:
        return f"{text or 'another process'} (this disk has no locks: remove {name} if that one has ended)"
    if alive(int(here[1])):
        return text
    with suppress(OSError):
        name.unlink()
    return None

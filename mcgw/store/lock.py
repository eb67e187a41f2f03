"""The lock of a file in the making: one process writes it, or several that each make a share of its blocks.

It lies in the folder of the run (`mcgw.store.disk.parts_of`), is freed by the kernel when its holder dies,
and goes together with the folder when nothing else is left there.
"""

import fcntl
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from time import monotonic, sleep

from mcgw.errors import StoreError

__all__ = ["LockedError", "locked", "refuse_link"]

PATIENCE = 1.0  # seconds: a process that was killed may need a moment to die


class LockedError(StoreError):
    """Another process works on this file."""


@contextmanager
def locked(folder: Path, *, shared: bool = False, patience: float | None = None) -> Iterator[None]:
    """Hold the folder of a run; it is made if it is not there.

    Parameters
    ----------
    folder : Path
        From `mcgw.store.disk.parts_of`.
    shared : bool, optional
        One of several jobs that each make a share of the blocks.
    patience : float, optional
        Seconds to wait for another holder; default: `PATIENCE`.

    Raises
    ------
    LockedError
        If another process holds it.
    StoreError
        If something else than a folder is there, or it cannot be made or locked.
    """
    try:
        fd = _taken(folder, shared, PATIENCE if patience is None else patience)
    except OSError as error:
        raise StoreError(f"{folder}: cannot be locked ({error.strerror or error})") from None
    try:
        with suppress(OSError):  # a full disk; it is only for people
            os.ftruncate(fd, 0)
            os.pwrite(fd, f"pid {os.getpid()} on {socket.gethostname()}\n".encode(), 0)
        yield
    finally:
        with suppress(OSError):
            if not shared and os.listdir(folder) == ["lock"]:
                os.unlink(folder / "lock")
                os.rmdir(folder)
        os.close(fd)


def _taken(folder: Path, shared: bool, patience: float) -> int:
    """Descriptor of the lock that is in the folder, and not of one that has just been removed with it."""
    until = monotonic() + patience
    while True:
        refuse_link(folder)
        folder.mkdir(parents=True, exist_ok=True)
        holder = "another process"
        with suppress(FileNotFoundError):  # the folder went as its run ended
            fd = os.open(folder / "lock", os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o644)
            try:
                fcntl.flock(fd, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
                if _is(fd, folder / "lock"):
                    return fd
            except BlockingIOError:
                holder = os.pread(fd, 200, 0).decode(errors="replace").strip() or holder
            except BaseException:
                os.close(fd)
                raise
            os.close(fd)
        if monotonic() >= until:
            raise LockedError(f"{folder}: locked by {holder}, which works on this run")
        sleep(0.02)


def _is(fd: int, path: Path) -> bool:
    with suppress(FileNotFoundError):
        return os.path.samestat(os.fstat(fd), os.lstat(path))
    return False


def refuse_link(folder: Path) -> None:
    """Refuse what stands in the place of a folder.

    Raises
    ------
    StoreError
        If it is a link or a file.
    """
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        raise StoreError(f"{folder}: is not a folder; remove it or choose another -o")

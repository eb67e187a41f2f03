"""Files that appear whole or not at all.

Data go under a temporary name, are flushed to the disk, and get their own name in one step; the folder
is flushed last. A temporary name is never one that exists: nothing planted there is followed.
"""

import glob
import os
import secrets
import socket
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from mcgw.errors import StoreError

__all__ = [
    "SteadyFile",
    "check_output",
    "remove_stale",
    "sync",
    "temporary_beside",
    "whole_file",
    "write_whole",
]


def temporary_beside(path: Path) -> Path:
    """A new name in the same folder, of this process alone, on whatever host."""
    return path.with_name(f"{_stem(path)}{os.getpid()}-{secrets.token_hex(4)}.tmp")


def remove_stale(path: Path) -> None:
    """Remove the temporary files that processes of this host, now dead, left beside a file."""
    for left in path.parent.glob(f"{glob.escape(_stem(path))}*.tmp"):
        pid = left.name.removeprefix(_stem(path)).split("-")[0]
        if pid.isdecimal() and not _alive(int(pid)):
            left.unlink(missing_ok=True)


def _stem(path: Path) -> str:
    host = zlib.crc32(socket.gethostname().encode())
    return f".{path.name[:100]}.{host:08x}-"


def _alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        pass
    return True


@contextmanager
def whole_file(path: Path, *, replace: bool = True) -> Iterator[Path]:
    """Name to write a file under; at the end it takes the place of `path`, on an error it goes.

    Parameters
    ----------
    path : Path
        Its name; a link of that name is replaced, not followed.
    replace : bool, optional
        If not, a file that is already there stays, and `FileExistsError` is raised.

    Raises
    ------
    OSError
        If it cannot be written; then nothing is left behind and an older file is as it was.
    """
    temporary = temporary_beside(path)
    try:
        yield temporary
        sync(temporary)
        if replace:
            os.replace(temporary, path)
        else:
            os.link(temporary, path)
            os.unlink(temporary)
        sync(path.parent)
    except BaseException:
        with suppress(OSError):  # it has its own name by now, or was never made
            os.unlink(temporary)
        raise


def write_whole(path: Path, pieces: Iterable[bytes], *, replace: bool = True) -> None:
    """Write a file of these contents by `whole_file`."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
    with (
        whole_file(path, replace=replace) as temporary,
        os.fdopen(os.open(temporary, flags, 0o644), "wb") as file,
    ):
        for piece in pieces:
            file.write(piece)


class SteadyFile:
    """A new file for the HDF5 library that never shows it an error, for it may crash on one.

    After the first error nothing more is written; `check` raises it.

    Parameters
    ----------
    path : Path
        Must not exist.
    """

    def __init__(self, path: Path) -> None:
        flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
        self._file = os.fdopen(os.open(path, flags, 0o644), "w+b", buffering=0)
        self._error: OSError | None = None

    def check(self) -> None:
        """Raise the first error, if there was one."""
        if self._error:
            raise self._error

    def write(self, data: Any) -> int:
        """Write all of it."""
        left = memoryview(data).cast("B")
        try:
            while left and not self._error:
                left = left[self._file.write(left) or 0 :]
        except OSError as error:
            self._error = error
        return memoryview(data).nbytes

    def truncate(self, size: int | None = None) -> int:
        """Set the length."""
        try:
            return self._file.truncate(size)
        except OSError as error:
            self._error = self._error or error
            return size or 0

    def readinto(self, buffer: Any) -> int:
        """Read; beyond the end there are zeros."""
        view = memoryview(buffer).cast("B")
        got = self._file.readinto(view) or 0
        view[got:] = bytes(len(view) - got)
        return len(view)

    def read(self, size: int) -> bytes:
        """Read as many bytes."""
        data = bytearray(size)
        self.readinto(data)
        return bytes(data)

    def seek(self, offset: int, whence: int = 0) -> int:
        """Go to a place."""
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        """Tell the place."""
        return self._file.tell()

    def flush(self) -> None:
        """Nothing is held back."""

    def seal(self, data: bytes) -> None:
        """Append the last bytes and flush to the disk.

        Raises
        ------
        OSError
            If this, or anything before, failed.
        """
        self._file.seek(0, os.SEEK_END)
        self.write(data)
        self.check()
        os.fsync(self._file.fileno())

    def close(self) -> None:
        """Close it, whatever became of it."""
        self._file.close()


def sync(path: Path) -> None:
    """Flush a file, or the names in a folder, to the disk."""
    fd = os.open(path, os.O_RDONLY)
    try:
        os.fsync(fd)
    finally:
        os.close(fd)


def check_output(path: Path) -> None:
    """Refuse a place where no file can be put, before anything is computed; make its folder.

    Raises
    ------
    StoreError
        If the name is taken by something else than a file, is a link or too long, or if the folder
        cannot be made or written.
    """
    name = path.name
    try:
        if name in ("", ".", "..") or len(os.fsencode(name)) > 200 or not name.isprintable():
            raise StoreError(f"{str(path)!r}: is no name for a file; choose another -o")
        if path.is_symlink() or (path.exists() and not path.is_file()):
            raise StoreError(f"{path}: is no regular file; choose another -o")
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StoreError(f"{path}: cannot be written ({error.strerror or error})") from None
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise StoreError(f"{path}: cannot be written (the folder {path.parent} is read-only)")

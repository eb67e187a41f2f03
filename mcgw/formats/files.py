"""Files that appear whole or not at all.

Data go under a temporary name, are flushed to the disk, and get their own name in one step; the folder
is flushed last. A temporary name is never one that exists: nothing planted there is followed.
"""

import errno
import glob
import os
import secrets
import socket
import stat
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from functools import partial
from pathlib import Path
from typing import Literal

from mcgw.errors import StoreError

# What tells a file from another that has taken its name: inode, size, time of the last change.
State = tuple[int, int, int]
Expected = State | None | Literal["anything"]

LOCK_FILES = ("holder", "lock.db")  # of the folder of a run
HDF5 = b"\x89HDF\r\n"  # how such a file begins

Waiting = tuple[Path, Path, Expected]  # its temporary name, its own, and which file has that now
_waiting: ContextVar[list[Waiting] | None] = ContextVar("_waiting", default=None)


def parts_of(path: Path) -> Path:
    """Folder of the run that makes a file."""
    return path.with_name(f"{path.name}.parts")


def state_of(path: Path) -> State | None:
    """Which file bears a name now; None if there is none."""
    try:
        status = os.lstat(path)
    except FileNotFoundError:
        return None
    return status.st_ino, status.st_size, status.st_mtime_ns


def remove_stale(path: Path) -> None:
    """Remove the temporary files that processes of this host, now dead, left beside a file."""
    for left in path.parent.glob(f"{glob.escape(_stem(path))}*.tmp"):
        pid = left.name.removeprefix(_stem(path)).split("-")[0]
        if pid.isdecimal() and not alive(int(pid)):
            with suppress(OSError):  # not ours to remove
                left.unlink()


def _stem(path: Path) -> str:
    host = zlib.crc32(socket.gethostname().encode())
    return f".{path.name[:100]}.{host:08x}-"


def alive(pid: int) -> bool:
    """Whether a process of this host runs."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        pass
    return True


@contextmanager
def together() -> Iterator[list[Waiting]]:
    """Let the files that are written inside get their names when all of them are whole, or none of them.

    For a command with several outputs: if a later one fails, the earlier ones are not there, and older files
    are as they were. Yields the files that wait, those of a `together` around it as well, which says when.
    """
    if (around := _waiting.get()) is not None:
        yield around
        return
    waiting: list[Waiting] = []
    token = _waiting.set(waiting)
    try:
        yield waiting
        for each in waiting:
            _rename(*each)
        for folder in {path.parent for _, path, _ in waiting}:
            sync(folder)
    except BaseException:
        for temporary, *_ in waiting:
            with suppress(OSError):
                os.unlink(temporary)
        raise
    finally:
        _waiting.reset(token)


@contextmanager
def whole_file(path: Path, *, expected: Expected = "anything", folder: Path | None = None) -> Iterator[Path]:
    """Name to write a file under; at the end it takes the place of `path`, on an error it goes.

    Inside of `together` it takes that place when all files are whole. A link of that name is replaced, not
    followed. If another file than the `expected` one, from `state_of` (None: there must be none), has it at
    the end, that is a FileExistsError. Until then it lies in a `folder` of the same disk, or beside `path`.
    """
    mine = f"{_stem(path)}{os.getpid()}-{secrets.token_hex(4)}.tmp"  # of this process, on whatever host
    temporary = (folder or path.parent) / mine
    try:
        with together() as waiting:
            refuse_read_only(path)
            yield temporary
            sync(temporary)
            waiting.append((temporary, path, expected))
    except BaseException as error:
        with suppress(OSError):  # it has its own name by now, or was never made
            os.unlink(temporary)
        if isinstance(error, OSError) and error.filename in (None, str(temporary)):
            error.filename = str(path)
        raise


def refuse_read_only(path: Path) -> None:
    """Refuse to replace a file that nobody may write."""
    with suppress(OSError):  # there is none
        mode = os.lstat(path).st_mode
        if stat.S_ISREG(mode) and not mode & 0o222:
            raise StoreError(f"{path}: is read-only; choose another -o, or make it writable")


def _rename(temporary: Path, path: Path, expected: Expected) -> None:
    """Give a finished file its name and the mode of the file that it replaces, unless that is another one."""
    with suppress(FileNotFoundError):
        replaced = os.lstat(path).st_mode
        if stat.S_ISREG(replaced):
            os.chmod(temporary, stat.S_IMODE(replaced))
    if expected is None:
        try:
            os.link(temporary, path)  # unlike a rename, it never replaces anything
        except FileExistsError:
            raise
        except OSError:  # a file system without hard links
            pass
        else:
            return os.unlink(temporary)
    if expected not in ("anything", state_of(path)):
        raise FileExistsError(errno.EEXIST, "another file now has this name", str(path))
    return os.replace(temporary, path)


def write_whole(path: Path, contents: bytes, *, expected: Expected = "anything") -> None:
    """Write a file by `whole_file`; everybody may read it, its owner alone may write."""
    mine = partial(os.open, mode=0o644)
    with whole_file(path, expected=expected) as temporary, open(temporary, "xb", opener=mine) as file:
        file.write(contents)


def sync(path: Path) -> None:
    """Flush a file, or the names in a folder, to the disk; some disks do not flush folders."""
    fd = os.open(path, os.O_RDONLY)
    try:
        os.fsync(fd)
    except OSError as error:
        if not (stat.S_ISDIR(os.fstat(fd).st_mode) and error.errno in (errno.EINVAL, errno.ENOTSUP)):
            error.filename = error.filename or str(path)
            raise
    finally:
        os.close(fd)


def check_output(path: Path) -> None:
    """Refuse a place where no file can be put, before anything is computed; make its folder.

    Temporary files that dead processes left there are removed.
    """
    name = path.name
    try:
        if name in ("", "..") or len(os.fsencode(name)) > 200 or not name.isprintable():
            raise StoreError(f"{str(path)!r}: is not a valid file name; choose another -o")
        if path.is_symlink() or (path.exists() and not path.is_file()):
            raise StoreError(f"{path}: is not a regular file; choose another -o")
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StoreError(f"{path}: cannot be written ({error.strerror or error})") from None
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise StoreError(f"{path}: cannot be written (the folder {path.parent} is read-only)")
    remove_stale(path)

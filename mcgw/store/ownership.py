"""Whose a file in the making is: a lock for one process or several; which run may go on; what repeats it.

The lock lies in the folder of the run (`parts_of`) and goes together with the folder when nothing
else is left there. The system frees it when its holder dies, however that happens. It is the lock of an
SQLite file that stays empty, which every system has. Such a lock goes when *any* descriptor of its file is
closed, so nothing else may open that file: who holds it stands in another one. A disk that keeps no locks, as
NFS or Lustre without them, is refused.

Runs may be one whose surfaces are the same, whatever their number. Besides its scene, the numbers of a run
depend on the versions of what draws. In their last digits they depend on the kind of processor as well, which
a run may change on its way, as the nodes of a cluster do: to 1e-12 they are the same.
"""

import os
import platform
import re
import socket
import sqlite3
import stat
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from time import monotonic, sleep
from typing import Any

from filelock import ReadWriteLock, Timeout

from mcgw.errors import StoreError
from mcgw.formats.files import LOCK_FILES
from mcgw.formats.named_files import loads, read_text
from mcgw.scene.scene_file import scene_from
from mcgw.scene.section import shortened

PATIENCE = 1.0  # seconds: a process that was killed may need a moment to die
_HOLDER, _LOCK = LOCK_FILES
Question = tuple[str, str, str]  # text of a scene, axes of a sweep or none, versions that draw
_PACKAGES = ("mcgw", "numpy", "scipy", "numba", "h5py")
_DRAW = ("mcgw", "numpy", "numba", "scipy")
_MOST_BYTES = 200
_UNKNOWN = "another process (or by none, on a disk that keeps no locks)"


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
            (folder / _HOLDER).unlink(missing_ok=True)
            if not shared:
                with open(folder / _HOLDER, "x") as file:
                    file.write(f"pid {os.getpid()} on {socket.gethostname()}\n")
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


def another(where: Path, kind: str, there: Question, here: Question) -> StoreError:
    """Return the error that a place holds something else."""
    what = difference(there, here)
    return StoreError(f"{where}: holds a different {kind}: {what}; choose another -o, or remove it")


def difference(there: Question, here: Question) -> str:
    """Tell what keeps two runs, or two sweeps, from being one: scene, axes and what draws, of each."""
    before, now = _said(*there[:2]), _said(*here[:2])
    for key in (*now, *before):
        if before.get(key) != now.get(key):
            given = f"{shortened(repr(now[key]))} here" if key in now else "not given here"
            return f"{key} is {shortened(repr(before.get(key)))} there and {given}"
    return f"it was drawn with {there[2]}, but this is {here[2]}"


def _said(scene: str, axes: str) -> dict[str, Any]:
    """Keys and values that decide the numbers: of a scene alone but for the number of surfaces."""
    found = {"sweep": axes or None, **dict(_flat(loads(scene)))}
    if not axes:
        found.pop("ensemble.n_surfaces", None)
        found["ensemble.n_asperities"] = scene_from(scene).n_asperities
    return found


def _flat(table: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


@cache
def versions(packages: tuple[str, ...] = _DRAW) -> str:
    """Versions of packages, by default of those on which the numbers drawn depend."""
    known = []
    for name in packages:
        try:
            known.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            known.append(f"{name} unknown")
    return ", ".join(known)


@cache
def provenance() -> dict[str, str]:
    """Return what is needed to repeat a run, besides its scene: versions, commit of a checkout, processor."""
    here, commit = Path(__file__).resolve().parents[2], "unknown"  # as of an installed package
    if (here / ".git").exists():
        call = ["git", "-C", str(here), "rev-parse", "HEAD"]
        with suppress(OSError, subprocess.SubprocessError):
            done = subprocess.run(call, capture_output=True, text=True, timeout=5, check=True)
            commit = done.stdout.strip()
    cpu = platform.processor() or platform.machine()
    with suppress(OSError):
        cores = re.findall(r"^model name\s*: (.*)", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
        cpu = f"{cores[0].strip()} ({len(cores)} cores)" if cores else cpu
    python = f"python {platform.python_version()}"
    return {"versions": f"{python}, {versions(_PACKAGES)}", "commit": commit, "cpu": cpu}

"""Is there room? Asked before anything is computed, in whole numbers that do not wrap. And how it is kept."""

import shutil
from functools import cache
from pathlib import Path

import numpy as np

from mcgw.errors import StoreError
from mcgw.scene import Scene
from mcgw.store.child import memory_limit

__all__ = ["check_memory", "check_room", "keep_freed_memory", "memory_available"]

_MOST = 2**63 - 1
_LARGE = 31 * 2**20  # bytes; at 32 MiB the GNU C library learns no more


def check_room(scene: Scene, path: Path, *, rows: int, columns: int, held: int = 0) -> None:
    """Refuse a run that cannot fit.

    Parameters
    ----------
    scene : Scene
        What is asked.
    path : Path
        Where its file will lie; the folder exists.
    rows : int
        Surfaces that are drawn at a time.
    columns : int
        Numbers kept of a surface.
    held : int, optional
        Bytes that already lie there.

    Raises
    ------
    StoreError
        With the numbers, if a count leaves 64 bits, a block the memory, or the file the disk.
    """
    m, n, k = scene.n_surfaces, scene.n_asperities, len(scene.separations)
    for what, value in (
        ("n_surfaces * n_asperities", m * n),
        ("n_surfaces * n_asperities * separations", m * n * k),
        ("bytes of the file", 8 * m * columns),
    ):
        if value > _MOST:
            raise StoreError(f"ensemble: {what} = {value:.4g} is more than 2^63 - 1 can count; ask for less")
    check_memory(f"contact.separations: a block of {min(rows, m)} surfaces", 3 * 8 * min(rows, m) * columns)
    size, free = 8 * m * columns, shutil.disk_usage(path.parent).free
    needed = 2 * size - held  # the shards, and the file they are merged into
    if needed > free:
        raise StoreError(
            f"{path}: needs up to {_gib(needed)} more on the disk while made and {_gib(free)} are free; "
            "make room, choose another -o, or ask for fewer surfaces or separations"
        )


def check_memory(what: str, size: int) -> None:
    """Refuse what needs more memory than there is.

    Raises
    ------
    StoreError
        With both numbers.
    """
    memory = memory_available()
    if size > memory:
        raise StoreError(
            f"{what} needs {_gib(size)} of memory and {_gib(memory)} are available; ask for less at a time"
        )


def memory_available() -> int:
    """Bytes that this process may still take: of the machine, of its control group, and by `ulimit -v`."""
    limits = [_number(line.split()[1]) * 1024 for line in _lines("/proc/meminfo") if "MemAvailable" in line]
    used = [_number(line) for line in _lines("/sys/fs/cgroup/memory.current")]
    most = [_number(line) for line in _lines("/sys/fs/cgroup/memory.max") if line.strip() != "max"]
    if used and most:
        limits.append(max(most[0] - used[0], 0))
    if (limit := memory_limit()) is not None:
        taken = [_number(line.split()[1]) * 1024 for line in _lines("/proc/self/status") if "VmSize" in line]
        limits.append(max(limit - sum(taken), 0))
    return min(limits, default=_MOST)


def _lines(path: str) -> list[str]:
    try:
        return Path(path).read_text().splitlines()
    except OSError:
        return []


def _number(text: str) -> int:
    return int(text) if text.strip().isdecimal() else _MOST


def _gib(size: int) -> str:
    return f"{size / 2**30:.4g} GiB"


@cache
def keep_freed_memory() -> None:
    """Let the C library keep for the next block what a block has freed.

    To ask the system for it again takes microseconds a page, up to a third of the time of a block. The
    GNU library keeps pieces as large as any it has been given back (its dynamic threshold): one is
    enough, which nobody has touched.
    """
    piece = np.empty(_LARGE, dtype=np.uint8)
    del piece

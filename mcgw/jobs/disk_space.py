"""Whether a run fits the memory and the disk: asked before anything is computed, in whole numbers."""

import shutil
from pathlib import Path

from mcgw.errors import StoreError
from mcgw.machine.memory import check_memory, gibibytes
from mcgw.scene.scene import Scene

__all__ = ["check_disk", "check_space"]

_MOST = 2**63 - 1


def check_space(scene: Scene, path: Path, *, rows: int, columns: int, held: int = 0) -> None:
    """Refuse a run that cannot fit, with `held` bytes already at the place of its file.

    `rows` surfaces of `columns` numbers are drawn at a time.

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
    check_disk(path, 2 * 8 * m * columns - held)  # the shards, and the file they are merged into


def check_disk(path: Path, needed: int) -> None:
    """Refuse what does not fit the disk, in bytes.

    Raises
    ------
    StoreError
        With the numbers.
    """
    free = shutil.disk_usage(path.parent).free
    if needed > free:
        raise StoreError(
            f"{path}: needs up to {gibibytes(needed)} more on the disk while made and {gibibytes(free)} "
            "are free; make room, choose another -o, or ask for fewer surfaces or separations"
        )

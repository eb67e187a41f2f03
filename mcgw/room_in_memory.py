"""Whether an ensemble fits into memory: asked before anything is drawn, in whole numbers."""

from pathlib import Path

from mcgw.scene import Scene

__all__ = ["bytes_kept", "check_memory", "memory_available"]


def bytes_kept(scene: Scene, n_surfaces: int) -> int:
    """Bytes of the sums of so many surfaces."""
    return 8 * n_surfaces * len(scene.separations) * len(scene.quantities)


def check_memory(scene: Scene, n_surfaces: int) -> None:
    """Refuse an ensemble that does not fit.

    Raises
    ------
    ValueError
        With its size, and what there is.
    """
    size, room = 2 * bytes_kept(scene, n_surfaces), memory_available()  # the blocks, and all of them joined
    if size > room:
        raise ValueError(
            f"ensemble.n_surfaces = {n_surfaces}: {len(scene.quantities)} quantities at "
            f"{len(scene.separations)} separations take {_gib(size)} of memory and {_gib(room)} are free; "
            "ask for less"
        )


def memory_available() -> int:
    """Bytes that the machine can still give; all there could be where that is not known."""
    try:
        for line in Path("/proc/meminfo").read_text().splitlines():
            if line.startswith("MemAvailable"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass
    return 2**63 - 1


def _gib(size: int) -> str:
    return f"{size / 2**30:.3g} GiB"

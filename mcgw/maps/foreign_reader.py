"""What SurfaceTopography reads of a file, in a process whose memory is limited.

Run as a script, ``python -m mcgw.maps.foreign_reader FILE HEIGHTS MEMORY`` writes heights to a ``.npy`` file
and tells the rest as JSON.
"""

import json
import sys
from pathlib import Path
from typing import Any

__all__: list[str] = []


def _read(path: Path, heights: Path) -> dict[str, Any]:
    """Facts about a map whose heights are written, rows of y from below; of a profile its dimension alone."""
    import numpy as np
    from SurfaceTopography import open_topography  # type: ignore[import-not-found, import-untyped, unused-ignore]

    from mcgw.maps.topography import checked_shape

    channel = open_topography(str(path)).default_channel
    if channel.dim != 2:
        return {"dim": channel.dim}
    columns, rows = (int(n) for n in channel.nb_grid_pts)
    checked_shape(rows, columns, held=path.stat().st_size)
    told = channel.physical_sizes is not None
    found = channel.topography(**({} if told else {"physical_sizes": (columns, rows)}))
    checked_shape(*found.nb_grid_pts[::-1])
    np.save(heights, np.ma.filled(np.ma.masked_invalid(found.heights()), np.nan).T)
    return {
        "dim": 2,
        "unit": None if found.unit is None else str(found.unit),
        "pixel": [float(p) for p in found.pixel_size] if told else None,
        "periodic": bool(found.is_periodic),
    }


def _main(path: str, heights: str, memory: int) -> None:
    from mcgw.machine.child_process import limit_memory

    memory = limit_memory(memory)
    try:
        answer = _read(Path(path), Path(heights))
    except MemoryError:
        answer = {"refused": f"it may take {memory >> 20} MiB of memory, and it asks for more"}
    except Exception as error:  # its readers raise errors of many kinds
        answer = {"refused": " ".join(str(error).split())[:160] or type(error).__name__}
    sys.stdout.write("\n" + json.dumps(answer) + "\n")


if __name__ == "__main__":
    _path, _heights, _memory = sys.argv[1:]
    _main(_path, _heights, int(_memory))

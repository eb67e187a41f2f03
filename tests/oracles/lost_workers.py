"""A task that kills the worker it runs in; of the standard library alone, so that a worker starts quickly."""

import os
import signal
from pathlib import Path


def deadly(first, mark=None):
    """Of one block: always, or the first time alone, where that leaves a mark."""
    if first == 16 and not (mark and Path(mark).exists()):
        if mark:
            Path(mark).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return first

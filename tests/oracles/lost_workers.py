"""Tasks that kill the worker they run in; of the standard library alone, so that a worker starts quickly."""

import os
import signal
from pathlib import Path


def deadly(first):
    """Always, of one block."""
    if first == 16:
        os.kill(os.getpid(), signal.SIGKILL)
    return first


def deadly_once(first, mark):
    """The first time, of one block."""
    if first == 16 and not Path(mark).exists():
        Path(mark).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return first

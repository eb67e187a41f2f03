"""A child process ends with its parent, however that dies.

The child holds the reading end of a pipe whose writing end only the parent has. When the parent is gone,
the kernel closes its end, and that ends the child.

Run as a script, with this pipe as standard input, ``python -m mcgw.machine.lifeline MODULE ARGUMENT ...``
runs a module as a script that ends with its parent from its first import on.
"""

import os
import runpy
import signal
import sys
import threading
from collections.abc import Callable

__all__ = ["end_with"]


def end_with(pipe: int, gone: Callable[[], object] | None = None) -> None:
    """End this process at once when the other end of a pipe is closed; nothing may ever be written into it.

    On Linux the kernel kills it, whatever it is busy with: a call into a C library that holds Python's
    global lock does not delay it. Elsewhere a thread does, as soon as it can take that lock: when `gone`
    returns, or reading from the pipe.
    """
    try:
        import fcntl

        fcntl.fcntl(pipe, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(pipe, fcntl.F_SETSIG, signal.SIGKILL)
        fcntl.fcntl(pipe, fcntl.F_SETFL, fcntl.fcntl(pipe, fcntl.F_GETFL) | os.O_ASYNC)
    except (ImportError, AttributeError, OSError):
        pass  # not Linux
    # Also there: the parent may have died before the kernel was asked.
    waits = gone or (lambda: os.read(pipe, 1))
    threading.Thread(target=_follow, args=(waits,), daemon=True, name="mcgw-lifeline").start()


def _follow(gone: Callable[[], object]) -> None:
    gone()
    os._exit(1)


if __name__ == "__main__":
    end_with(0)
    del sys.argv[0]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)

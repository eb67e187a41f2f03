"""The end of workers with their parent, however that dies."""

import os
import signal
import threading
from collections.abc import Callable


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
    def follow() -> None:
        gone() if gone else os.read(pipe, 1)
        os._exit(1)

    threading.Thread(target=follow, daemon=True, name="mcgw-lifeline").start()

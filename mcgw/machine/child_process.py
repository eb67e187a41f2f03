"""Work in a child process, where a crash, a hang or excessive memory does no harm.

A child process ends with its parent, however that dies.

The child holds the reading end of a pipe whose writing end only the parent has. When the parent is gone,
the kernel closes its end, and that ends the child.

Run as a script, with this pipe as standard input,
``python -m mcgw.machine.child_process MODULE ARGUMENT ...``
runs a module as a script that ends with its parent from its first import on.
"""

import os
import runpy
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path


class ChildError(Exception):
    """The child ended badly; the message says how, `said` is its last line."""

    def __init__(self, how: str, said: str) -> None:
        super().__init__(f"{how}: {said}" if said else how)
        self.how, self.said = how, said


def run_child(module: str, *arguments: str, seconds: float | None = None) -> str:
    """Run a module of this package as a script that ends with this process, and return what it prints.

    Raises
    ------
    ChildError
        If it does not end with exit code 0, within so many seconds if that is given.
    """
    home = str(Path(__file__).resolve().parents[2])
    paths = [home, *filter(None, [os.environ.get("PYTHONPATH")])]
    # One thread: a child that reads a file needs no pool of them, and their stacks count as memory.
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "OPENBLAS_NUM_THREADS": "1"}
    call = [sys.executable, "-P", "-m", "mcgw.machine.child_process", module, *arguments]
    lifeline, ours = os.pipe()
    try:
        done = subprocess.run(
            call, env=environment, capture_output=True, timeout=seconds, check=False, stdin=lifeline
        )
    except subprocess.TimeoutExpired:
        raise ChildError(f"took more than {seconds:g} s", "") from None
    finally:
        os.close(lifeline)
        os.close(ours)
    if done.returncode == 0:
        return done.stdout.decode(errors="replace")
    how = f"exit code {done.returncode}"
    if done.returncode < 0:
        how = f"crashed with {signal.Signals(-done.returncode).name}"
    lines = done.stderr.decode(errors="replace").strip().splitlines()
    raise ChildError(how, lines[-1] if lines else "")


def limit_memory(size: int) -> int:
    """Let this process use at most so many bytes, or as many as it may have if that is less: the limit.

    Where there is no module `resource` (Windows) nothing caps it but the machine. What a file can make
    the process ask for is bounded all the same by what `mcgw.store.structure` lets it declare, and its time
    is by the caller.
    """
    try:
        import resource
    except ImportError:
        return size
    limits = [limit for limit in resource.getrlimit(resource.RLIMIT_AS) if limit != resource.RLIM_INFINITY]
    least = min([size, *limits])
    resource.setrlimit(resource.RLIMIT_AS, (least, least))
    return least


def memory_limit() -> int | None:
    """Bytes of address space that this process and each child may have; None: no limit, or not known."""
    try:
        import resource
    except ImportError:
        return None
    soft, _ = resource.getrlimit(resource.RLIMIT_AS)
    return None if soft == resource.RLIM_INFINITY else soft


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

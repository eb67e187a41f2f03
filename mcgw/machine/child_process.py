"""Work in a process of its own, where a crash, a hang or a greed for memory harms nobody else."""

import os
import signal
import subprocess
import sys
from pathlib import Path

__all__ = ["ChildError", "limit_memory", "memory_limit", "run_child"]


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
    call = [sys.executable, "-P", "-m", "mcgw.machine.lifeline", module, *arguments]
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

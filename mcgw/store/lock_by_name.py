"""The lock of a folder on a disk that keeps none, as NFS or Lustre without them: by names of files.

Only one process can make a name. Who works alone makes ``lock.alone``, who shares makes a name of its own,
and each looks for the others before and after: of two that begin at once one goes on, or none. No system
frees such a lock: names that processes of this host left when they died are removed, and those of another
host are for people to remove. That two drivers work on one run harms no more than their time, for blocks are
whole or not there, and the same whoever draws them.
"""

import os
import re
import secrets
import socket
from contextlib import ExitStack, suppress
from pathlib import Path

from mcgw.errors import StoreError
from mcgw.formats.files import alive, temporary_beside
from mcgw.formats.untrusted import read_text

__all__ = ["hold_by_name", "keeps_locks", "names_of_locks"]

_ALONE, _SHARED = "lock.alone", "lock.shared-"
_MOST_BYTES = 200


def keeps_locks(folder: Path) -> bool:
    """Whether the disk of a folder grants locks to anybody, found out by one that nobody else can have."""
    try:
        import fcntl
    except ImportError:  # another system, whose disks do
        return True
    probe = temporary_beside(folder / "lock")
    fd = os.open(probe, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600)
    try:
        fcntl.lockf(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    finally:
        os.close(fd)
        probe.unlink(missing_ok=True)
    return True


def hold_by_name(folder: Path, shared: bool, held: ExitStack) -> str | None:
    """Hold a folder until `held` ends, or tell at once who holds it."""
    mine = folder / (f"{_SHARED}{secrets.token_hex(8)}" if shared else _ALONE)
    if (other := _other(folder, shared, mine)) is not None:
        return other
    try:
        fd = os.open(mine, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o644)
    except FileExistsError:
        return _holder(mine)
    with os.fdopen(fd, "w") as file:
        file.write(f"pid {os.getpid()} on {socket.gethostname()}\n")
    held.callback(mine.unlink, missing_ok=True)
    if (other := _other(folder, shared, mine)) is not None:
        mine.unlink(missing_ok=True)
    return other


def names_of_locks(folder: Path) -> set[str]:
    """Names that such locks have left in a folder, or hold it by."""
    return {name for name in os.listdir(folder) if name == _ALONE or name.startswith(_SHARED)}


def _other(folder: Path, shared: bool, mine: Path) -> str | None:
    """Who holds a folder, if this one does not go together with them."""
    for name in names_of_locks(folder) - {mine.name}:
        if (name == _ALONE or not shared) and (holder := _holder(folder / name)) is not None:
            return holder
    return None


def _holder(name: Path) -> str | None:
    """Whose name it is; None if that one is dead, and then the name goes."""
    try:
        text = read_text(name, _MOST_BYTES).strip()
    except (StoreError, OSError):
        return "another process"
    here = re.fullmatch(rf"pid (\d+) on {re.escape(socket.gethostname())}", text)
    if here is None:
        return f"{text or 'another process'} (this disk keeps no locks: remove {name} if that one is dead)"
    if alive(int(here[1])):
        return text
    with suppress(OSError):
        name.unlink()
    return None

"""A disk that keeps no locks, as Lustre or NFS without them: runs go on, alone or shared out."""

import errno
import fcntl
import os
import shutil
import socket
import sqlite3
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest
from filelock import Timeout

import mcgw
from mcgw.errors import StoreError
from mcgw.jobs.running import run
from mcgw.store import lock
from mcgw.store.lock import LockedError, locked
from mcgw.store.place import tidy

# What filelock makes of ENOLCK and of ENOSYS: SQLite takes the first for a lock that somebody has.
REFUSALS = {errno.ENOLCK: Timeout("lock.db"), errno.ENOSYS: sqlite3.OperationalError("disk I/O error")}


@pytest.fixture(params=REFUSALS, ids=["ENOLCK", "ENOSYS"])
def no_locks(request, monkeypatch):
    def refuse(*_):
        raise OSError(request.param, os.strerror(request.param))

    def none(folder, shared):
        (folder / "lock.db").touch()
        raise REFUSALS[request.param]

    monkeypatch.setattr(fcntl, "lockf", refuse)
    monkeypatch.setattr(lock, "_lock", none)
    monkeypatch.setattr(lock, "PATIENCE", 0.0)


def free(folder, *, shared):
    try:
        with locked(folder, shared=shared):
            return True
    except LockedError:
        return False


def test_one_alone_or_several_that_share(no_locks, tmp_path):
    folder = tmp_path / "e.h5.parts"
    with locked(folder):
        assert not free(folder, shared=False)
        assert not free(folder, shared=True)
        with pytest.raises(LockedError, match=f"locked by pid {os.getpid()} on .*, which is working on"):
            locked(folder).__enter__()
    assert not folder.exists()
    with ExitStack() as first, ExitStack() as second:
        first.enter_context(locked(folder, shared=True))
        second.enter_context(locked(folder, shared=True))
        first.close()
        assert free(folder, shared=True)
        assert not free(folder, shared=False)
    assert free(folder, shared=False)
    assert not folder.exists()


def test_a_run_goes_on_and_leaves_its_file_alone(no_locks, make_scene, tmp_path):
    scene = make_scene(separations=(2.0,), n_surfaces=12)
    for k in (1, 2):
        mcgw.run(scene, tmp_path / "e.h5", shard=f"{k}/2")
    made = run(scene, tmp_path / "e.h5")
    assert (made.load == mcgw.simulate(scene).load).all()
    tidy(tmp_path / "e.h5")
    assert [path.name for path in tmp_path.iterdir()] == ["e.h5"]


@pytest.mark.parametrize("name", ["lock.alone", "lock.shared-0"])
def test_what_the_dead_of_this_host_left_goes(no_locks, name, tmp_path):
    dead = subprocess.Popen([sys.executable, "-S", "-c", ""])
    dead.wait()
    (tmp_path / name).write_text(f"pid {dead.pid} on {socket.gethostname()}\n")
    assert free(tmp_path, shared=False)
    assert not tmp_path.exists()


def test_who_may_live_on_another_host_is_told_and_how_to_go_on(no_locks, tmp_path):
    (tmp_path / "lock.alone").write_text("pid 7 on node12\n")
    with pytest.raises(
        LockedError, match=r"locked by pid 7 on node12 \(this disk has no locks: remove .*alone"
    ):
        locked(tmp_path).__enter__()
    (tmp_path / "lock.alone").unlink()
    assert free(tmp_path, shared=False)


def test_of_two_that_begin_at_once_none_may_go_on(no_locks, tmp_path, monkeypatch):
    """Another takes its name between our look and ours, or ours between our look and that of the name."""
    look, seen = lock._other, []

    def late(folder, shared, mine):
        seen.append(mine.name)
        found = look(folder, shared, mine)
        if len(seen) == 1:
            (folder / name).write_text(f"pid {os.getpid()} on {socket.gethostname()}\n")
        return found

    monkeypatch.setattr(lock, "_other", late)
    for name in ("lock.shared-1", "lock.alone"):
        seen.clear()
        with pytest.raises(LockedError, match=f"locked by pid {os.getpid()} on"):
            locked(tmp_path / "e.parts").__enter__()
        assert [path.name for path in (tmp_path / "e.parts").glob("lock.[as]*")] == [name]
        (tmp_path / "e.parts" / name).unlink()
    assert seen == ["lock.alone"]  # its name was taken: there is nothing more to look for


@pytest.mark.parametrize("text", [b"\xff", b"x" * 201, None])
def test_a_name_that_cannot_be_read_is_another_process(no_locks, text, tmp_path):
    name = tmp_path / "lock.alone"
    if text is None:
        name.mkdir()
    else:
        name.write_bytes(text)
    with pytest.raises(LockedError, match="locked by another process, which is working on this run"):
        locked(tmp_path).__enter__()


def test_where_the_system_has_no_such_locks_the_disk_is_not_asked(tmp_path, monkeypatch):
    assert lock.keeps_locks(tmp_path)
    monkeypatch.setitem(sys.modules, "fcntl", None)
    assert lock.keeps_locks(tmp_path / "nowhere")
    assert not list(tmp_path.iterdir())


def test_a_lock_that_fails_for_another_reason_leaves_no_folder(monkeypatch, tmp_path):
    def fail(folder, shared):
        (folder / "lock.db").touch()
        raise sqlite3.OperationalError("unable to open database file")

    monkeypatch.setattr(lock, "_lock", fail)
    with pytest.raises(StoreError, match="cannot be locked"):
        locked(tmp_path / "e.h5.parts").__enter__()
    assert not list(tmp_path.iterdir())


SHIM = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
static int pass_on(const char *name, int fd, int what, void *how)
{
    if (what == F_SETLK || what == F_SETLKW) {
        errno = atoi(getenv("NO_LOCKS"));
        return -1;
    }
    int (*real)(int, int, ...) = dlsym(RTLD_NEXT, name);
    return real(fd, what, how);
}
#define INSTEAD(name) int name(int fd, int what, ...) { \\
    va_list l; va_start(l, what); void *how = va_arg(l, void *); va_end(l); \\
    return pass_on(#name, fd, what, how); }
INSTEAD(fcntl)
INSTEAD(fcntl64)
int flock(int fd, int how) { errno = atoi(getenv("NO_LOCKS")); return -1; }
"""


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
@pytest.mark.parametrize("refusal", [errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP])
def test_a_whole_command_on_such_a_disk(refusal, tmp_path):
    """The system itself refuses every lock: so the stand-ins above are as SQLite and the system have it."""
    (tmp_path / "shim.c").write_text(SHIM)
    call = ["cc", "-shared", "-fPIC", "-o", tmp_path / "shim.so", tmp_path / "shim.c", "-ldl"]
    subprocess.run(call, check=True, capture_output=True)
    env = os.environ | {"LD_PRELOAD": str(tmp_path / "shim.so"), "NO_LOCKS": str(refusal)}
    scene = Path(mcgw.__file__).parents[1] / "runs" / "quick.toml"
    (tmp_path / "out").mkdir()
    call = [sys.executable, "-m", "mcgw", "run", scene, "-o", tmp_path / "out" / "e.h5"]
    done = subprocess.run(call, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["e.h5"]

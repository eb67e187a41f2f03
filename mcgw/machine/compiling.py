"""Compiled loops, kept on the disk where that can be done.

A loop that is called from others alone is not kept by itself: its callers hold it.

What Numba keeps is the machine code of a loop with that of all loops it calls, under names it takes from
module, function and types. Two things can make it go wrong without a word, and are seen to here: a loop
called has changed in another file (`_stamp_of_package`), and two processes give the versions of a loop one
number (`_name_by_contents`). A function inside a function, which is made several times, would be a third:
all that are made have one name, and there are none (`tests/test_architecture.py`).
"""

import hashlib
import os
import sys
import warnings
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numba
from numba import types
from numba.core.runtime.nrt import rtsys

from mcgw.errors import RunError

__all__ = ["njit"]

if numba.config.DISABLE_JIT:  # type: ignore[attr-defined, unused-ignore]
    raise RunError(
        "NUMBA_DISABLE_JIT is set, but the loops of mcgw count in unsigned words that only compiled code "
        "keeps; unset it",
        code=2,
    )


def njit(**options: Any) -> Callable[[Any], Any]:
    """As `numba.njit`; where a compiled loop cannot be kept for the next time, it is only said.

    Parameters
    ----------
    **options
        Those of `numba.njit`.
    """

    def decorate(function: Any) -> Any:
        try:
            compiled = numba.njit(**{"no_cfunc_wrapper": True, **options})(function)
        except RuntimeError as error:  # no folder can be written to
            if not options.get("cache"):
                raise
            _say("any folder", str(error))
            return numba.njit(**{**options, "cache": False})(function)
        _compile_for_any_number(compiled)
        if options.get("cache"):
            kept = compiled._cache._cache_file
            layer = ".".join(function.__module__.split(".")[:2])
            kept._source_stamp = _stamp_of_package(layer) or kept._source_stamp
            _name_by_contents(kept)
            _go_on_when_full(compiled._cache)
            _load_without_compiler(compiled._cache)
        return compiled

    return decorate


def _compile_for_any_number(compiled: Any) -> None:
    """Let loops that call this one with a constant call the version for any number of that kind."""
    template = compiled.get_call_template

    def for_any_number(args: Any, keywords: Any) -> Any:
        return template(tuple(map(types.unliteral, args)), keywords)

    compiled.get_call_template = for_any_number


@lru_cache
def _stamp_of_package(layer: str) -> bytes:
    """Of all files of the layer that a loop belongs to: Numba looks at none but the own file of the loop."""
    folders = getattr(sys.modules[layer], "__path__", ())
    files = sorted(path for folder in folders for path in Path(folder).rglob("*.py"))
    stamp = hashlib.sha256()
    for path in files:
        stamp.update(path.read_bytes())
    return stamp.digest() if files else b""


def _name_by_contents(kept: Any) -> None:
    """Give each version of a loop a file of its own, whoever compiles another at the same time.

    Numba numbers these files. Two processes that compile at once may give two versions one number, and then
    one is loaded where the other is asked for: a loop that sums fewer moments, without a word.
    """

    def save(key: Any, data: Any) -> None:
        name = kept._data_name(int(hashlib.sha256(repr(key).encode()).hexdigest()[:16], 16))
        kept._save_data(name, data)
        kept._save_index({**kept._load_index(), key: name})

    kept.save = save


def _go_on_when_full(kept: Any) -> None:
    """Let a full disk cost the time of compiling again, not the run."""
    save = kept.save_overload

    def try_to_save(signature: Any, data: Any) -> None:
        try:
            save(signature, data)
        except OSError as error:
            _say(kept.cache_path, error.strerror or str(error))

    kept.save_overload = try_to_save


def _load_without_compiler(kept: Any) -> None:
    """Let machine code that is there run without all that only compiling needs: some 0.4 s a process.

    Numba makes its compiler ready before it looks for what it kept, with the types and functions of all
    of NumPy. To load needs none of them, and to compile makes it ready anyway.
    """

    def load(signature: Any, context: Any) -> Any:
        rtsys.initialize(context)  # what allocates arrays
        found = None
        with kept._guard_against_spurious_io_errors():
            found = kept._load_overload(signature, context)
        if found is None:
            _say_once_on_a_terminal()
        return found

    kept.load_overload = load


@lru_cache(maxsize=1)
def _say_once_on_a_terminal() -> None:
    """Why nothing is seen for a while; in a pipe, or a log, nobody waits."""
    if sys.stderr and sys.stderr.isatty():
        sys.stderr.write("compiling the loops, once for this machine: some 20 s\n")


_SAID: set[str] = set()


def _say(folder: str, reason: str) -> None:
    """Once for each reason, though every package has a folder of its own."""
    if reason in _SAID:
        return
    _SAID.add(reason)
    where = os.environ.get("NUMBA_CACHE_DIR")
    advice = "make room there" if where else "make room there, or set NUMBA_CACHE_DIR to another folder"
    warnings.warn(
        f"compiled loops cannot be kept in {folder} ({reason}) and take 15 s in every process; {advice}",
        stacklevel=2,
    )

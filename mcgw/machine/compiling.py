"""Compiled loops, kept on the disk where that can be done."""

import hashlib
import os
import warnings
from collections.abc import Callable
from typing import Any

import numba

from mcgw.errors import RunError

__all__ = ["njit"]

if numba.config.DISABLE_JIT:  # type: ignore[attr-defined, unused-ignore]
    raise RunError(
        "NUMBA_DISABLE_JIT is set, but the loops of mcgw count in unsigned words that only compiled code "
        "keeps; unset it",
        code=2,
    )


def njit(**options: Any) -> Callable[[Any], Any]:
    """As `numba.njit`; where a compiled loop cannot be kept for the next time, it is only said."""

    def decorate(function: Any) -> Any:
        try:
            compiled = numba.njit(**options)(function)
        except RuntimeError as error:  # no folder can be written to
            if not options.get("cache"):
                raise
            _say("any folder", str(error))
            return numba.njit(**{**options, "cache": False})(function)
        if options.get("cache"):
            _name_by_contents(compiled._cache._cache_file)
            _go_on_when_full(compiled._cache)
        return compiled

    return decorate


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

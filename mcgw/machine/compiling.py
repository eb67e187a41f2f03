"""Compiled loops, cached on the disk if possible.

A loop has two compiled forms. What Python calls is machine code, which is kept. What other loops call is
code that is optimised and made machine code as a part of theirs alone (`_ForLoops`): as Numba has it, each
loop on the way was so by itself before, which nobody runs.

What Numba keeps is the machine code of a loop with that of all loops it calls, under names it takes from
module, function and types. Two things can make it go wrong without a word, and are seen to here: a loop
called has changed in another file (`_stamp_of_package`), and two processes give the versions of a loop one
number (`_name_by_contents`). A function inside a function, which is made several times, would be a third:
all that are made have one name, and there are none (`tests/test_architecture.py`).
"""

import gc
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
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler_lock import global_compiler_lock
from numba.core.runtime.nrt import rtsys
from numba.core.typed_passes import NativeLowering

from mcgw.errors import RunError
from mcgw.machine.terminal import pass_by

if numba.config.DISABLE_JIT:  # type: ignore[attr-defined, unused-ignore]
    raise RunError(
        "NUMBA_DISABLE_JIT is set, but the loops of mcgw need unsigned integers, which only compiled code "
        "has; unset it",
        code=2,
    )


def njit(**options: Any) -> Callable[[Any], Any]:
    """As `numba.njit`; where a compiled loop cannot be kept for the next time, it is only said.

    All let go of Python's lock and divide as NumPy does: what loops with the same options call of Numba's own
    is compiled once for all of them.

    Parameters
    ----------
    **options
        Those of `numba.njit`.
    """
    options = {"no_cfunc_wrapper": True, "nogil": True, "error_model": "numpy", **options}
    kept = options.pop("cache", False)

    def decorate(function: Any) -> Any:
        compiled = numba.njit(**options)(function)
        _hand_to_loops(compiled, numba.njit(**options)(function))
        if kept:
            try:
                compiled.enable_caching()
            except RuntimeError as error:  # no folder can be written to
                _say("any folder", str(error))
            else:
                _keep(compiled._cache, function.__module__)
        return compiled

    return decorate


def _hand_to_loops(compiled: Any, within: Any) -> None:
    """Let loops that call one take its other form, with a constant that for any number of that kind."""

    def template(args: Any, keywords: Any) -> Any:
        return within.get_call_template(tuple(map(types.unliteral, args)), keywords)

    compiled.get_call_template, compiled.get_overload = template, within.get_overload
    compiled._compiler.locals = _FOR_PYTHON
    for loop in (compiled, within):
        _compile_lightly(loop._compiler)


def _compile_lightly(compiler: Any) -> None:
    """Make what a loop calls, of ours and of Numba, code to go into it, and look for no garbage meanwhile.

    Numba makes a million objects for a loop and drops few, which took a seventh of its time to find.
    """
    compile_loop = compiler.compile

    def lightly(*args: Any) -> Any:
        with global_compiler_lock:  # one at a time, so that each restores the right state
            searching, lower = gc.isenabled(), NativeLowering.run_pass
            gc.disable()
            NativeLowering.run_pass = _lower_for_loops  # type: ignore[method-assign, assignment, unused-ignore]
            try:
                return compile_loop(*args)
            finally:
                NativeLowering.run_pass = lower  # type: ignore[method-assign, unused-ignore]
                if searching:
                    gc.enable()

    compiler.compile = lightly


class _CodeForLoops(JITCodeLibrary):  # type: ignore[misc, unused-ignore]
    """Code of a loop, to go into that of others."""

    def finalize(self) -> None:
        """Only take in what the loop calls."""
        for library in dict.fromkeys(self._linking_libraries):
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalized = True


_LOWER = NativeLowering.run_pass
_FOR_PYTHON: dict[str, Any] = {}  # of what Python calls: as such Numba hands it on to no other loop


def _lower_for_loops(step: NativeLowering, state: Any) -> bool:
    """Make such code, without what Python would need to call it."""
    if state.locals is _FOR_PYTHON:
        return bool(_LOWER(step, state))
    state.library = _CodeForLoops(state.targetctx.codegen(), state.func_id.func_qualname)
    state.flags.no_compile = state.flags.no_cpython_wrapper = state.flags.no_cfunc_wrapper = True
    _LOWER(step, state)
    key: Any = {}.update  # some function of C, for that of the loop: by it others find its code
    state["cr"] = state["cr"]._replace(cfunc=key)
    state.targetctx.insert_user_function(key, state["cr"].fndesc, [state.library])
    return True


def _keep(loops: Any, module: str) -> None:
    """Have the compiled forms of a loop found again, under all that they are made of."""
    file = loops._cache_file
    file._source_stamp = _stamp_of_package(".".join(module.split(".")[:2])) or file._source_stamp
    _name_by_contents(file)
    _go_on_when_full(loops)
    _load_without_compiler(loops)


@lru_cache
def _stamp_of_package(layer: str) -> bytes:
    """Of all files of the layer that a loop belongs to, and of this one, by which all are compiled.

    Numba looks at none but the own file of the loop.
    """
    folders = getattr(sys.modules[layer], "__path__", ())
    files = sorted(path for folder in folders for path in Path(folder).rglob("*.py"))
    stamp = hashlib.sha256()
    for path in [*files, Path(__file__)]:
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
        pass_by("")
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
            _count(Path(kept.cache_path))
        return found

    kept.load_overload = load


_WAS_EMPTY: list[bool] = []  # for each compiled loop, whether its folder was empty before
_OF_HERTZ = 12  # loops that a scene takes under Hertz's law (`tests/test_compiled_loops.py`)


def _count(folder: Path) -> None:
    """Report which loop is compiled; the total is known if none was cached."""
    _WAS_EMPTY.append(not any(folder.glob("*.nbi")))
    number = len(_WAS_EMPTY)
    of = f" of {_OF_HERTZ}" if _WAS_EMPTY[0] and number <= _OF_HERTZ else ""
    pass_by(f"compiling the loops, once for this machine: {number}{of}")


_SAID: set[str] = set()


def _say(folder: str, reason: str) -> None:
    """Report each reason once, though every package has its own folder."""
    if reason in _SAID:
        return
    _SAID.add(reason)
    where = os.environ.get("NUMBA_CACHE_DIR")
    advice = "free some space" if where else "free some space, or set NUMBA_CACHE_DIR to another folder"
    warnings.warn(
        f"compiled loops cannot be cached in {folder} ({reason}), so every process takes 10 s to compile "
        f"them; {advice}",
        stacklevel=2,
    )

"""A sweep on its way into a file: chunks that are done lie beside it as sealed shards until all are there.

They lie in ``FILE.h5.parts/sweep/``: ``asked.toml``, which says what is asked, and a shard for each chunk, of
one row each.
"""

import shutil
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import tomli_w

from mcgw.errors import RunError, StoreError
from mcgw.formats.files import check_output, write_whole
from mcgw.formats.plain_file import read_bytes
from mcgw.formats.toml_text import loads
from mcgw.jobs.driver import Signals, heed_signals
from mcgw.scene.scene import LeftOut, Scene
from mcgw.store.disk import parts_of
from mcgw.store.lock import locked
from mcgw.store.shards import Span, commit_shard, open_shard
from mcgw.sweeps.asked import Asked
from mcgw.sweeps.axes import Axes
from mcgw.sweeps.drawing import Chunk, draw
from mcgw.sweeps.file import identity_of, open_sweep, read_attributes, write_sweep
from mcgw.sweeps.pooled import Pooled
from mcgw.sweeps.sweep import Sweep

__all__ = ["recorded_seed", "sweep_in_file"]

_ASKED = "asked.toml"
_MOST_BYTES = 2**23


def sweep_in_file(
    scene: Scene,
    axes: Axes,
    path: Path,
    statistics: tuple[str, ...],
    tell: Callable[[float, float], object],
) -> Sweep:
    """As `mcgw.sweep` with a path: read it, go on with it, or begin it."""
    if isinstance(scene.seed, LeftOut) and (seed := recorded_seed(path)) is not None:
        scene = scene.replace(seed=seed)
    asked = Asked.of(scene, axes)
    check_output(path)
    if not path.exists():
        with heed_signals() as signals, locked(parts_of(path)):
            if not path.exists():  # another process may have been quicker
                _draw(asked, path, signals, tell)
    if read_attributes(path)["run"] != identity_of(asked):
        raise StoreError(f"{path}: holds a different sweep; choose another -o, or remove it")
    _tidy(path)
    return open_sweep(path, statistics)


def recorded_seed(path: Path) -> int | None:
    """The seed of the sweep that is at a place, or in the making there."""
    if path.is_file():
        return int(loads(str(read_attributes(path)["scene"]))["ensemble"]["seed"])
    file = _folder(path) / _ASKED
    return int(_read(file)["seed"]) if file.is_file() else None


def _tidy(path: Path) -> None:
    """Remove the chunks of a file that is there: a process that was killed may have left them."""
    if _folder(path).is_dir():
        with suppress(StoreError, OSError), locked(parts_of(path), patience=0):
            shutil.rmtree(_folder(path), ignore_errors=True)


def _draw(asked: Asked, path: Path, signals: Signals, tell: Callable[[float, float], object]) -> None:
    """Draw what is missing, then write the file. Only with the lock."""
    identity, folder, started = identity_of(asked), _folder(path), perf_counter()
    _begin(folder, identity, asked)
    keeper = _Shards(folder, identity, signals)
    try:
        pooled = draw(asked.groups, keeper, tell)
        write_sweep(asked, pooled, path, wall_seconds=perf_counter() - started)
    except OSError as error:
        raise RunError(
            f"{error.filename or path}: {error.strerror or error}; what is done is kept in {folder}, the "
            "same command goes on once that is mended"
        ) from None
    shutil.rmtree(folder, ignore_errors=True)


@dataclass(frozen=True)
class _Shards:
    """Chunks as shards of one row."""

    folder: Path
    identity: str
    signals: Signals

    def held(self, chunk: Chunk) -> Pooled | None:
        """From its shard, if that is whole."""
        path = self.folder / _span(chunk).file_name
        if path.is_symlink() or not path.is_file():
            return None
        try:
            return Pooled.from_tables({k: v[0] for k, v in open_shard(path, self.identity).arrays().items()})
        except StoreError:
            return None  # it is drawn again

    def keep(self, chunk: Chunk, pooled: Pooled) -> None:
        """Into a shard; then heed a signal."""
        tables = {name: values[None] for name, values in pooled.tables().items()}
        commit_shard(self.folder / _span(chunk).file_name, self.identity, _span(chunk), tables, 0.0)
        self.signals.check(f"what is done is kept in {self.folder}; the same command goes on")


def _span(chunk: Chunk) -> Span:
    return Span(chunk.number, 1)


def _folder(path: Path) -> Path:
    return parts_of(path) / "sweep"


def _begin(folder: Path, identity: str, asked: Asked) -> None:
    """Say what is asked, or refuse what was."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / _ASKED
    if not file.exists():
        said = {"identity": identity, "seed": asked.document["ensemble"]["seed"]}
        write_whole(file, (tomli_w.dumps(said).encode(),), expected=None)
    elif _read(file)["identity"] != identity:
        raise StoreError(f"{folder}: a different sweep was begun there; choose another -o, or remove it")


def _read(file: Path) -> dict[str, Any]:
    try:
        said = loads(read_bytes(file, _MOST_BYTES).decode())
        return {"identity": str(said["identity"]), "seed": int(said["seed"])}
    except (KeyError, TypeError, ValueError) as error:
        raise StoreError(f"{file}: damaged ({error}); remove {file.parent} to start again") from None

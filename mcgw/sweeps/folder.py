"""The folder of a sweep on its way into a file: ``FILE.h5.parts/sweep/``.

::

    asked.toml   what is asked: scene, axes, and the identity of both with the versions that draw
    block-*.h5   a sealed shard of one row for each chunk that is done, by the chunk's number

The set of valid shards is the only record of progress.
"""

import shutil
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import tomli_w

from mcgw.errors import RunError, StoreError
from mcgw.formats.files import write_whole
from mcgw.formats.plain_file import read_bytes
from mcgw.formats.toml_text import loads
from mcgw.store.disk import parts_of
from mcgw.store.lock import refuse_link
from mcgw.store.shards import Shard, Span, commit_shard, open_shard
from mcgw.sweeps.asked import Asked
from mcgw.sweeps.drawing import Chunk, chunks_of
from mcgw.sweeps.file import identity_of
from mcgw.sweeps.pooled import Pooled

__all__ = ["ASKED", "SweepFolder", "folder_of", "remove_sweep", "seed_of"]

ASKED = "asked.toml"
_MOST_BYTES = 2**23


def folder_of(path: Path) -> Path:
    """Where the chunks of the sweep lie that makes a file."""
    return parts_of(path) / "sweep"


@dataclass(frozen=True)
class SweepFolder:
    """The folder of a sweep, open.

    Parameters
    ----------
    folder : Path
        Where it lies.
    asked : Asked
        What is asked.
    identity : str
        Of that.
    """

    folder: Path
    asked: Asked
    identity: str

    @classmethod
    def begin(cls, path: Path, asked: Asked) -> "SweepFolder":
        """Say what is asked for a file, or go on with what was. Only with the lock of `path`.

        Raises
        ------
        StoreError
            If another sweep was begun there.
        """
        folder, identity = folder_of(path), identity_of(asked)
        refuse_link(folder)
        folder.mkdir(parents=True, exist_ok=True)
        scene, axes = asked.texts()
        said = {
            "identity": identity,
            "seed": asked.document["ensemble"]["seed"],
            "scene": scene,
            "axes": axes,
        }
        with suppress(FileExistsError):  # another job may have been quicker
            if not (folder / ASKED).exists():
                write_whole(folder / ASKED, _document(said), expected=None)
        started = cls(folder, asked, identity)
        try:
            if (there := _read(folder)) == said:
                return started
            problem = StoreError(
                f"{folder}: a different sweep was begun there; choose another -o, or remove it"
            )
        except StoreError as error:
            there, problem = {}, error
        if there.get("identity") != identity and not any(map(started.held, started.chunks)):
            raise problem
        write_whole(folder / ASKED, _document(said))  # it was damaged, and the chunks say whose they are
        return started

    @classmethod
    def open(cls, folder: Path) -> "SweepFolder":
        """Read what is asked.

        Raises
        ------
        StoreError
            If there is no sweep, or it cannot be read.
        RunError
            If other versions of what draws began it.
        """
        refuse_link(folder)
        said = _read(folder)
        asked = Asked.from_texts(said["scene"], said["axes"])
        if identity_of(asked) != said["identity"]:
            raise RunError(
                f"{folder}: cannot be gone on with here: {ASKED} was changed, or who began this sweep has "
                "other versions of what draws"
            )
        return cls(folder, asked, said["identity"])

    @cached_property
    def chunks(self) -> list[Chunk]:
        """All chunks of the sweep."""
        return chunks_of(self.asked.groups)

    def missing(self) -> list[Chunk]:
        """Those that no valid shard holds."""
        return [chunk for chunk in self.chunks if self.held(chunk) is None]

    def held(self, chunk: Chunk) -> tuple[Pooled, Shard] | None:
        """What is kept of a chunk, if its shard is there and whole."""
        path = self.folder / _span(chunk).file_name
        if path.is_symlink() or not path.is_file():
            return None
        try:
            shard = open_shard(path, self.identity)
            pooled = Pooled.from_tables({name: values[0] for name, values in shard.arrays().items()})
        except StoreError:
            return None  # it is drawn again
        return (pooled, shard) if pooled.n == chunk.n else None

    def keep(self, chunk: Chunk, pooled: Pooled, seconds: float) -> Shard:
        """Commit what is kept of a chunk, which took so long."""
        tables = {name: values[None] for name, values in pooled.tables().items()}
        return commit_shard(
            self.folder / _span(chunk).file_name, self.identity, _span(chunk), tables, seconds
        )


def remove_sweep(path: Path) -> None:
    """Remove the folder of the sweep that makes a file. Only with the lock."""
    shutil.rmtree(folder_of(path), ignore_errors=True)


def seed_of(path: Path) -> int | None:
    """The seed of the sweep that is in the making for a file, if there is one."""
    folder = folder_of(path)
    return int(_read(folder)["seed"]) if (folder / ASKED).is_file() else None


def _span(chunk: Chunk) -> Span:
    return Span(chunk.number, 1)


def _document(said: dict[str, Any]) -> tuple[bytes]:
    return (tomli_w.dumps(said, multiline_strings=True).encode(),)


def _read(folder: Path) -> dict[str, Any]:
    file = folder / ASKED
    try:
        said = loads(read_bytes(file, _MOST_BYTES).decode())
        texts = {name: str(said[name]) for name in ("identity", "scene", "axes")}
        return {**texts, "seed": int(said["seed"])}
    except (KeyError, TypeError, ValueError) as error:
        if isinstance(error, StoreError):
            raise
        raise StoreError(f"{file}: damaged ({error}); remove {folder} to start again") from None

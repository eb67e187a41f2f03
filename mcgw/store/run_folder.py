"""The folder of a run or a sweep, beside its file: ``demo.h5.parts/``.

::

    run.toml    the frozen scene, the axes of a sweep, the identity of both, the versions that draw, the
                surfaces and the size of a block of each group; last, the SHA-256 of all that stands before
    lock.db     held by whoever writes the file, freed by the system when it dies (`lock`)
    holder      who that is
    shards/     block-0000000000042.h5: the surfaces from number 42 on

The set of valid shards is the only record of progress.
"""

import hashlib
import os
import shutil
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import tomli_w

from mcgw.errors import RunError, StoreError
from mcgw.formats.files import Expected, sync, write_whole
from mcgw.formats.named_files import loads
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_from
from mcgw.scene.section import SceneError
from mcgw.store.identity import difference
from mcgw.store.lock import refuse_link
from mcgw.store.shards import Shard, open_shard
from mcgw.store.spans import Plan, Span

_FILETYPE, _FORMAT = "mcgw-run", [2, 0]
_CHECKSUM = 'sha256 = "'
_MOST_BYTES = 2**23


@dataclass(frozen=True)
class RunFolder:
    """The folder of a run, open.

    Parameters
    ----------
    folder : Path
        Where it lies.
    text : str
        The scene, frozen but for the number of surfaces; of a sweep what all points have in common.
    axes : str
        Of a sweep, as JSON; empty for a run.
    sampler : str
        Never "auto"; empty for a sweep.
    plan : Plan
        Blocks of the surfaces that are asked for.
    identity : str
        See `identity_of`.
    drawn_with : str
        Versions that draw.
    date : str
        When it began.
    """

    folder: Path
    text: str
    axes: str
    sampler: str
    plan: Plan
    identity: str
    drawn_with: str
    date: str

    @cached_property
    def scene(self) -> Scene:
        """What is drawn; of a sweep what its points come from."""
        return scene_from(self.text)

    @cached_property
    def path(self) -> Path:
        """The file that it makes."""
        return self.folder.with_name(self.folder.name.removesuffix(".parts"))  # of `parts_of`

    @property
    def shards_folder(self) -> Path:
        """Where the shards lie."""
        return self.folder / "shards"

    def begin(self) -> "RunFolder":
        """Begin this run, or go on with the one that is there. Only with the lock.

        Raises
        ------
        StoreError
            If it belongs to another scene, seed or version, or is not a folder of a run.
        """
        refuse_link(self.folder)
        self.shards_folder.mkdir(parents=True, exist_ok=True)
        sync(self.folder.parent)
        with suppress(FileExistsError):
            self._write(expected=None)
            return self
        try:
            old = RunFolder.open(self.folder)
        except _DamagedError:
            if not self.shards(numbers=False):
                raise
            self._write(expected="anything")  # its blocks say that they are of this very run
            return self
        if old.identity != self.identity:
            there, here = ((run.text, run.axes, run.drawn_with) for run in (old, self))
            raise StoreError(
                f"{self.folder}: holds a different {'sweep' if self.axes else 'run'}: "
                f"{difference(there, here)}; choose another -o, or remove it"
            )
        sizes = zip(self.plan.groups, old.plan.groups, strict=True)
        plan = replace(self.plan, groups=tuple((n, size) for (n, _), (_, size) in sizes))
        return replace(self, plan=plan, date=old.date)

    def _write(self, *, expected: Expected) -> None:
        document = {
            "filetype": _FILETYPE,
            "format": _FORMAT,
            "identity": self.identity,
            "sampler": self.sampler,
            "blocks": [list(group) for group in self.plan.groups],
            "versions": self.drawn_with,
            "date": self.date,
            "axes": self.axes,
            "scene": self.text,
        }
        text = tomli_w.dumps(document, multiline_strings=True).encode()
        checksum = f'{_CHECKSUM}{hashlib.sha256(text).hexdigest()}"\n'
        write_whole(self.folder / "run.toml", (text, checksum.encode()), expected=expected)

    def freeze(self) -> None:
        """Record how many surfaces are wanted now."""
        if RunFolder.open(self.folder).text != self.text:
            self._write(expected="anything")

    @classmethod
    def open(cls, folder: Path) -> "RunFolder":
        """Read what a run is.

        Raises
        ------
        StoreError
            If there is none, or it cannot be read.
        """
        refuse_link(folder)
        file = folder / "run.toml"
        try:
            fd = os.open(file, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
            with os.fdopen(fd, "rb") as opened:
                data = opened.read(_MOST_BYTES)
            said, text = loads(data.decode()), data.rpartition(_CHECKSUM.encode())[0]
            if said.get("sha256") != hashlib.sha256(text).hexdigest():
                raise _ChangedError
            if said["filetype"] != _FILETYPE or said["format"][0] != _FORMAT[0]:
                raise StoreError(f"{file}: is not a run of format {_FORMAT[0]}.x, but {said['format']}")
            scene, axes, sampler = (str(said[key]) for key in ("scene", "axes", "sampler"))
            known = [str(said[key]) for key in ("identity", "versions", "date")]
            if not all(map(str.isprintable, (sampler, *known))):
                raise ValueError
            groups = tuple((int(n), int(size)) for n, size in said["blocks"])
            whole = bool(axes) or scene_from(scene).keep == "statistics"
            return cls(folder, scene, axes, sampler, Plan(groups, whole), *known)
        except OSError as error:
            raise StoreError(f"{file}: {error.strerror}") from None
        except (SceneError, KeyError, TypeError, ValueError) as error:
            if isinstance(error, StoreError):
                raise
            what = "checksum mismatch" if isinstance(error, _ChangedError) else "it cannot be read"
            raise _DamagedError(
                f"{file}: damaged ({what}); the blocks beside it are kept: resume with mcgw run or mcgw "
                f"sweep, with their scene and seed, or remove {folder}"
            ) from None

    def shards(self, *, numbers: bool = True) -> list[Shard]:
        """Valid shards in order, each looked at; or its head alone, without the `numbers`."""
        return [shard for shard, _ in self._looked_at(numbers=numbers) if shard]

    def sweep(self) -> list[Shard]:
        """As `shards`; whatever else lies there is put aside. Only with the lock."""
        for left in (*self.folder.glob(".*.tmp"), *self.shards_folder.glob(".*.tmp")):
            left.unlink(missing_ok=True)
        valid = []
        for shard, path in self._looked_at():
            if shard:
                valid.append(shard)
            else:
                path.rename(path.with_name(f"{path.name}.bad"))
        return valid

    def _looked_at(self, *, numbers: bool = True) -> Iterator[tuple[Shard | None, Path]]:
        if not self.shards_folder.is_dir():
            raise RunError(f"{self.folder}: is missing or incomplete; run the command again")
        for path in sorted(self.shards_folder.glob("block-*.h5")):
            try:
                shard = None if path.is_symlink() else open_shard(path, self.identity, numbers=numbers)
                yield (shard if shard and self.plan.takes(shard.span) else None), path
            except StoreError:
                yield None, path

    def held(self, span: Span) -> Shard | None:
        """The valid shard of a block, if there is one."""
        path = self.shards_folder / span.file_name
        if path.is_symlink() or not path.is_file():
            return None
        try:
            shard = open_shard(path, self.identity)
        except StoreError:
            return None
        return shard if shard.span == span else None

    def missing(self, done: int, shards: Iterable[Shard]) -> list[Span]:
        """Blocks that neither the file, of `done` surfaces, nor one of the shards holds."""
        done = self.plan.kept(done)
        held = [*([Span(0, done)] if done else []), *(shard.span for shard in shards)]
        return self.plan.missing(held)

    def remove(self) -> None:
        """Remove all but the lock, what identifies the run last. Only with the lock."""
        remove_run(self.folder)


def remove_run(folder: Path) -> None:
    """Remove a run, readable or not; its lock stays, and with it the folder. Only with the lock."""
    shutil.rmtree(folder / "shards", ignore_errors=True)  # a worker that lost its driver may add to it
    for left in (*folder.glob(".*.tmp"), folder / "run.toml"):
        left.unlink(missing_ok=True)


class _DamagedError(StoreError):
    """An empty run.toml."""


class _ChangedError(ValueError):
    """The checksum does not hold."""

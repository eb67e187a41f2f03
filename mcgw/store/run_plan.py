"""What is drawn into a file, points x blocks; and its folder, beside the file: ``demo.h5.parts/``.

::

    run.h5      the frozen scene, the axes of a sweep, the identity of both, the versions that draw
    lock.db     held by whoever writes the file, freed by the system when it dies (`lock`)
    holder      who that is
    shards/     block-0000000000042.h5: the surfaces from number 42 on

All are files of the one writer. A shard holds the results of some consecutive surfaces and is there whole or
not; its attributes are the identity of the run, the numbers of the surfaces, and how long these took. The set
of valid shards is the only record of progress.
"""

from collections.abc import Iterable
from contextlib import suppress
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Labelled, Tables
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import Expected, check_output, sync
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_from
from mcgw.scene.section import SceneError
from mcgw.store.blocks import Shard, Span, blocks_of, open_shard, write_tables
from mcgw.store.h5_reading import look
from mcgw.store.h5_writing import FILETYPE, FORMAT, RUN_TYPE
from mcgw.store.identity import another, commit, identity_of, processor, versions, written
from mcgw.store.lock import parts_of, refuse_link

if TYPE_CHECKING:
    from mcgw.ensemble.drawing import GoOn, Values
    from mcgw.sweeps.points import Points
    from mcgw.sweeps.sweep import Sweep

RECORD = "run.h5"


class Plan:
    """What is drawn into a file: a scene, or groups of scenes that share their surfaces.

    Parameters
    ----------
    path : Path
        The file to be.
    text : str
        The scene as TOML, frozen; of a sweep what all points have in common.
    axes : str
        Of a sweep, as JSON; empty for a scene.
    sampler : str
        Never "auto"; empty for a sweep.
    identity : str
        Of all that the numbers of a surface depend on, whatever their number.
    drawn_with : str
        Versions that draw.
    scene : Scene, optional
        What `text` tells, if that is at hand.
    """

    def __init__(
        self,
        path: Path,
        text: str,
        axes: str,
        sampler: str,
        identity: str,
        drawn_with: str,
        scene: Scene | None = None,
    ) -> None:
        self.path, self.text, self.axes, self.sampler = path, text, axes, sampler
        self.identity, self.drawn_with = identity, drawn_with
        self.scene = scene or scene_from(text)
        self.folder = parts_of(path)  # where the record lies
        self.shards_folder = self.folder / "shards"
        self.question = text, axes, drawn_with  # what its numbers depend on, in words
        self.statistics = bool(axes) or self.scene.keep == "statistics"  # nothing is kept of a single surface

    @classmethod
    def of(cls, asked: "Scene | Points", path: Path, sampler: str = "") -> "Plan":
        """Return that of a sweep, or of a scene with a number of surfaces, not a rule for it.

        A scene is drawn by its own sampler, unless another one has drawn it.

        Raises
        ------
        StoreError
            If the scene cannot be told by a file, or none can be there.
        """
        check_output(path)
        draws = versions(of_draws=True)
        if not isinstance(asked, Scene):
            texts = asked.texts()
            return cls(path, *texts, "", identity_of(*texts, draws), draws)
        from mcgw.ensemble.drawing import reducer_of  # imports the samplers

        reducer, (text, key) = reducer_of(asked), written(asked)
        sampler = sampler or reducer.sampler.name
        plan = cls(path, text, "", sampler, identity_of(key, sampler, draws), draws, asked)
        plan.reducers, plan.of_all = (reducer,), f"{key} {asked.n_surfaces}"
        return plan

    @classmethod
    def open(cls, folder: Path) -> "Plan":
        """Return the one that a folder records.

        Raises
        ------
        StoreError
            If there is none, or it cannot be read.
        """
        refuse_link(folder)
        file, path = folder / RECORD, folder.with_name(folder.name.removesuffix(".parts"))  # of `parts_of`
        if not file.is_file():
            raise StoreError(f"{file}: there is none")
        try:
            said = look(file, RUN_TYPE)
            text, sampler, run, draws = (str(said[key]) for key in ("scene", "sampler", "run", "draws"))
            return cls(path, text, str(said.get("axes", "")), sampler, run, draws)
        except (StoreError, SceneError, KeyError, ValueError) as error:
            what = str(error).splitlines()[0].removeprefix(f"{file}: ")
            raise StoreError(
                f"{file}: {what}; the blocks beside it are kept: resume with mcgw run or mcgw sweep, with "
                f"their scene and seed, or remove {folder}"
            ) from None

    def again(self) -> "Plan":
        """Return what this process makes of the same words, whoever wrote them."""
        return Plan.of(self.points if self.axes else self.scene, self.path)

    @cached_property
    def points(self) -> "Points":
        """The points of a sweep."""
        from mcgw.sweeps.points import Points  # of which most runs are none

        return Points.from_texts(self.text, self.axes)

    @cached_property
    def reducers(self) -> "tuple[Values, ...]":
        """What draws each group, and what of it is kept; a scene is one group.

        Raises
        ------
        SceneError
            With the mistakes of all points of a sweep.
        """
        return tuple(self.points.groups) if self.axes else self.again().reducers

    @cached_property
    def of_all(self) -> str:
        """What the numbers of all surfaces are of: the words under the digest."""
        return f"{self.text}\0{self.axes}" if self.axes else self.again().of_all

    @cached_property
    def blocks(self) -> dict[Span, tuple[int, int]]:
        """Blocks of the surfaces that are asked for, of which group each is and where it begins there."""
        return blocks_of((one.scene.n_surfaces, one.rows) for one in self.reducers)

    @cached_property
    def total(self) -> int:
        """Surfaces of all groups."""
        return sum(one.scene.n_surfaces for one in self.reducers)

    def draw(self, span: Span, threads: int | None, *go_on: "GoOn") -> Tables:
        """Return what is kept of some surfaces of one group; it does not depend on `threads`."""
        from mcgw.ensemble.drawing import use_threads  # imports the samplers

        group, first = self.blocks[span] if self.axes else (0, span.first)
        with use_threads(threads):
            return self.reducers[group].tables(first, first + span.n, *go_on)

    def contents(self, held: list[Any], seconds: float) -> Labelled:
        """Return those of the file, of what is held of each group, with how long it took."""
        found: Ensemble | Sweep
        found = self.points.answered(held) if self.axes else Ensemble(self.scene, self.sampler, *held)
        about = {**self._about(FILETYPE), "title": self.scene.title, "seed": np.uint64(self.scene.seed)}
        about |= {"versions": versions(), "commit": commit(), "cpu": processor(), "wall_seconds": seconds}
        if self.scene.accuracy:
            from mcgw.sampling.samplers import distance_of  # for those scenes alone

            about["accuracy_spent"] = distance_of(self.scene)  # how far from the exact laws it went
        return found.labelled().in_file(about)

    def _about(self, filetype: str) -> dict[str, Any]:
        about = {"filetype": filetype, "format": FORMAT, "scene": self.text, "sampler": self.sampler}
        date = datetime.now(UTC).isoformat(timespec="seconds")
        about |= {"run": self.identity, "draws": self.drawn_with, "date": date}
        return {**about, "axes": self.axes} if self.axes else about

    def begin(self) -> None:
        """Begin, or go on in the folder that is there; if more is wanted than it records, that is recorded.

        Only with the lock.

        Raises
        ------
        StoreError
            If it belongs to another scene, seed or version, or is not a folder of a run.
        """
        refuse_link(self.folder)
        self.shards_folder.mkdir(parents=True, exist_ok=True)
        sync(self.folder.parent)
        with suppress(FileExistsError):
            return self._write(expected=None)
        try:
            old = Plan.open(self.folder)
        except StoreError:
            if not self.shards(numbers=False):
                raise
            return self._write(expected="anything")  # its blocks say that they are of this very run
        if old.identity != self.identity:
            raise another(self.folder, "sweep" if self.axes else "run", old.question, self.question)
        more = self.scene.n_surfaces > old.scene.n_surfaces
        return self._write(expected="anything") if more else None

    def _write(self, *, expected: Expected) -> None:
        write_tables(self.folder / RECORD, {}, self._about(RUN_TYPE), expected)

    def shards(self, *, numbers: bool = True) -> list[Shard]:
        """Return valid shards in order, each looked at; or its head alone, without the `numbers`."""
        if not self.shards_folder.is_dir():
            raise RunError(f"{self.folder}: is missing or incomplete; run the command again")
        looked = (self.shard(path, numbers=numbers) for path in sorted(self.shards_folder.glob("block-*.h5")))
        return [shard for shard in looked if shard]

    def shard(self, path: Path, *, numbers: bool = True) -> Shard | None:
        """Return the shard of a name, if it is there, whole, of this run and of use."""
        shard, rows = open_shard(path, self.identity, numbers=numbers), self.reducers[0].rows
        if shard is None or shard.span in self.blocks:
            return shard
        of_more = not self.axes and shard.span.n == rows and shard.span.first % rows == 0
        return shard if of_more else None  # of the same scene with more surfaces

    def kept(self, done: int) -> int:
        """Of the first surfaces, that a file holds, those in whole blocks: any others are drawn again."""
        return max((span.stop for span in self.blocks if span.stop <= done), default=0)

    def missing(self, done: int, shards: Iterable[Shard]) -> list[Span]:
        """Blocks that neither the file, of `done` surfaces, nor one of the shards holds."""
        done, held = self.kept(done), {shard.span.first for shard in shards}
        return [span for span in self.blocks if span.stop > done and span.first not in held]

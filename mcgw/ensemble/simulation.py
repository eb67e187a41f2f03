"""From a scene to an ensemble in memory.

What is kept of the surfaces of a scene as they are drawn: all their numbers, or what statistics need.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from time import monotonic
from typing import Any

from mcgw.ensemble.drawing import GoOn, Reducer, always, block_size, drawn, drawn_blocks, kept, use_threads
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.forecast import without_rule
from mcgw.ensemble.results import CHUNK_ROWS, Held, MemoryResults, Tables, joined
from mcgw.errors import StoreError
from mcgw.machine.memory import check_memory
from mcgw.machine.progress import Progress, told
from mcgw.sampling.expected import Expected
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.kinds import check_object
from mcgw.scene.scene import Scene, storable, with_sampling

_BYTES = 2**23  # of a block: large enough that its flushing costs little
_DRAWS = 4e8  # numbers drawn for a block: a second or so
_MOST = 2**63 - 1


def simulate(
    scene: Scene, *, threads: int | None = None, progress: Progress = None, **changes: Any
) -> Ensemble:
    """Draw the ensemble of a scene in memory.

    Parameters
    ----------
    scene : Scene
        What to simulate.
    threads : int, optional
        Default: all. The result is the same, bit by bit, for any number.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) surfaces after each block.
    **changes
        Fields of the scene to change: see `mcgw.Scene.replace`.

    Returns
    -------
    Ensemble
        With arrays of shape (surfaces, separations). If `rel_err` or `max_seconds` determined the number
        of surfaces, its scene states this number instead, and reproduces them. A Python function as
        grading becomes a series.

    Raises
    ------
    ValueError
        If `threads` is not positive, or the memory is too small (with the size).
    SceneError, TypeError
        As from `mcgw.Scene.replace`.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], seed=1)
    >>> mcgw.simulate(scene, n_surfaces=20).load.shape
    (20, 3)
    """
    check_object("simulate", scene, Scene)
    scene = scene.replace(**changes) if changes else scene
    until = None if scene.max_seconds is None else monotonic() + scene.max_seconds
    scene = storable(scene)
    if scene.rel_err is not None or scene.max_seconds is not None:
        scene = without_rule(scene)
    reducer, before = reducer_of(scene), 0.0
    reducer.check(scene.n_surfaces if until is None else 0)

    def go_on(done: float) -> bool:
        nonlocal before
        tell(done, scene.n_surfaces)
        if until is None:
            return True
        reducer.check(int(done - before))  # how many there is time for is not known beforehand
        before = done
        return monotonic() <= until

    with use_threads(threads), told(progress, "surfaces") as tell:
        tell(0, scene.n_surfaces)
        (held,) = drawn([reducer], go_on)
    return Ensemble(with_sampling(scene, n_surfaces=held.rows()), reducer.sampler.name, held)


@dataclass(frozen=True)
class Values(Reducer):
    """All numbers of every surface of one scene.

    Parameters
    ----------
    scene : Scene
        With a fixed number of surfaces.
    expected : Expected, optional
        What stands for its sampler, to be asked its size.
    """

    scene: Scene
    expected: Expected | None = None

    @cached_property
    def sampler(self) -> Any:
        """The scene's."""
        return self.expected or sampler_of(self.scene)

    @property
    def n_surfaces(self) -> int:
        """How many surfaces are asked for."""
        return self.scene.n_surfaces

    @cached_property
    def rows(self) -> int:
        """Surfaces of a block: whole chunks of a file."""
        size, row = block_size(self.scene, self.sampler), 8 * self.scene.width
        fitting = min(_BYTES / (size * row), _DRAWS / (size * (self.sampler.draws + 1)))
        rows = size * int(max(fitting, 1))
        return rows - rows % CHUNK_ROWS if rows > CHUNK_ROWS else rows

    @property
    def disk(self) -> int:  # type: ignore[override]
        """Bytes of the blocks, and of the file they are merged into."""
        return 2 * self.joined_bytes(self.n_surfaces)

    def joined_bytes(self, surfaces: int) -> int:
        """Approximate size of the file of so many surfaces, before compression."""
        return 8 * surfaces * self.scene.width

    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """Return the numbers, a row a surface."""
        parts, done = [], first
        for block in drawn_blocks(self.sampler, first, stop, block_size(self.scene, self.sampler)):
            parts.append(kept(self.scene, block))
            done += len(parts[-1][self.scene.quantities[0]])
            if not go_on(done):
                break
        return joined(parts)

    def held(self, blocks: Iterable[Tables]) -> Held:
        """All of them, one below the other."""
        return MemoryResults(joined(list(blocks)))

    def check(self, surfaces: int | None = None) -> None:
        """Refuse what does not fit the memory."""
        scene, n, k = self.scene, self.n_surfaces, len(self.scene.separations)
        if surfaces is not None:
            what = f"ensemble.n_surfaces = {surfaces}: {len(scene.quantities)} quantities at {k} separations"
            check_memory(what, 2 * 8 * surfaces * scene.width)  # the blocks, and all of them joined
            return
        for what, value in (
            ("n_surfaces * n_asperities", n * scene.n_asperities),
            ("n_surfaces * n_asperities * separations", n * scene.n_asperities * k),
            ("bytes of the file", self.disk // 2),
        ):
            if value > _MOST:
                raise StoreError(f"ensemble: {what} = {value:.4g} is more than 2^63 - 1; reduce the scene")
        rows = min(self.rows, n)
        check_memory(f"contact.separations: a block of {rows} surfaces", 3 * 8 * rows * scene.width)


def reducer_of(scene: Scene, expected: Expected | None = None) -> Values:
    """Return the one for what a scene keeps; of a sampler that is only expected, to be asked its size."""
    if scene.keep != "statistics":
        return Values(scene, expected)
    from mcgw.ensemble.summarised import Statistics  # for those scenes alone

    return Statistics(scene, expected)

"""How long a run will take, in a moment and in words."""

from mcgw.ensemble.drawing import seconds_per_surface
from mcgw.sampling.block import Sampler
from mcgw.scene.scene import Scene

__all__ = ["in_words", "seconds_for"]

_PER_SUM = 4e-9  # rough seconds of a result
_PER_COUNT, _PER_PRODUCT = 4e-8, 2.5e-10  # rough seconds of a number, and of two, for statistics
_TRIED = 0.05  # rough seconds of a surface up to which a block is drawn to see


def seconds_for(scene: Scene, sampler: Sampler, surfaces: int, *, at_least: float = 0.0) -> float:
    """Expected wall time of drawing some surfaces on this machine, s.

    From a block drawn on trial where a surface takes little, unless a rough guess lies below `at_least`.
    """
    columns = scene.width
    rough = sampler.draws * sampler.seconds_per_draw + columns * _PER_SUM
    if rough * surfaces < at_least or rough > _TRIED:
        return rough * surfaces
    return surfaces * (seconds_per_surface(scene, sampler) + _seconds_of_statistics(scene))


def _seconds_of_statistics(scene: Scene) -> float:
    """Rough seconds that a surface takes once it is drawn, where its numbers are counted and not kept."""
    if scene.keep != "statistics":
        return 0.0
    return scene.width * _PER_COUNT + scene.width**2 / 2 * _PER_PRODUCT


def in_words(seconds: float) -> str:
    """A time as people say it.

    Examples
    --------
    >>> in_words(200), in_words(90_000), in_words(1e9)
    ('3.3 min', '25 h', '32 years')
    """
    for size, name in ((3.15576e7, "years"), (86_400 * 3, "days"), (3600.0, "h"), (60.0, "min")):
        if seconds >= size:
            return f"{seconds / (86_400 if name == 'days' else size):.2g} {name}"
    return f"{seconds:.2g} s"

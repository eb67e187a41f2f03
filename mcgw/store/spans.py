"""Which surfaces are drawn together: blocks, numbered through all groups of surfaces that are asked for."""

from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate


@dataclass(frozen=True, order=True)
class Span:
    """Surfaces `first` ... `first + n - 1`."""

    first: int
    n: int

    @property
    def stop(self) -> int:
        """The surface after the last one."""
        return self.first + self.n

    @property
    def file_name(self) -> str:
        """Name of its shard."""
        return f"block-{self.first:013d}.h5"

    def __str__(self) -> str:
        return f"surfaces {self.first} ... {self.stop - 1}"


@dataclass(frozen=True)
class Plan:
    """Surfaces of one or more groups, one group after the other, cut into blocks.

    Parameters
    ----------
    groups : tuple of (int, int)
        Of each group its number of surfaces, and how many of them make a block; a run has one group.
    whole : bool
        Whether a block is of use as a whole only, since nothing is kept of a single surface.
    """

    groups: tuple[tuple[int, int], ...]
    whole: bool = False

    @cached_property
    def _starts(self) -> list[int]:
        """First surfaces of the groups."""
        return list(accumulate((n for n, _ in self.groups[:-1]), initial=0))

    @property
    def total(self) -> int:
        """Number of surfaces of all groups."""
        return self._starts[-1] + self.groups[-1][0]

    def group(self, span: Span) -> tuple[int, int]:
        """Return the group that some surfaces are of, and the number of the first one within it."""
        g = bisect_right(self._starts, span.first) - 1
        return g, span.first - self._starts[g]

    def number(self, span: Span) -> int:
        """Return the number of the block, of all, that some surfaces are of."""
        g, first = self.group(span)
        return sum(-(-n // size) for n, size in self.groups[:g]) + first // self.groups[g][1]

    def missing(self, held: Iterable[Span]) -> list[Span]:
        """Blocks that fill what is not held, cut where a block ends."""
        gaps, stop, total = list[Span](), 0, self.total
        for span in (*sorted(held), Span(total, 1)):
            while stop < min(span.first, total):
                g, first = self.group(Span(stop, 1))
                n, size = self.groups[g]
                end = min(span.first, self._starts[g] + min((first // size + 1) * size, n))
                gaps.append(Span(stop, end - stop))
                stop = end
            stop = max(stop, span.stop)
        return gaps

    def kept(self, done: int) -> int:
        """Of the first surfaces, that a file holds, those that it need not be given again."""
        if not self.whole or done >= self.total:
            return done
        return done - self.group(Span(done, 1))[1] % self.groups[0][1]

    def takes(self, span: Span) -> bool:
        """Whether a shard of these surfaces is of use."""
        if not self.whole:
            return True
        g, first = self.group(span)
        n, size = self.groups[g]
        return first % size == 0 and (span.n == size or first + span.n == n)

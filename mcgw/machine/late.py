"""What is imported only when it is asked for, because it is heavy, optional or lies in a layer above."""

from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["without_help"]


@contextmanager
def without_help() -> Iterator[None]:
    """Import matplotlib for a command: without the help on each class, for whose text it takes 0.3 s."""
    import matplotlib.artist as artist

    kwdoc = artist.kwdoc
    artist.kwdoc = lambda _: ""  # type: ignore[assignment]
    try:
        yield
    finally:
        artist.kwdoc = kwdoc

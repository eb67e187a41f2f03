"""Poisson's ratio of a body, checked."""

__all__ = ["checked_poisson"]


def checked_poisson(poisson: float) -> float:
    """Poisson's ratio, if it is one.

    Raises
    ------
    ValueError
        If not.
    """
    if not -1 < poisson <= 0.5:
        raise ValueError(f"poisson = {poisson!r}: give a Poisson's ratio between -1 and 0.5")
    return poisson

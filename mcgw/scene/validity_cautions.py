"""Where a model is more than ten per cent off elasticity, or loaded beyond what was measured."""

from collections.abc import Iterator

import numpy as np

from analytic.arrays import Marks
from mcgw.scene.validity import Validity, percent, span

_OFF = 0.1  # error of area, stiffness or load from which on it is said
_AT_LOAD = ("area", "stiffness")
_QUANTITIES = (*_AT_LOAD, "load")


def off_elasticity(v: Validity, why: str) -> Iterator[str]:
    """Errors above 10 % by their size, and loads above those that were measured."""
    biased = {name: _above(v, name) & ~_scatters(v, name) for name in _QUANTITIES}
    if (off := _any(biased)).any():
        yield (f"d/sigma = {span(v.separations, off)}: off elasticity, {'; '.join(_told(v, biased))}: {why}")
    loose = {name: _above(v, name) & _scatters(v, name) for name in _QUANTITIES}
    if (off := _any(loose)).any():
        yield (
            f"d/sigma = {span(v.separations, off)}: surfaces of so few contacts scatter, "
            f"{'; '.join(_told(v, loose))}"
        )
    heavier = ~v.measured & (v.separations < _first_measured(v))
    if heavier.any():
        yield (
            f"d/sigma = {span(v.separations, heavier)}: heavier loads than any that was measured "
            f"({v.axis} up to {v.loads[heavier].max():.2g}); the error is not known"
        )


def _above(v: Validity, name: str) -> Marks:
    return np.asarray(v.error[name] > _OFF)


def _first_measured(v: Validity) -> float:
    return float(v.separations[v.measured].min()) if v.measured.any() else -np.inf


def _scatters(v: Validity, name: str) -> Marks:
    """Where an error is rather scatter than bias."""
    return np.asarray(v.error[name] > 2 * np.abs(v.bias[name]))


def _any(masks: dict[str, Marks]) -> Marks:
    return np.asarray(np.any(np.array([*masks.values()]), axis=0))


def _told(v: Validity, where: dict[str, Marks]) -> Iterator[str]:
    """The largest error of each quantity among these separations, those at a given load first."""
    sizes = {name: _size(v, name, mask) for name, mask in where.items() if mask.any()}
    at_load = [sizes[name] for name in _AT_LOAD if name in sizes]
    if at_load:
        yield f"{', '.join(at_load)} at that load"
    if "load" in sizes:
        yield f"{sizes['load']} at that mean gap"


def _size(v: Validity, name: str, where: Marks) -> str:
    k = int(np.argmax(np.where(where, v.error[name], -np.inf)))
    size = f"{name} up to {percent(float(v.error[name][k]))}"
    if _scatters(v, name)[k]:
        return f"{size} either way"
    return f"{size} too {'large' if v.bias[name][k] > 0 else 'small'}"

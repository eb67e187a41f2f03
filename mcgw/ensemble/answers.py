"""Answers at a load by name: found when they are asked for, exactly where no surface need be drawn."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from analytic import quantity_of
from analytic.at_load import Moments, specimen_moments
from mcgw.ensemble.at_load import GAPS, asperities_of, quantities_at
from mcgw.scene.scene import Scene


class Answers(Mapping[str, float]):
    """Answers by name, each found when it is first asked for.

    Parameters
    ----------
    names : sequence of str
        All that there are.
    find : callable
        Finds the one of a name.
    """

    def __init__(self, names: Sequence[str], find: Callable[[str], float]) -> None:
        """Find nothing yet."""
        self._names, self._find, self._found = tuple(names), find, dict[str, float]()

    def __getitem__(self, name: str) -> float:
        """Return an answer; KeyError if there is no such."""
        if name not in self._names:
            raise KeyError(name)
        if name not in self._found:
            self._found[name] = float(self._find(name))
        return self._found[name]

    def __contains__(self, name: object) -> bool:
        """Tell whether there is such an answer, without finding it."""
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names."""
        return iter(self._names)

    def __len__(self) -> int:
        """Count the answers."""
        return len(self._names)

    def __repr__(self) -> str:
        """Show all, as a dict."""
        return repr(dict(self))


def exact_moments(scene: Scene, given: str, amount: float, theory: Mapping[str, float]) -> Moments:
    """Means and standard deviations over specimens that need no draw: by quadrature, in SI units.

    Parameters
    ----------
    scene : Scene
        Of the specimens.
    given, amount : str, float
        The sum that all have, and its value.
    theory : mapping
        Answers of an infinite surface: see `mcgw.ensemble.at_load.answers_at`.

    Returns
    -------
    Moments
        Of what is given alone, where the rest is not known or takes longer than to draw.
    """
    sigma, alone = scene.surface.sigma, asperities_of(scene)
    known = Moments({given: amount}, {given: 0.0})
    if alone.curvature is not None or alone.as_measured or given == "nominal_separation":
        return known
    summed = [name for name in quantities_at(alone) if name in theory and name != given]
    summed = [name for name in summed if quantity_of(name).base != "load_slope"]
    try:
        with np.errstate(all="ignore"):
            found = specimen_moments(alone.theory, given, amount, summed)
    except (ValueError, IndexError):  # far up, where hardly any asperity of any surface is
        return known
    if not np.isfinite([*found.mean.values(), *found.std.values()]).all():
        return known
    mean, std = (
        {name: x for name, x in part.items() if name == "separation" or not scene.series(name)}
        for part in found
    )
    lift = mean["separation"] - theory["separation"]
    moved: tuple[str, ...] = ()
    if scene.interaction is None:
        moved = (scene.gap,)
        for part in (mean, std) if "conductance_si" in mean else ():
            spots = part["contact_conductance"] = part["conductance_si"] / scene.surface.nominal_area
            if scene.filled is not None and scene.filled.gas is None:
                part |= {"gap_conductance": 0.0, "joint_conductance": spots}
    elif given == "load":
        moved = ("nominal_separation", *GAPS)
    for name in moved:  # from the separation alike on all surfaces
        if name in theory:
            unit = sigma if name in GAPS else 1.0
            mean[name], std[name] = theory[name] + unit * lift, unit * std["separation"]
    return Moments(mean | known.mean, std | known.std)

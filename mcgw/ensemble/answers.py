"""Answers at a load by name: found when they are asked for, exactly where no surface need be drawn."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from analytic import quantity_of
from analytic.at_load import Moments, specimen_moments
from analytic.distribution.of_model import check_falling
from mcgw.ensemble.at_load import GAPS, quantities_at
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


def all_are_known(scene: Scene, given: str, theory: Mapping[str, float]) -> bool:
    """Tell whether `exact_moments` has all answers, if it has more than what is given.

    Parameters
    ----------
    scene, given, theory
        As there.

    Returns
    -------
    bool
        False where some answer is no sum, as a resistance, or where sums are not known at all.
    """
    known = {given, "load_slope", *_from_sums(scene, theory), *_from_the_separation(scene, given)}
    return _known_by_quadrature(scene, given) and known.issuperset(theory)


def surely_reached(scene: Scene, given: str, lowest: float) -> bool:
    """Tell without integrals whether every surface reaches what is given.

    Parameters
    ----------
    scene, given
        As in `exact_moments`.
    lowest : float
        Separation that nearly every surface is above, d/sigma.

    Returns
    -------
    bool
        False where only `exact_moments` can tell, as with a Poisson number of asperities, which may be 0.
    """
    if scene.count != "fixed" or scene.n_asperities < 2 or scene.negative_above(lowest) is not None:
        return False
    try:
        check_falling(scene.alone, given, lowest)
    except ValueError:
        return False
    return True


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
    known = Moments({given: amount}, {given: 0.0})
    if not _known_by_quadrature(scene, given):
        return known
    summed = [name for name in quantities_at(scene) if name in theory and name != given]
    summed = [name for name in summed if quantity_of(name).base != "load_slope"]
    try:
        with np.errstate(all="ignore"):
            found = specimen_moments(scene.alone, given, amount, summed)
    except (ValueError, IndexError):  # far up, where hardly any asperity of any surface is
        return known
    if not np.isfinite([*found.mean.values(), *found.std.values()]).all():
        return known
    sources = _from_sums(scene, theory)
    mean, std = (
        {name: unit * part[of] for name, (of, unit) in sources.items() if of in part} | own
        for part, own in zip(found, known, strict=True)
    )
    lift = found.mean["separation"] - theory["separation"]
    for name, unit in _from_the_separation(scene, given).items():
        if name in theory:
            mean[name], std[name] = theory[name] + unit * lift, unit * found.std["separation"]
    return Moments(mean, std)


def _known_by_quadrature(scene: Scene, given: str) -> bool:
    """Whether the law of the sums of its asperities is known, or quicker to find than to draw."""
    return scene.curvature is None and not scene.as_measured and given != "nominal_separation"


def _from_sums(scene: Scene, theory: Mapping[str, float]) -> dict[str, tuple[str, float]]:
    """Answers that are a sum over asperities, or in proportion to one: which, and by how much."""
    sums = [name for name in quantities_at(scene) if not scene.series(name)]
    found = {name: (name, 1.0) for name in ("separation", *sums)}
    if scene.interaction is None and scene.film is not None:
        spots = ("conductance_si", 1 / scene.surface.nominal_area)
        found["contact_conductance"] = spots
        if scene.filled is not None and scene.filled.gas is None:
            found |= {"gap_conductance": ("conductance_si", 0.0), "joint_conductance": spots}
    return {name: found[name] for name in found if name in theory}


def _from_the_separation(scene: Scene, given: str) -> dict[str, float]:
    """Answers that differ from the separation by the same on all surfaces, with their unit over its own."""
    if scene.interaction is None:
        return {scene.gap: scene.surface.sigma}
    if given != "load":
        return {}
    return {"nominal_separation": 1.0, **dict.fromkeys(GAPS, scene.surface.sigma)}

"""Error budget of an answer at a given load, cause by cause; and the answer corrected by measured errors.

The answer is the mean over specimens; it is compared with a real specimen of the scene's nominal area.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from analytic import Nayak, RandomCurvature, SpectralMoments
from analytic.arrays import Array
from mcgw.ensemble.at_load import GAPS, joint_conductance, mean_surface
from mcgw.formats.table import Column, Shown, Table
from mcgw.scene.measured import Uncertainty
from mcgw.scene.scene import Scene
from mcgw.validity.model_error import Validity, percent

LINES = ("drawn surfaces", "specimens", "parameters", "model")
Answers = Mapping[str, float]

_SURE = 1.96  # standard deviations on either side that hold 95 %
_LARGE = 0.2  # share of an answer
MOST_YIELDING = 0.05  # share of the contacts past first yield that an elastic law bears
_STEP = 1e-3  # step of ln(parameter): a central difference has a relative error of 1e-6
# Measured error of each answer. The conductance of spots without a film has that of stiffness, to which it is
# proportional: Barber (2003), Proc. R. Soc. A 459, 53. That of a joint follows from its network.
_ERROR_OF = {"area": "area", "stiffness": "stiffness"}
_ERROR_OF |= dict.fromkeys(("conductance", "contact_conductance", "joint_conductance"), "stiffness")
_ERROR_OF |= dict.fromkeys(GAPS, "separation")
_SPOTS = ("conductance", "contact_conductance", "joint_conductance")
_FILM = "a film or layer is not part of what was measured"
_LOWERED = {
    "drawn surfaces": "draw more surfaces",
    "specimens": "use a larger nominal area or several specimens",
    "parameters": "measure a larger map or several",
    "model": "use the corrected value if there is one",
}


class Corrected(NamedTuple):
    """An answer corrected for the measured error of its model.

    Parameters
    ----------
    value, low, high : float
        SI units; 95 % of surfaces like those measured lie between `low` and `high`. nan where nothing was
        measured.
    why : str
        Why there is no value; empty if there is one.
    """

    value: float = math.nan
    low: float = math.nan
    high: float = math.nan
    why: str = ""


@dataclass(frozen=True, repr=False)
class Budget(Shown):
    """Error budget: bounds within which 95 % of real specimens differ from an answer, cause by cause.

    Parameters
    ----------
    title : str
        Name of the answer.
    shares : dict of str to ndarray
        Half-widths divided by the answer: for each of `LINES`, one value for each of `quantities`; nan where
        unknown.
    quantities : tuple of str
        Names of the answers.
    lacking : dict of str to str
        For each line without a number, the reason why.
    parts : dict of str to float
        Half-width that each parameter of the surface alone causes in the first quantity.
    """

    title: str
    shares: dict[str, Array]
    quantities: tuple[str, ...]
    lacking: dict[str, str]
    parts: dict[str, float]

    @property
    def all(self) -> Array:
        """Total: root of the sum of squares of the lines; nan where one but the parameters is not known.

        Parameters without an uncertainty are taken as given.
        """
        squares = {line: share**2 for line, share in self.shares.items()}
        squares["parameters"] = np.nan_to_num(squares["parameters"])
        return np.asarray(np.sqrt(np.sum([*squares.values()], axis=0)))

    def told(self, name: str, best: Corrected, scatter: float) -> str:
        """95 % of a corrected answer; without one, the `scatter` of specimens and that more is not known."""
        if np.isnan(best.value):
            return f"(scatter of specimens {percent(scatter)}; error of the model not known)"
        parameters = float(np.nan_to_num(self.shares["parameters"][self.quantities.index(name)]))
        return f"± {percent(math.hypot((best.high - best.low) / (2 * best.value), parameters))}"

    def _largest(self) -> tuple[str, float]:
        """Return the line that dominates the first quantity, and its share; not surfaces that none drew."""
        first = {line: float(share[0]) for line, share in self.shares.items() if not np.isnan(share[0])}
        if not first.get("drawn surfaces"):
            first.pop("drawn surfaces", None)
        return max(first.items(), key=lambda item: item[1], default=("specimens", math.nan))

    @property
    def brief(self) -> str:
        """Which line dominates the first quantity, what would lower a large one, and which are not known."""
        most, share = self._largest()
        remedy = f" ({_LOWERED[most]})" if share > _LARGE else ""
        without = f"; not included: {' and '.join(self.lacking)}" if self.lacking else ""
        return f"Main error: {most}{remedy}{without}"

    @property
    def advice(self) -> str:
        """Which line dominates the first quantity, and what would lower it."""
        most, share = self._largest()
        of = ""
        if most == "parameters":
            of = f" (above all {max(self.parts, key=lambda name: self.parts[name])})"
        told = f"{self.quantities[0]}: mostly the {most}{of}, ±{percent(share)}: {_LOWERED[most]}"
        unknown = "; ".join(f"{line} ({why})" for line, why in self.lacking.items())
        return f"{told}. Not included: {unknown}" if unknown else told

    def table(self) -> Table:
        """Return a row for each line, and the total."""
        rows = [*self.shares.values(), self.all]
        columns = (
            Column(name, [row[k] for row in rows], name.replace("_", " "), form=".2%", missing="not known")
            for k, name in enumerate(self.quantities)
        )
        return Table((Column("95 %", [*self.shares, "all"]), *columns), self.title)

    def sheet(self) -> Table:
        """Return the lines, and what would reduce the total."""
        return self.table().under(self.title, [("advice", self.advice)])


def budget_of(solution: Any) -> Budget:
    """Make the budget of a solution: see `mcgw.ensemble.solved.Solution.budget`, which calls this."""
    scene, given, value = solution.scene, solution.given, solution.value
    asked = [name for name in ("load", *_ERROR_OF) if name != given]
    if scene.film is not None:  # in SI units instead
        asked.remove("conductance")
    names = tuple(name for name in asked if name in value)
    answers = np.array([value[name] for name in names])
    lacking, parts = {}, {}
    with np.errstate(divide="ignore", invalid="ignore"):
        drawn = np.array([(high - low) / 2 for low, high in map(solution.interval, names)]) / answers
        scatter = _SURE * np.array([solution.std[name] for name in names]) / answers
    parameters = np.full(len(names), np.nan)
    if scene.uncertainty is None:
        lacking["parameters"] = "give [surface] uncertainty, which mcgw fit writes"
    else:
        again = partial(mean_surface, given=given, value=solution.amount)
        slopes = slopes_of(scene, scene.uncertainty, again, names)
        parameters = _SURE * np.sqrt(np.einsum("ki,ij,kj->k", slopes, scene.uncertainty.covariance, slopes))
        alone = _SURE * np.abs(slopes[0]) * np.sqrt(np.diag(scene.uncertainty.covariance))
        parts = dict(zip(scene.uncertainty.names, alone.tolist(), strict=True))
    errors = [_measured(solution, name) for name in names]
    relative = [scene.surface.sigma / abs(value[name]) if name in GAPS else 1.0 for name in names]
    model = np.array([error for _, error, _ in errors]) * relative
    if errors[0][2]:
        lacking["model"] = errors[0][2]
    lines = dict(zip(LINES, (np.abs(drawn), np.abs(scatter), parameters, model), strict=True))
    return Budget(solution.title, lines, names, lacking, parts)


def yields(share: float) -> str:
    """Why the error of an elastic law is not known where so many contacts yield; empty if it is."""
    if not share > MOST_YIELDING:
        return ""
    return f'{share:.0%} of the contacts yield: use contact.law = "kogut-etsion"'


def slopes_of(
    scene: Scene, uncertain: Uncertainty, again: Callable[[Scene], Answers], names: tuple[str, ...]
) -> Array:
    """Return d log(answer) / d log(parameter) at a given load, shape (names, parameters).

    Central differences of the exact theory.
    """
    ends = [[again(moved(scene, {p: side * _STEP})) for side in (1, -1)] for p in uncertain.names]
    here = again(scene)
    return np.array([[(up[x] - down[x]) / (2 * _STEP * here[x]) for up, down in ends] for x in names])


def moved(scene: Scene, steps: dict[str, float]) -> Scene:
    """Return the scene with other parameters of its surface, by steps of their logarithms."""
    factors = {name: math.exp(step) for name, step in steps.items()}
    surface, heights, curvature = scene.surface, scene.heights, scene.summits
    if any(name in factors for name in ("m0", "m2", "m4")):
        assert isinstance(heights, Nayak)  # only these have uncertain moments
        old = SpectralMoments.with_alpha(heights.alpha, surface)
        m = SpectralMoments(*(getattr(old, name) * factors.get(name, 1.0) for name in ("m0", "m2", "m4")))
        surface, heights = m.surface(surface.nominal_area, surface.E_star), Nayak(m.alpha)
        if isinstance(curvature, RandomCurvature):
            flattest = curvature.largest * scene.surface.radius / surface.radius
            curvature = RandomCurvature(m.alpha, flattest)
    own = {name: getattr(surface, name) * x for name, x in factors.items() if name not in ("m0", "m2", "m4")}
    return scene.replace(surface=replace(surface, **own), heights=heights, summits=curvature)


def corrected(solution: Any, quantity: str) -> Corrected:
    """`value`, corrected by the measured error of the model against boundary elements.

    Parameters
    ----------
    quantity : str
        "area", "stiffness", "conductance", "contact_conductance", "joint_conductance", "mean_gap" or
        "gap_to_summits". Spots have the error of stiffness, to which they are proportional without a film
        (Barber, 2003, Proc. R. Soc. A 459, 53); a joint that of its network of spots and gas.

    Returns
    -------
    Corrected
        With the ends between which 95 % of such surfaces lie; nan where nothing was measured, with the
        reason in `why`.
    """
    bias, error, why = _measured(solution, quantity)
    if why:
        return Corrected(why=why)
    value, off = solution.value[quantity], error - abs(bias)
    scatter = _SURE * solution.std[quantity] * solution.against_elasticity.listed
    besides = math.hypot(scatter, solution.half_width(quantity))
    if quantity in GAPS:
        sigma = solution.scene.surface.sigma
        right, off = value - bias * sigma, math.hypot(off * sigma, besides)
        return Corrected(right, right - off, right + off)
    right, factor = value / (1 + bias), 1 + math.hypot(off / (1 + bias), besides / value)
    return Corrected(right, right / factor, right * factor)


def _measured(solution: Any, name: str) -> tuple[float, float, str]:
    """Bias of an answer and its error, of the right value, of a gap over sigma; or why neither is known."""
    scene, given, validity = solution.scene, solution.given, solution.against_elasticity
    film = scene.film
    filmed = film is not None and (film.film_resistance > 0 or film.layer is not None)
    if given != "load":
        why = f"its error was measured at a given load, not at a given {given.replace('_', ' ')}"
    elif name not in _ERROR_OF:
        why = f"{name}: its error was not measured"
    elif not (why := yields(solution.yielding)) and name in _SPOTS and filmed:
        why = _FILM
    if why:
        return math.nan, math.nan, why
    if name == "joint_conductance":
        bias, error = _of_joint(validity, scene, solution.value)
    else:
        bias, error = (float(each[_ERROR_OF[name]][0]) for each in (validity.bias, validity.error))
    return bias, error, validity.unknown or f"{name}: not measured there" if math.isnan(error) else ""


def _of_joint(validity: Validity, scene: Scene, answers: Answers) -> tuple[float, float]:
    """As `_measured` of a joint: from its network with the right spots and gap.

    The errors of spots and gap, through the derivatives of the network, are added as independent ones.
    """
    assert scene.filled is not None
    spots, gap = (
        (float(validity.bias[x][0]), float(validity.error[x][0])) for x in ("stiffness", "separation")
    )
    if scene.filled.gas is None:  # a vacuum is as empty in any gap
        gap = (0.0, 0.0)

    def network(factor: float, lift: float) -> float:
        spots_si = factor * answers["contact_conductance"] * scene.surface.nominal_area
        apart = answers["nominal_separation" if scene.from_mean_plane else "separation"] - lift
        return float(joint_conductance(scene, spots_si, apart))

    factor, lift = 1 / (1 + spots[0]), gap[0]
    right = network(factor, lift)
    by_spots = (network(factor + _STEP, lift) - network(factor - _STEP, lift)) / (2 * _STEP)
    by_gap = (network(factor, lift + _STEP) - network(factor, lift - _STEP)) / (2 * _STEP)
    off = math.hypot(by_spots * (spots[1] - abs(spots[0])) * factor**2, by_gap * (gap[1] - abs(gap[0])))
    bias = network(1.0, 0.0) / right - 1
    return bias, abs(bias) + off / right * (1 + bias)

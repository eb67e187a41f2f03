"""What models of asperities say of a map: contact at a load, and the load at a mean gap. E* = 1, side 1.

A model is a list of summits, each counted with a weight: those of a law of `analytic` on a fine grid of
heights, or the very caps of a map. All sums over it are Hertz's. In a periodic cell whose mean gap is h the
asperities feel a separation x = h - u: what a load on one of n places presses down there is less than what
is pressed down on average (Ciavarella, Greenwood and Paggi 2008), for a square lattice by
u = 1.2415 p/(E* sqrt(n)).
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from rough_maps import CapsMap
from scipy.optimize import brentq

from analytic import Nayak, RandomCurvature, SpectralMoments
from analytic.interaction import LATTICE

Array = NDArray[np.float64]
Interaction = Literal["none", "summits", "contacts"]

MODELS = ("one radius", "nayak", "own radii")
INTERACTIONS: tuple[Interaction, ...] = ("none", "summits", "contacts")
SHOWN = {"none": "", "summits": " + interaction (summits)", "contacts": " + interaction (contacts)"}
SQUARE_LATTICE = LATTICE / math.pi
LOWEST, HIGHEST, HEIGHTS = -6.0, 8.0, 7000  # heights over their deviation; how many
_STEPS = 100  # in which the first root is looked for


@dataclass(frozen=True)
class Contact:
    """All per area: load (of E*), real area, stiffness -dp/dx (of E*), loaded spots, and -d(spots)/dx."""

    load: float
    area: float
    stiffness: float
    spots: float
    spots_slope: float


@dataclass(frozen=True)
class Summits:
    """Summits that bear load on their own.

    Parameters
    ----------
    heights : ndarray
        Above the mean plane, shape (k,), increasing.
    weights, root_radius, radius : ndarray
        Summits an area of each height, and the means of the root of their radius and of it.
    step : float
        Of the heights, if they stand for a density; 0 for a list of summits.
    """

    heights: Array
    weights: Array
    root_radius: Array
    radius: Array
    step: float = 0.0

    @property
    def density(self) -> float:
        """Summits an area."""
        return float(self.weights.sum())

    def at(self, x: float) -> Contact:
        """Contact at a separation."""
        first = int(np.searchsorted(self.heights, x, side="right"))
        weights, depth = self.weights[first:], self.heights[first:] - x
        bearing = weights * self.root_radius[first:] * np.sqrt(depth)
        load, stiffness = float(4 / 3 * bearing @ depth), float(2 * bearing.sum())
        spots, slope = self._spots(x, load / stiffness if stiffness else 0.0)
        area = float(math.pi * (weights * self.radius[first:]) @ depth)
        return Contact(load=load, area=area, stiffness=stiffness, spots=spots, spots_slope=slope)

    def _spots(self, x: float, width: float) -> tuple[float, float]:
        """How many summits are higher, and the slope; of a list, which jumps, that over some width."""
        if self.step:  # each weight is spread over a step
            edge = (x - self.heights[0]) / self.step + 0.5
            cell = min(max(int(edge), 0), self.heights.size - 1)
            share, weight = min(max(edge - cell, 0.0), 1.0), float(self.weights[cell])
            return float(self.weights[cell:].sum()) - share * weight, weight / self.step
        above = [float(self.weights[self.heights > level].sum()) for level in (x - width, x, x + width)]
        return above[1], (above[0] - above[2]) / (2 * width) if width else 0.0

    def separation(self, load: float) -> float:
        """Where they bear a load."""
        low, high = float(self.heights[0]), float(self.heights[-1])
        width = high - low
        while self.at(low).load < load:
            low -= width
        return float(brentq(lambda x: self.at(x).load - load, low, high, xtol=1e-12 * width, rtol=1e-14))


@lru_cache(maxsize=64)
def summits_of(model: str, m0: float, m2: float, m4: float) -> Summits:
    """Summits of a Gaussian surface with these moments.

    Parameters
    ----------
    model : str
        "one radius": Gaussian heights of the summits' deviation, one radius (what ``mcgw fit`` writes);
        "nayak": Nayak's heights, one radius; "own radii": these, and to each summit its curvature.
    m0, m2, m4 : float
        Of profiles; the side of the cell is 1.
    """
    moments = SpectralMoments(m0, m2, m4)
    edges, step = np.linspace(LOWEST, HIGHEST, HEIGHTS + 1, retstep=True)
    s, law, radius = (edges[1:] + edges[:-1]) / 2, Nayak(moments.alpha), moments.radius
    density = np.exp(-s * s / 2) / math.sqrt(2 * math.pi) if model == "one radius" else law.pdf(s)
    root, whole = np.ones_like(s), np.ones_like(s)
    if model == "own radii":
        curvature = RandomCurvature(moments.alpha, 1 / radius)
        root, whole = curvature.mean(0.5, s), curvature.mean(1, s)
    return Summits(
        heights=moments.mean_height + moments.sigma * s,
        weights=moments.eta * density * step,
        root_radius=math.sqrt(radius) * root,
        radius=radius * whole,
        step=moments.sigma * step,
    )


@lru_cache(maxsize=64)
def listed(caps: CapsMap) -> Summits:
    """The caps of a map."""
    heights, ones = np.sort(caps.summits()[1]), np.ones(caps.caps)
    return Summits(heights, ones, math.sqrt(caps.sigma) * ones, caps.sigma * ones)


@dataclass(frozen=True)
class Model:
    """Summits that press each other down, or do not, in a periodic cell.

    Parameters
    ----------
    summits : Summits
        Above the mean plane.
    interaction : {"none", "summits", "contacts"}
        Density n of the places: of all summits, or of loaded spots.
    """

    summits: Summits
    interaction: Interaction = "none"

    def sinking(self, contact: Contact) -> tuple[float, float]:
        """u, and du/dx."""
        if self.interaction == "none" or contact.spots == 0:
            return 0.0, 0.0
        places = contact.spots if self.interaction == "contacts" else self.summits.density
        per_load = SQUARE_LATTICE / math.sqrt(places)
        slope = -per_load * contact.stiffness
        if self.interaction == "contacts":
            slope += per_load * contact.load * contact.spots_slope / (2 * places)
        return per_load * contact.load, slope

    def gap(self, x: float) -> float:
        """Mean gap at which asperities feel a separation."""
        return x + self.sinking(self.summits.at(x))[0]

    def stiffness(self, x: float) -> float:
        """-dp/dh where asperities feel a separation: nan where the mean gap would grow with the load."""
        contact = self.summits.at(x)
        slope = 1 + self.sinking(contact)[1]
        return contact.stiffness / slope if slope > 0 else math.nan

    def load_at(self, h: float) -> float:
        """Load at a mean gap, coming from no load: nan where no separation has that gap."""
        if self.interaction == "none":
            return self.summits.at(h).load
        x = np.linspace(h, 2 * h - float(self.summits.heights[-1]), _STEPS)
        for right, left in pairwise(x.tolist()):
            if self.gap(left) <= h:
                root = brentq(lambda one: self.gap(one) - h, left, right, xtol=1e-14)
                return self.summits.at(float(root)).load
        return math.nan

"""A scene beside those it is measured by: without its grading, with Hertz's law, without interaction."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analytic import Hertz, Homogeneous
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.figures.data import Points, ratio_of_sums
from mcgw.figures.style import contact_label, short
from mcgw.formats.evenly import evenly
from mcgw.scene.law_text import law_text
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene

__all__ = ["SCENE", "Beside", "NoMeaningError", "needs_grading", "needs_pressing", "needs_reference"]

Array = NDArray[np.float64]

SCENE = "this scene"
_SUMS = ("load", "area", "stiffness", "contacts", "conductance")
_MOST_SURFACES, _MOST_ASPERITIES = 1000, 1_000_000_000
_MOST_SEPARATIONS, _FINE, _COARSE = 17, 49, 25  # of lines: radii of their own take long
_ENOUGH = 20  # contacts in the ensemble below which a mean is far from Gaussian


class NoMeaningError(Exception):
    """Why a figure says nothing about a scene."""


@dataclass(frozen=True)
class Beside:
    """A scene and its references, drawn when first asked for.

    Parameters
    ----------
    asked : Scene
        As it was given.
    """

    asked: Scene

    @cached_property
    def scene(self) -> Scene:
        """Pressed once, with the sums that the figures show, at some of its separations."""
        h = np.unique(self.asked.separations)
        cheap = _MOST_ASPERITIES // self.asked.n_asperities
        surfaces = max(min(self.asked.n_surfaces, _MOST_SURFACES, cheap), 1)
        real = promise_of(self.asked.sampler).real_surfaces
        return self.asked.replace(
            separations=h[evenly(len(h), _MOST_SEPARATIONS)],
            quantities=_SUMS,
            unload_from=None,
            film=None,
            tangential=None,
            n_surfaces=surfaces,
            sampler=self.asked.sampler if real else "auto",
            keep="sums",
            rel_err=None,
            max_seconds=None,
        )

    @cached_property
    def references(self) -> dict[str, Scene]:
        """By label, the one that ratios are taken to last; none for a scene that is the simplest itself."""
        found = {}
        if self.scene.interaction is not None:
            found["independent"] = self.scene.replace(interaction=None)
        if self.graded:
            found["homogeneous"] = self.scene.replace(grading=Homogeneous())
        if not self.hertz:
            found["homogeneous, Hertz"] = self.scene.replace(grading=Homogeneous(), law=Hertz())
        return found

    @property
    def graded(self) -> bool:
        """Whether its modulus depends on the height."""
        return not isinstance(self.scene.grading, Homogeneous)

    @property
    def hertz(self) -> bool:
        """Whether its law of contact is Hertz's."""
        return type(self.scene.law) is Hertz

    @cached_property
    def all(self) -> dict[str, Scene]:
        """The scene and its references."""
        return {SCENE: self.scene, **self.references}

    @property
    def reference(self) -> str:
        """Label of what ratios are taken to."""
        return list(self.all)[-1]

    @cached_property
    def h(self) -> Array:
        """Separations of the points."""
        return np.array(self.scene.separations)

    @cached_property
    def line(self) -> Array:
        """Separations of the lines."""
        fine = _FINE if self.scene.curvature is None else _COARSE
        return np.linspace(self.h.min(), self.h.max(), fine) if len(self.h) > 1 else self.h

    @cached_property
    def drawn(self) -> dict[str, Ensemble]:
        """Ensembles of the same seed."""
        return {label: simulate(scene) for label, scene in self.all.items()}

    @cached_property
    def _known(self) -> dict[tuple[str, str, bytes], Array]:
        return {}

    def theory(self, label: str, quantity: str, h: Array) -> Array:
        """Exact means, each computed once: several figures ask for them."""
        key = (label, quantity, h.tobytes())
        if key not in self._known:
            self._known[key] = self.all[label].theory.mean(quantity, h)
        return self._known[key]

    def enough(self, scene: Scene) -> NDArray[np.bool_]:
        """At which of its separations the ensemble has contacts and surfaces enough for an error."""
        h = np.array(scene.separations)
        return (scene.theory.mean("contacts", h) * scene.n_surfaces >= _ENOUGH) & (scene.n_surfaces > 1)

    def means(self, label: str, quantity: str, unit: float) -> Points | None:
        """Means over the surfaces, in this unit."""
        ensemble, known = self.drawn[label], self.enough(self.all[label])
        exact = self.theory(label, quantity, self.h)
        if not known.any():
            return None
        parts = (self.h, ensemble.mean(quantity) / unit, ensemble.stderr(quantity) / unit, exact / unit)
        return Points(*(x[known] for x in parts))

    def quotient(self, above: tuple[Array, Array], below: tuple[Array, Array], exact: Array) -> Points | None:
        """Means of the first, over each other; then over those of the second; values of each surface."""
        known = self.enough(self.scene)
        if not known.any():
            return None
        (a, b), (c, d) = ([x[:, known] for x in pair] for pair in (above, below))
        means = [x.mean(axis=0) for x in (a, b, c, d)]
        value = means[0] / means[1] / (means[2] / means[3])
        influence = sum(s * x / m for s, x, m in zip((1, -1, -1, 1), (a, b, c, d), means, strict=True))
        stderr = np.abs(value) * np.std(influence, axis=0, ddof=1) / np.sqrt(len(a))
        return Points(self.h[known], value, stderr, exact[known])

    def ratio(self, above: Array, below: Array, exact: Array) -> Points | None:
        """Ratios of two means over the same surfaces."""
        known = self.enough(self.scene)
        if not known.any():
            return None
        return Points(self.h[known], *ratio_of_sums(above[:, known], below[:, known]), exact[known])

    @property
    def caption(self) -> str:
        """In words."""
        scene = self.scene
        markers = (
            f"Markers: Monte-Carlo means with 95 % intervals, {scene.n_surfaces} surfaces of "
            f"{scene.n_asperities:g} asperities, seed {scene.seed}, the same for all lines. "
            if scene.n_surfaces > 1
            else ""
        )
        return f"{self.words} {markers}Lines: theory."

    @property
    def words(self) -> str:
        """What the scene is."""
        said, heights = contact_label(self.scene), short(law_text(self.scene.heights))
        if self.scene.interaction is not None:
            felt = "d/σ is nominal" if self.scene.interaction.nominal else "d/σ is what the summits feel"
            said += f", interacting ({felt})"
        return f"This scene: {said}; heights {heights}."


def needs_reference(b: Beside) -> None:
    """Ratios are to another scene."""
    if not b.references:
        raise NoMeaningError("the scene is its own reference (homogeneous, Hertz's law): every ratio is 1")


def needs_grading(b: Beside, what: str) -> None:
    """Some figures are about the modulus alone."""
    if not b.graded:
        raise NoMeaningError(f"the scene has no grading: {what}")


def needs_pressing(b: Beside) -> None:
    """There is no ratio to a pull, nor a logarithm of it."""
    if any(np.any(b.theory(label, "load", b.line) <= 0) for label in b.all):
        raise NoMeaningError("the mean load is not positive at every separation: there is no ratio to it")

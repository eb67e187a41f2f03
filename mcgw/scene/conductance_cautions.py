"""Where a conductance is asked beyond what it assumes: neighbours, films and corrections."""

from collections.abc import Iterator

import numpy as np

from analytic.laws import crowding_factor
from mcgw.scene.scene import Scene

__all__ = ["conductance_cautions"]

_NEIGHBOURS = 0.05  # constriction of neighbours over that of the spots


def conductance_cautions(scene: Scene) -> list[str]:
    """What a reader should know of conductances, a line each."""
    return [line for caution in (_neighbours, _thick_film, _no_answer) for line in caution(scene)]


def _neighbours(scene: Scene) -> Iterator[str]:
    """By the factor of Cooper, Mikic and Yovanovich, where the scene asks for no interaction."""
    h = float(min(scene.separations))
    fraction = float(scene.theory.mean("area_fraction", h))
    if scene.interaction is not None or not 0 < fraction < 1:
        return
    gain = 1 / float(crowding_factor(fraction)) - 1
    if gain > _NEIGHBOURS:
        yield (
            f"conductance is that of the spots alone; at d/sigma = {h:.3g} neighbours change it by about "
            f"{gain:.0%} (Cooper, Mikic and Yovanovich): [interaction] reference counts them"
        )


def _thick_film(scene: Scene) -> Iterator[str]:
    """A film that may not be thin beside its spots; one on a current is nanometres thick."""
    h, theory, film = np.array(min(scene.separations)), scene.theory, scene.film
    contacts = float(theory.mean("contacts", h))
    if film is None or not film.thermal or not film.film_resistance or not contacts > 0:
        return
    radius = float(np.sqrt(theory.mean("area", h) / contacts / np.pi))
    if (thick := film.film_resistance * 2 / film.rho) > radius / 5:
        yield (
            f"contact.film_resistance: as {thick:.2g} m of the bodies resist, and spots have a radius of "
            f"{radius:.2g} m; unless the film is far thinner, give layer = {{thickness, conductivity}}"
        )


def _no_answer(scene: Scene) -> Iterator[str]:
    """Where the correction of the mean plane exceeds what the spots resist."""
    name = "conductance" if scene.film is None else "conductance_si"
    if (other := scene.series(name)) >= 0:
        return
    h, theory = np.unique(scene.separations), scene.theory
    spots = theory.alone.mean(name, theory.effective(h))  # type: ignore[attr-defined]
    if np.any(none := 1 + other * spots <= 0):
        yield (
            f"up to d/sigma = {h[none].max():.3g} {name} is nan: the correction of the mean plane exceeds "
            'what the spots resist; take higher separations, or reference = "body"'
        )

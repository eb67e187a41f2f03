"""What other elastic-plastic laws would give at the same critical penetration."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from analytic import ChangEtsionBogy, ContactLaw, Hertz, JacksonGreen, KogutEtsion, ZhaoMaiettaChang
from analytic.laws.elastic_plastic import ElasticPlastic
from mcgw.scene.scene import Scene

_POISSON = 0.3  # where the law of the scene has none


@dataclass(frozen=True)
class OtherLaws:
    """Means under other laws over those under the law of a scene, at one separation.

    Parameters
    ----------
    separation : float
        The middle one of the scene, d/sigma.
    critical : float
        Penetration over sigma at which asperities of modulus E* yield, the same for all.
    load, area : dict of str to float
        Ratio of the means by the name of the other law, Hertz's too.
    """

    separation: float
    critical: float
    load: dict[str, float]
    area: dict[str, float]

    @property
    def spread(self) -> tuple[float, float]:
        """Least and largest ratio of loads among the laws that yield, this one's being 1."""
        ratios = [1.0, *(ratio for name, ratio in self.load.items() if name != Hertz.name)]
        return min(ratios), max(ratios)


def other_laws(scene: Scene) -> OtherLaws | None:
    """Look at the other laws; None where the scene's asperities do not yield, or nothing touches."""
    law = scene.contact
    if not isinstance(law, ElasticPlastic) or law.critical is None:
        return None
    h = sorted(scene.separations)[len(scene.separations) // 2]
    theory = replace(scene.theory, unload_from=None, film=None)
    means = {
        other.name: [float(replace(theory, law=other).mean(name, h)) for name in ("load", "area")]
        for other in (law, *_alike(scene, law.critical))
    }
    load, area = means.pop(law.name)
    if not (load > 0 and area > 0):
        return None
    return OtherLaws(
        h,
        law.critical,
        {name: mean[0] / load for name, mean in means.items()},
        {name: mean[1] / area for name, mean in means.items()},
    )


def _alike(scene: Scene, critical: float) -> Iterator[ContactLaw]:
    """The other laws that yield at this penetration, and Hertz's."""
    poisson = getattr(scene.law, "poisson", None)
    poisson = _POISSON if poisson is None else poisson
    plain = JacksonGreen(yield_strain=1.0, critical=critical, poisson=poisson)
    strain = 2 * math.sqrt(critical * scene.surface.sigma / scene.surface.radius)
    for law in (
        ChangEtsionBogy(critical=critical),
        ZhaoMaiettaChang(critical=critical),
        KogutEtsion(critical=critical, poisson=poisson),
        replace(plain, yield_strain=strain / (np.pi * plain.yield_factor)),
        Hertz(),
    ):
        if law.name != scene.law.name:
            yield law

"""The figures that the paper lacks."""

from mcgw.figures.data import FigureData
from mcgw.figures.equal_load import equal_load
from mcgw.figures.finite import distribution, fluctuations
from mcgw.figures.histories import films, sliding, way_back
from mcgw.figures.samples import Samples
from mcgw.figures.summits import area_and_load, negative_modulus, who_carries
from mcgw.figures.yielding import laws_compared, who_yields
from mcgw.machine.progress import steps

__all__ = ["FURTHER", "further_figures"]

# Names of their files.
FURTHER = (
    "equal-load",
    "fluctuations",
    "distribution",
    "area-and-load",
    "who-carries",
    "negative-modulus",
    "who-yields",
    "laws-compared",
    "way-back",
    "sliding",
    "films",
)


def further_figures(samples: Samples) -> list[FigureData]:
    """Ratios at equal load, fluctuations, distribution, area against load, who carries, where it ends.

    Then contact laws beyond Hertz's: who yields, the laws side by side, the way back, sliding, films.

    Parameters
    ----------
    samples : Samples
        The surfaces.

    Returns
    -------
    list of FigureData
        In order.
    """
    drawn = (
        equal_load, fluctuations, distribution, area_and_load, who_carries, lambda _: negative_modulus(),
        who_yields, laws_compared, way_back, sliding, films,
    )  # fmt: skip
    return [figure(samples) for figure in steps(drawn, "figures")]

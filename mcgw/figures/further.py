"""The figures that the paper lacks."""

from mcgw.figures.data import FigureData
from mcgw.figures.equal_load import equal_load
from mcgw.figures.finite import distribution, fluctuations
from mcgw.figures.histories import films, sliding, way_back
from mcgw.figures.samples import Samples
from mcgw.figures.summits import area_and_load, negative_modulus, who_carries
from mcgw.figures.yielding import laws_compared, who_yields

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
    return [
        equal_load(samples),
        fluctuations(samples),
        distribution(samples),
        area_and_load(samples),
        who_carries(samples),
        negative_modulus(),
        who_yields(samples),
        laws_compared(samples),
        way_back(samples),
        sliding(samples),
        films(samples),
    ]

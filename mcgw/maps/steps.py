"""Steps of preparing a measured map, one row each, for Python and commands."""

from dataclasses import dataclass
from typing import Literal, get_args

Form = Literal["plane", "none", "quadratic", "cubic", "quartic"]
Missing = Literal["auto", "mask", "fill"]
SpikesTo = Literal["keep", "remove"]
LinesTo = Literal["keep", "rows", "columns"]


@dataclass(frozen=True)
class Step:
    """A step that is asked for by a word or by a length.

    Parameters
    ----------
    name : str
        Its keyword.
    words : str
        What it does.
    kinds : tuple of str, optional
        Words that ask for it, the default first; none: a length.
    """

    name: str
    words: str
    kinds: tuple[str, ...] = ()


STEPS = (
    Step(
        "cutoff", "shortest wavelength of the roughness, such as 5um (Gaussian filter, ISO 16610-61); or none"
    ),
    Step("long_cutoff", "longest wavelength of the roughness, such as 80um; default: no limit"),
    Step("form", "form to remove", get_args(Form)),
    Step(
        "missing",
        "missing points are filled from the edges of their holes; mask: ignore them and their neighbours; "
        "fill: use them; auto: mask if half of the other points remain",
        get_args(Missing),
    ),
    Step("spikes", "remove points that stand out", get_args(SpikesTo)),
    Step("lines", "remove offsets between rows or columns, as from a line scan", get_args(LinesTo)),
)

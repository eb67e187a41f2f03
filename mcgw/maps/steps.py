"""What may be done to a measured map before it is looked at: a row a step, for Python and commands."""

from dataclasses import dataclass
from typing import Literal, get_args

Form = Literal["plane", "none", "quadratic", "cubic", "quartic", "sphere", "cylinder"]
Missing = Literal["auto", "mask", "fill"]
SpikesTo = Literal["keep", "remove"]
StepTo = Literal["keep", "crop"]
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
    Step("cutoff", "shortest wavelength that counts, as 5um (Gaussian filter, ISO 16610-61); or none"),
    Step("long_cutoff", "longest wavelength that counts, as 80um; default: all do"),
    Step("form", "what is taken off", get_args(Form)),
    Step(
        "missing",
        "missing points are filled from the edges of their holes; mask: they and their neighbours do not "
        "count, fill: they do; auto: mask, while half of the others are left",
        get_args(Missing),
    ),
    Step("spikes", "whether points that stand out become missing", get_args(SpikesTo)),
    Step("step", "whether of two terraces only the larger is kept", get_args(StepTo)),
    Step("lines", "take off offsets between rows or columns, as of a scan line by line", get_args(LinesTo)),
)

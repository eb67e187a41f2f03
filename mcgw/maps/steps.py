"""Words for the steps of preparing a map, as `mcgw.fit` and the command take them; defaults first."""

from typing import Literal

Form = Literal["plane", "none", "quadratic", "cubic", "quartic"]
Missing = Literal["auto", "mask", "fill"]
SpikesTo = Literal["keep", "remove"]
LinesTo = Literal["keep", "rows", "columns"]

"""The values of a scene: as given in Python, and as stored.

Those that no other place makes, as all of ``[ensemble]``, stand here with their rows as keys: signature,
docstring, reader, checks, writer, schema, page and ``--set`` follow.
"""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import InitVar, dataclass, field, fields
from inspect import formatannotation
from textwrap import fill, indent
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeVar, dataclass_transform

from numpy.typing import ArrayLike

from analytic import (
    LAW_QUANTITIES,
    QUANTITIES,
    UNLOADING,
    Grading,
    HeightLaw,
    MeasuredRadii,
    RandomCurvature,
    Surface,
)
from analytic.laws import ContactLaw, Film, Layer
from mcgw.scene.kinds import ByName, Either, List, Number, Table, Whole, Word
from mcgw.scene.promises import SAMPLERS
from mcgw.scene.section import Key, Kind
from mcgw.scene.uncertainty import Uncertainty
from mcgw.validity.fitted_map import Fitted

if TYPE_CHECKING:
    from numpy.random import Generator, SeedSequence

    from analytic import Interaction, Joint
    from mcgw.scene.radii import Spectral

    _Given = TypeVar("_Given", contravariant=True)
    _Held = TypeVar("_Held", covariant=True)

    class As(Generic[_Given, _Held]):
        """A value that may be given in another form than a scene stores."""

        def __get__(self, scene: object, kind: Any) -> _Held: ...
        def __set__(self, scene: object, value: _Given) -> None: ...

else:

    class As:
        """At run time what may be given, which is what a signature shows."""

        def __class_getitem__(cls, types):
            return types[0]


EXACT = 1e-13  # relative error of a value that is right to the last digits
MOMENTS, SUMMITS = ("m0", "m2", "m4"), ("sigma", "radius", "eta")  # either describes the summits of a surface
SUMS = tuple({**QUANTITIES, **LAW_QUANTITIES})

POISSON = Number(low=-1.0, high=0.5)
_ANY = Number(low=-math.inf)
_KNOWN_TO = "give a number > 0 and at most 0.1; beyond that there are too few contacts for an interval"
_SHARE = Number("1", high=0.1, advice=_KNOWN_TO)
_SHARES = List(
    Number("1", high=0.1, infinite=True),
    advice=f"{_KNOWN_TO}, for each separation; or inf, for no requirement",
)
_KNOWN = 'give relative standard errors, such as {sigma = "20 %", radius = "15 %"}'
_ERROR = Number("1", high=2.0, advice=_KNOWN)
_ROWS = List(List(Number(low=-1.0, high=1.0)), advice="give rows of numbers from -1 to 1")
_ERRORS = Table(
    (
        *(Key(name, _ERROR) for name in SUMMITS),
        *(Key(name, _ERROR, excludes=SUMMITS) for name in MOMENTS),
        Key("E_star", _ERROR),
        Key("correlation", _ROWS),
    ),
    _KNOWN,
    Uncertainty,
)
_Class = TypeVar("_Class")


def key(
    table: str, kind: Kind, example: str, words: str, default: Any = None, python: str = "", **others: Any
) -> Any:
    """A value with its row in a table of keys; `python` are its words in a docstring, where others do."""
    row = {"kind": kind, "example": example, "words": words, "default": default, **others}
    given = None if isinstance(default, list) else default
    return field(default=given, metadata={"table": table, "row": row, "python": python or words})


def object_or(default: Any = None) -> Any:
    """A value made elsewhere, from several keys or an object."""
    return field(default=default)


@dataclass_transform(kw_only_default=True, field_specifiers=(key, object_or, field))
def values_of_scene(kind: type[_Class]) -> type[_Class]:
    """The dataclass of a scene: frozen, its arguments but the surface by name."""
    return dataclass(frozen=True, repr=False, kw_only=True)(kind)


@values_of_scene
class Values:
    """What `mcgw.Scene` takes and holds; checked there."""

    surface: As["Surface | Spectral", Surface] = field(kw_only=False)
    separations: As["ArrayLike", tuple[float, ...]]
    datum: InitVar[Literal["summits", "surface"] | None] = None
    title: str = ""
    grading: As[Grading | Callable[[Any], Any] | None, Grading] = object_or()
    negative: Literal["error", "clip", "allow"] = "error"
    heights: As[Any, HeightLaw] = object_or()
    curvature: As[
        RandomCurvature | MeasuredRadii | Literal["random", "mean"] | None,
        RandomCurvature | MeasuredRadii | None,
    ] = object_or()
    law: As[ContactLaw | dict[str, Any] | None, ContactLaw] = object_or()
    unload_from: As[float | Literal["loop"] | None, float | None] = object_or()
    film: Film | None = None
    layer: InitVar[Layer | None] = None
    interaction: As["Interaction | str | dict[str, Any] | None", "Interaction | None"] = object_or()
    joint: As["Joint | str | dict[str, Any] | None", "Joint | None"] = object_or()
    quantities: As[Sequence[str] | None, tuple[str, ...]] = object_or()
    hardness: As[float | str | None, float | None] = key(
        "contact",
        Number("Pa"),
        '"1.2 GPa"',
        "hardness of the softer body, Pa, for elastic-plastic laws; under an elastic law it only tells "
        "whether contacts yield",
        python="Hardness of the softer body, Pa, beside an elastic law: only to tell whether contacts yield",
    )
    poisson: float | None = key(
        "contact",
        POISSON,
        "0.3",
        "Poisson's ratio of the body that yields or coats",
        python="Poisson's ratio of that body, with `hardness`; default: 0.3",
    )
    fitted: As[Fitted | dict[str, Any] | None, Fitted | None] = object_or()
    # fmt: off
    n_surfaces: As[int | None, int] = key("ensemble", Whole(1), "10", "number of surfaces, default 1000",
        python="Number of surfaces M, default: 1000; with `rel_err` the maximum number, default: "
        "1e9", excludes=("rel_err",))
    n_asperities: As[int | None, int] = key("ensemble", Whole(1), "100",
        "asperities per surface, or their mean number if `count` is `poisson`; default: η A_n, rounded")
    count: Literal["fixed", "poisson"] = key("ensemble", Word(("fixed", "poisson")), '"poisson"',
        "`fixed` number on each surface (default), or `poisson`: a window on an unbounded surface", "fixed")
    seed: As["int | Generator | SeedSequence | None", int] = key("ensemble",
        Whole(0, 2**64 - 1, "give a whole number from 0 to 2^64 - 1"), "1",
        "seed of the random numbers, 0 to 2^64 - 1; default: a random one, which is recorded")
    sampler: str = key("ensemble", Word(SAMPLERS), '"cells"',
        "how surfaces are drawn: `auto` (default) uses the fastest exact one of `cells`, `tail`, `direct`; "
        "or `aggregate` ([how they differ](../how-to/speed-and-accuracy.md))", "auto")
    keep: Literal["sums", "statistics"] = key("ensemble",
        Word(("sums", "statistics")), '"statistics"',
        "`sums` (default); `statistics`: [no surfaces](../how-to/speed-and-accuracy.md), only mean, "
        "deviation and covariance, of any number of surfaces in the same memory", "sums")
    rel_err: As["float | str | Mapping[str, Any] | None", float | Mapping[str, float | list[float]] | None
    ] = key("ensemble",
        Either((ByName(Either((_SHARES, _SHARE), _KNOWN_TO), "", (*SUMS, *UNLOADING)), _SHARE), _KNOWN_TO),
        "0.01",
        "instead of `n_surfaces`: draw until the half width of the 95 % interval of every mean, relative to "
        "it, is at most this; or a table by quantity, "
        "`{load = 1e-3, contacts = [1e-2, 1e-2, inf]}`, with one "
        "number or one for each separation")
    max_seconds: As[float | str | None, float | None] = key("ensemble", Number("s"), "1.0",
        "time limit, s; the block being drawn is completed")
    accuracy: float = key("ensemble",
        Number("1", high=0.1, zero=True, advice="give a number from 0, exact, to 0.1"), "0.0",
        "how far the law of each value may be from the exact one, as the largest difference of distribution "
        "functions, 0 (default: exact) to 0.1: `auto` may then use `aggregate` for crowded cells, whose time "
        "does not grow with the number of asperities", 0.0)
    uncertainty: As["Uncertainty | dict[str, Any] | None", Uncertainty | None] = key("surface", _ERRORS,
        '{sigma = "20 %", radius = "15 %", eta = "12 %"}',
        "standard errors of `sigma`, `radius`, `eta` (or of `m0`, `m2`, `m4`) and `E_star`, relative to the "
        "values, with their `correlation` in this order, if any; `mcgw fit` writes them, and `mcgw solve` "
        "includes them in its error")
    # fmt: on


def rows_of(table: str) -> tuple[Key, ...]:
    """Keys of a table that are values themselves."""
    known = fields(Values)
    return tuple(Key(x.name, **x.metadata["row"]) for x in known if x.metadata.get("table") == table)


def documented(kind: type[_Class]) -> type[_Class]:
    """Complete a class of values: its docstring also describes those with a row."""
    said, known = [""], vars(kind)["__dataclass_fields__"]
    for name, one in list(known.items()):
        given = one.type if isinstance(one.type, str) else formatannotation(one.type)
        if isinstance(one.type, InitVar):  # a scene has no value for these
            del known[name]
            delattr(Values, name)
        elif "row" in one.metadata:
            of, words = one.metadata["row"]["kind"], one.metadata["python"]
            given = given.replace(" | None", "").replace(" | ", " or ").replace("ArrayLike", "array_like")
            given = "{" + ", ".join(f'"{word}"' for word in of.known) + "}" if isinstance(of, Word) else given
            words = re.sub(r"\[([^]]+)\]\([^)]+\)", r"\1", f"{words[0].upper()}{words[1:]}.")  # no links
            words = words.replace("`", "``")
            said += [f"    {name} : {given}, optional", indent(fill(words, 102), " " * 8)]
    kind.__doc__ = (kind.__doc__ or "").replace("\n\n    Raises", "\n".join(said) + "\n\n    Raises", 1)
    return kind

"""The parts of a scene that it is made of: contacts, moduli, joint and sampling.

A field is a row of the table of keys of its part, whose words are those of the docstring: reader, checks,
writer, schema, page and ``--set`` follow. A scene checks the values of its parts, so that all mistakes are
listed at once.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import analytic
from analytic.joint import GASES, Gas
from analytic.laws import ContactLaw, Film, Layer
from mcgw.scene.kinds import Either, List, Number, Table, Word, whole
from mcgw.scene.section import Key, Kind

if TYPE_CHECKING:
    from numpy.random import Generator, SeedSequence

SUMS = tuple({**analytic.QUANTITIES, **analytic.LAW_QUANTITIES})
_ANY = Number(low=-math.inf)
EXACT = 1e-13  # relative error of a value that is right to the last digits

# --- samplers ---


@dataclass(frozen=True)
class Promise:
    """What others may rely on, whichever sampler it is."""

    # It draws single asperities, each with a radius of its own where summits have them, by the exact laws;
    # else sums of crowds, which are a little off: ``auto`` takes it where a scene allows that.
    one_by_one: bool = True
    own_laws: bool = False  # it adds up summit by summit: each can have breaks of its own in the contact law
    needs_density: bool = False  # it draws from that of the heights, which a list of measured ones has not
    not_done: tuple[str, ...] = ()  # what it spares, for people; {spared}: asperities that do not touch


_UNTOUCHED = "{spared:.4g} asperities per surface lie below every separation and are not drawn"
_CROWDED = "in crowded cells, Gaussian moments are drawn instead of asperities"

_PROMISES = {
    "direct": Promise(own_laws=True),
    "tail": Promise(own_laws=True, needs_density=True, not_done=(_UNTOUCHED,)),
    "cells": Promise(needs_density=True, not_done=(_UNTOUCHED,)),
    "aggregate": Promise(one_by_one=False, needs_density=True, not_done=(_UNTOUCHED, _CROWDED)),
}
SAMPLERS = ("auto", *_PROMISES)


def promise_of(sampler: str) -> Promise:
    """Return what a sampler promises; ``auto`` takes one that promises all."""
    return _PROMISES.get(sampler, Promise(own_laws=True))


# --- kinds of values ---

_KNOWN_TO = "give a number > 0 and at most 0.1; beyond that there are too few contacts for an interval"
_SHARE = Number("1", high=0.1, advice=_KNOWN_TO)
_SHARES = List(
    Number("1", high=0.1, infinite=True),
    advice=f"{_KNOWN_TO}, for each separation; or inf, for no requirement",
)
_BY_NAME = Table(item=Either((_SHARES, _SHARE), _KNOWN_TO), names=(*SUMS, *analytic.UNLOADING))
_REL_ERR = Either((_BY_NAME, _SHARE), _KNOWN_TO)
_ACCURACY = Number("1", high=0.1, zero=True, advice="give a number from 0, exact, to 0.1")
_NAMES = List(
    Word((*SUMS, *analytic.UNLOADING), f"choose one of {', '.join(SUMS)}"),
    once=True,
    advice="give a list of names, each once",
)
_BACK = 'give a number d/sigma, or "loop"'
_CONDUCTIVITY = Key("conductivity", Number("W/(m K)"), required=True)
_PAIR = List(Number("W/(m K)"), 2, 2, "give two numbers > 0 in W/(m K), such as [150.0, 16.0]")
_FILM = Number(zero=True, advice="give a finite number >= 0, in ohm m^2 or m^2 K/W")
_LAYER = Table(
    (Key("thickness", Number("m"), required=True), _CONDUCTIVITY),
    'give {thickness = "10 um", conductivity = 1.3} (m, W/(m K))',
    Layer,
)
_FILLINGS = (*GASES, "vacuum")
_GAS = f'give one of {", ".join(_FILLINGS)}, or {{conductivity = 0.15, jump = "1 um"}} (W/(m K), m)'
_GASES = Either(
    (
        Table((_CONDUCTIVITY, Key("jump", Number("m"), required=True)), _GAS, Gas),
        Word(_FILLINGS, _GAS),
    ),
    _GAS,
)


_SEED = whole(0, 2**64 - 1, "give a whole number from 0 to 2^64 - 1")


def key(kind: Kind, example: str = "", default: Any = None, **others: Any) -> Any:
    """Return a field with its row in the table of its part."""
    row = {"kind": kind, "example": example, "default": default, **others}
    return field(metadata=row) if others.get("required") else field(default=default, metadata=row)


def rows_of(part: type) -> tuple[Key, ...]:
    """Return the rows of a part: its fields that are keys of a table."""
    return tuple(Key(each.name, **each.metadata) for each in fields(part) if each.metadata)


# --- the parts ---


@dataclass(frozen=True)
class Graded:
    """Moduli against height, with what happens where they are negative.

    Parameters
    ----------
    law : Grading or callable
        As `mcgw.Scene` takes it alone.
    negative : {"error", "clip", "allow"}, optional
        What to do if it makes the modulus of a contacting asperity negative: refuse the scene, set the
        modulus to zero, or take it as it is.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1 um", "10 um", "300/mm^2", "1 cm^2", "80 GPa")
    >>> softer = mcgw.Graded(mcgw.Exponential(-0.5), negative="clip")
    >>> mcgw.Scene(surface, separations=0.0, grading=softer).negative
    'clip'
    """

    law: analytic.Grading | Callable[[Any], Any] | None
    negative: Literal["error", "clip", "allow"] = "error"


@dataclass(frozen=True)
class Contact:
    """Contacts of asperities: their law, what is computed of them, and whether they are unloaded.

    Parameters
    ----------
    law : ContactLaw, str or dict, optional
        Contact law of an asperity, such as `mcgw.KogutEtsion(hardness=1.2e9)`; or its keys in a scene
        file, ``{"name": "kogut-etsion", "hardness": "1.2 GPa"}``. Default: Hertz's.
    quantities : sequence of str, optional
        Quantities to compute: any of "load", "area", "stiffness", "contacts" (these four by default),
        "conductance", "spot_conductance", "yielded", "load_slope".
    unload_from : float or "loop", optional
        Smallest separation reached before unloading, d/sigma; "loop": the smallest of the scene. Every
        quantity then also has an unloading branch, such as ``load_unloading``.
    datum : {"summits", "surface"}, optional
        Mean plane from which separations are measured, by default that of the summits; that of the surface
        needs Nayak's heights, and a scene converts them.
    hardness : float or str, optional
        Hardness of the softer body, Pa, beside an elastic law: only to tell whether contacts yield.
    poisson : float, optional
        Poisson's ratio of that body. Default: 0.3.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
    >>> contact = mcgw.Contact(mcgw.KogutEtsion(hardness=1.2e9), quantities=["load", "yielded"])
    >>> mcgw.Scene(surface, separations=[0, 2], contact=contact).law.name
    'kogut-etsion'
    """

    law: ContactLaw | str | Mapping[str, Any] | None = None
    quantities: Sequence[str] | None = key(_NAMES, '["load"]')
    unload_from: float | Literal["loop"] | None = key(Either((Word(("loop",), _BACK), _ANY), _BACK), "-0.5")
    datum: Literal["summits", "surface"] | None = key(Word(("summits", "surface")), '"surface"')
    hardness: float | str | None = None
    poisson: float | None = None


@dataclass(frozen=True)
class Joint:
    """Conduction through a joint: the bodies, a film or layer on their contacts, and gas beside them.

    Parameters
    ----------
    conductivities : (float, float), optional
        Thermal conductivities of both bodies, W/(m K). Adds the quantity "conductance_si".
    resistivity : float or str, optional
        Sum of the two bodies' electrical resistivities, ohm m, instead of conductivities.
    film_resistance : float, optional
        Resistance of a unit area of a film much thinner than spots are wide, ohm m^2 or m^2 K/W.
    layer : Layer or dict, optional
        Layer of any thickness on the first body (m, W/(m K)): `mcgw.Layer`.
    gas : str, Gas or dict, optional
        Gas in the gap: "air", "argon", "helium", "hydrogen", "nitrogen", "vacuum", or its
        conductivity, W/(m K), and temperature-jump distance, m: ``{"conductivity": 0.15, "jump": "1 um"}``.
        Adds "gap_conductance" and "joint_conductance", W/(m^2 K). Default: spots only, as in vacuum.
    rms : float or str, optional
        Root mean square height of the surface (both combined, not of the summits), m; not needed with
        Nayak's heights or the `fitted` of a scene.
    temperature : float or str, optional
        Temperature of a gas by name, K. Default: 293.15 K.
    gas_pressure : float or str, optional
        Pressure of a gas by name, Pa. Default: 101325 Pa.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
    >>> joint = mcgw.Joint((150.0, 16.0), gas="air", rms="2 um")
    >>> mcgw.Scene(surface, separations=[0, 2], joint=joint).answers[-2:]
    ('gap_conductance', 'joint_conductance')
    """

    conductivities: Sequence[float] | None = key(_PAIR, "[150.0, 16.0]")
    resistivity: float | str | None = key(Number("ohm m"), "1e-7", excludes=("conductivities",))
    film_resistance: float | None = key(_FILM, "1e-12", needs=("resistivity", "conductivities"))
    layer: Layer | Mapping[str, Any] | None = key(
        _LAYER, '{thickness = "10 um", conductivity = 1.3}', needs=("conductivities",)
    )
    gas: str | Gas | Mapping[str, Any] | None = key(_GASES, '"air"', needs=("conductivities",))
    rms: float | str | None = key(Number("m"), '"2 um"', needs=("gas",))
    temperature: float | str | None = key(Number("K"), '"20 degC"', needs=("gas",))
    gas_pressure: float | str | None = key(Number("Pa"), "101325.0", needs=("gas",))

    @cached_property
    def film(self) -> Film | None:
        """What spots conduct through; None without bodies."""
        known = {"conductivities", "resistivity", "film_resistance", "layer"}
        given = {name: getattr(self, name) for name in known if getattr(self, name) is not None}
        return Film(**given) if given else None

    @property
    def without_gas(self) -> "Joint":
        """The same, of spots only."""
        return replace(self, gas=None, rms=None, temperature=None, gas_pressure=None)

    @cached_property
    def filling(self) -> "analytic.Joint | None":
        """What conducts beside the spots; None where nobody says."""
        if self.gas is None:
            return None
        numbers: Any = self.rms, self.temperature, self.gas_pressure  # texts became numbers when it was made
        return analytic.Joint(self.gas, *numbers)


@dataclass(frozen=True)
class Sampling:
    """How many surfaces there are, of how many asperities, and how they are drawn.

    Parameters
    ----------
    n_surfaces : int, optional
        Number of surfaces M. Default: 1000; with `rel_err` the maximum number, by default 1e9.
    n_asperities : int, optional
        Asperities per surface, or their mean number if `count` is "poisson". Default: eta A_n, rounded.
    count : {"fixed", "poisson"}, optional
        "fixed" number on each surface (default), or "poisson": a window on an unbounded surface.
    seed : int, Generator or SeedSequence, optional
        Seed of the random numbers, 0 to 2^64 - 1. Default: a random one, which is recorded.
    sampler : {"auto", "direct", "tail", "cells", "aggregate"}, optional
        How surfaces are drawn; "auto" (default) uses the fastest exact way of "cells", "tail", "direct".
    keep : {"sums", "statistics"}, optional
        "sums" (default); "statistics": no surfaces, only mean, deviation and covariance, of any number of
        surfaces in the same memory.
    rel_err : float, str or dict, optional
        Draw until the half width of the 95 % interval of every mean, relative to it, is at most this; or a
        table by quantity, with one number or one for each separation.
    max_seconds : float or str, optional
        Time limit, s; the block being drawn is completed.
    accuracy : float, optional
        How far the law of each value may be from the exact one, as the largest difference of distribution
        functions, 0 (default: exact) to 0.1: "auto" may then use "aggregate" for crowded cells, whose time
        does not grow with the number of asperities.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
    >>> sampling = mcgw.Sampling(50, count="poisson", sampler="tail")
    >>> mcgw.Scene(surface, separations=[0, 2], ensemble=sampling, seed=1).count
    'poisson'
    """

    n_surfaces: int | None = key(whole(1), "10")
    n_asperities: int | None = key(whole(1), "100")
    count: Literal["fixed", "poisson"] = key(Word(("fixed", "poisson")), '"poisson"', "fixed")
    seed: "int | Generator | SeedSequence | None" = key(_SEED, "1")
    sampler: str = key(Word(SAMPLERS), '"cells"', "auto")
    keep: Literal["sums", "statistics"] = key(Word(("sums", "statistics")), '"statistics"', "sums")
    rel_err: float | str | Mapping[str, Any] | None = key(_REL_ERR, "0.01")
    max_seconds: float | str | None = key(Number("s"), "1.0")
    accuracy: float = key(_ACCURACY, "0.0", 0.0)

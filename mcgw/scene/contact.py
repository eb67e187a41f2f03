"""Contacts of asperities and conduction through their joint: parts of a scene, and what is wrong there."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

import analytic
from analytic.joint import GASES, Gas
from analytic.laws import ContactLaw, Film, Layer
from mcgw.scene.kinds import Either, List, Number, Table, Word
from mcgw.scene.section import Key, key

SUMS = tuple({**analytic.QUANTITIES, **analytic.LAW_QUANTITIES})
_LEAST = 1e-100  # next to it, powers of a distance are beyond double precision
_STEEP = ("stiffness", "load_slope")

_NAMES = List(
    Word((*SUMS, *analytic.UNLOADING), f"choose one of {', '.join(SUMS)}"),
    once=True,
    advice="give a list of names, each once",
)
_BACK = 'give a number d/sigma, or "loop"'
_FROM = Either((Word(("loop",), _BACK), Number(low=-math.inf)), _BACK)
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
_OTHER_GAS = Table((_CONDUCTIVITY, Key("jump", Number("m"), required=True)), _GAS, Gas)
_GASES = Either((_OTHER_GAS, Word(_FILLINGS, _GAS)), _GAS)


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
    unload_from: float | Literal["loop"] | None = key(_FROM, "-0.5")
    datum: Literal["summits", "surface"] | None = key(Word(("summits", "surface")), '"surface"')
    hardness: float | str | None = None
    poisson: float | None = None

    def mistakes(self, scene: Any) -> Iterator[str]:
        """Quantities that its law or joint has not, and a history that no surface has."""
        names, law, back, at = scene.quantities, scene.law, scene.unload_from, "contact.quantities"
        if "conductance_si" in names and scene.film is None:
            yield f'{at}: "conductance_si" needs joint.resistivity, or joint.conductivities = [k1, k2]'
        if tiny := [h for h in scene.separations if 0 < abs(h) < _LEAST]:
            yield f"contact.separations: {tiny[0]:g} is too close to 0; give 0, or at least {_LEAST:g}"
        if law.elastic and "yielded" in names:
            yield f'{at}: "yielded": no contact yields with law = "{law.name}"; leave it out'
        if back is None:
            for name in (name for name in names if name in analytic.UNLOADING):
                yield f"{at}: {name!r} needs unloading; give unload_from too"
            return
        if back > min(scene.separations):
            yield (
                f"contact.unload_from = {back:g}: the separation {scene.lowest:g} is smaller; "
                'give the smallest that was reached, or "loop"'
            )
        try:
            scene.reduced_law.unloading(0.0)
        except ValueError as error:
            yield f"contact.unload_from = {back:g}: {error}"
            return
        if not law.stiff and (stiff := [name for name in _STEEP if name in names]):
            rest = [name for name in names if name not in (*_STEEP, *analytic.UNLOADING)]
            listed = str(rest or ["load"]).replace("'", '"')
            yield (
                f'{at}: {stiff[0]!r} has no variance if contacts break off (law = "{law.name}"); '
                f"give {listed}, or leave out unload_from"
            )


def law_mistakes(scene: Any) -> Iterator[str]:
    """Find a law that means nothing for this surface."""
    at = f'contact.law = "{scene.law.name}"'
    try:
        with np.errstate(all="ignore"):
            limits = scene.reduced_law.limits(np.ones(1))
    except ValueError as error:
        yield f"{at}: {error}"
        return
    if not np.all(np.isfinite(limits)) or np.any(limits <= 0):
        yield f"{at}: yields at {limits.flat[0]:.3g} sigma; check its constants"
    if scene.negative == "allow":
        yield f'grading.negative = "allow": {at} needs a modulus >= 0; use "clip"'


def interaction_mistakes(scene: Any) -> Iterator[str]:
    """Asperities that press each other down where that finds no balance."""
    if "load" not in scene.quantities:
        yield 'interaction: separations depend on the load; add "load" to contact.quantities'
        return
    h = np.unique(scene.separations)
    try:
        sinking = 1 + scene.theory.compliance * scene.alone.slope("load", h) <= 0
    except ValueError as error:
        yield str(error)
        return
    if np.any(sinking):
        yield (
            f"interaction: at d/sigma = {h[sinking].max():g} the mean plane sinks faster than it is pressed, "
            "so the nominal separation is not unique; give larger separations"
        )


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

    @cached_property
    def filling(self) -> "analytic.Joint | None":
        """What conducts beside the spots; None where nobody says."""
        if self.gas is None:
            return None
        numbers: Any = self.rms, self.temperature, self.gas_pressure  # texts became numbers when it was made
        return analytic.Joint(self.gas, *numbers)

    def mistakes(self, scene: Any) -> Iterator[str]:
        """Gas of which too much is told, or that nobody knows the gap of."""
        try:
            _ = scene.filled
        except ValueError as error:
            yield f"joint.{error}"

"""Two rough bodies in contact as one rough surface on a rigid plane; in files, `[surface] bodies`."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from analytic import Nayak, SpectralMoments
from mcgw.formats.named_files import loads, read_bytes
from mcgw.scene.keys import YOUNG
from mcgw.scene.measured import MOMENTS, SUMMITS
from mcgw.scene.section import SceneError

_MOST_BYTES = 2**21
_FOLLOW = (*SUMMITS, "E_star", *MOMENTS)  # keys of [surface] that two files determine
# Keys of [joint] and [contact.law] beside which those of the files do not count.
_CONDUCTION = {"resistivity", "conductivities"}
_YIELD = {"hardness", "critical", "yield_strength", "yield_strain"}
Tables = Mapping[str, Any]


@dataclass(frozen=True)
class RoughBody:
    """One of two rough bodies, or both as one; None or empty: unknown."""

    moments: SpectralMoments
    E_star: float | None = None  # composite modulus of this body alone on a rigid plane, E/(1 - nu^2), Pa
    hardness: float | None = None  # Pa
    conductivities: tuple[float, ...] = ()  # thermal, of the body, or of both of a pair, W/(m K)

    def beside(self, other: "RoughBody") -> "RoughBody":
        """Return both as one on a rigid plane: the gap between two independent isotropic Gaussian surfaces.

        Its hardness is that of the softer body. What is not known of both is unknown.
        """
        a, b = self.moments, other.moments
        moduli, hardness = (self.E_star, other.E_star), (self.hardness, other.hardness)
        known = self.conductivities and other.conductivities
        return RoughBody(
            SpectralMoments(a.m0 + b.m0, a.m2 + b.m2, a.m4 + b.m4),
            None if None in moduli else 1 / sum(1 / E for E in moduli if E),
            None if None in hardness else min(x for x in hardness if x),
            self.conductivities + other.conductivities if known else (),
        )


def with_bodies(document: Tables, folder: Path, read: Callable[[Tables, Path], Tables]) -> Tables:
    """Put the surface of two bodies into the tables of a scene in place of the files that describe them.

    Their hardness and conductivities go under ``[contact.law]`` and ``[joint]``, where both files give them
    and the scene does not; `read` gives the values of a scene by its tables and folder. Raises SceneError if
    a file cannot be read, does not describe one rough body, or a key contradicts the files.
    """
    if not (named := files_of_bodies(document)):
        return document
    surface, bodies = document["surface"], document["surface"]["bodies"]
    if len(named) != 2 or bodies != [{"file": name} for name in named]:
        raise SceneError([f"surface.bodies = {bodies}: give {{file = ...}} of both, or E and nu of both"])
    if beside := [key for key in _FOLLOW if key in surface]:
        raise SceneError([f"surface.{beside[0]}: follows from the files of both bodies; leave it out"])
    a, b = (_body(folder / name, read) for name in named)
    pair, found = a.beside(b), dict(document)
    total = pair.moments
    known = {key: value for key, value in surface.items() if key != "bodies"}
    found["surface"] = known | {"m0": total.m0, "m2": total.m2, "m4": total.m4, "E_star": pair.E_star}
    contact, joint = document.get("contact", {}), document.get("joint", {})
    law = contact.get("law", {}) if isinstance(contact, Mapping) else None
    if isinstance(joint, Mapping) and not _CONDUCTION & set(joint) and pair.conductivities:
        found["joint"] = {**joint, "conductivities": list(pair.conductivities)}
    if isinstance(law, Mapping) and not _YIELD & set(law) and pair.hardness:
        found["contact"] = {**contact, "law": {**law, "hardness": pair.hardness}}
    return found


def files_of_bodies(document: Tables) -> list[str]:
    """Return the files that `[surface] bodies` of a scene names, as they are written."""
    surface = document.get("surface")
    bodies = surface.get("bodies") if isinstance(surface, Mapping) else None
    tables = [each for each in bodies if isinstance(each, Mapping)] if isinstance(bodies, list) else []
    return [str(body["file"]) for body in tables if "file" in body]


def _body(path: Path, read: Callable[[Tables, Path], Tables]) -> RoughBody:
    """Read the scene of one body on a rigid plane."""
    try:
        document = loads(read_bytes(path, _MOST_BYTES).decode())
        if files_of_bodies(document):
            raise ValueError("names the files of two bodies itself; give one body")
        values = read(document, path.parent)
        bodies = document["surface"].get("bodies")
        if bodies and not any(YOUNG.value(body["E"]) == math.inf for body in bodies):
            raise ValueError(
                "surface.bodies: two elastic bodies; a file describes one on a rigid plane, {E = inf}"
            )
        return body_of(SimpleNamespace(**values))
    except SceneError as error:
        raise SceneError([f"surface.bodies: {path}: {line}" for line in error.problems]) from None
    except ValueError as error:
        raise SceneError([f"surface.bodies: {path}: {str(error).removeprefix(f'{path}: ')}"]) from None


def moments_of(scene: Any) -> SpectralMoments:
    """Return the moments of the fitted map of a scene, or of Nayak's heights; ValueError without either."""
    if scene.fitted is not None:
        return scene.fitted.moments  # type: ignore[no-any-return]
    if isinstance(scene.heights, Nayak):
        from mcgw.validity.lookup import moments_of_nayak  # few have two bodies

        return moments_of_nayak(scene.surface, scene.heights.alpha)
    raise ValueError("has no spectrum; give m0, m2, m4 under [surface], or a scene written by mcgw fit")


def body_of(scene: Any) -> RoughBody:
    """Return the body of a scene on a rigid plane; errors as of `moments_of`, or if it conducts as a pair."""
    pair = scene.joint.conductivities or ()
    if len(set(pair)) > 1:
        raise ValueError(
            f"joint.conductivities = {list(pair)}: those of a pair; a body has equal ones, as [150.0, 150.0]"
        )
    hardness = scene.contact.hardness or getattr(scene.contact.law, "hardness", None)
    return RoughBody(moments_of(scene), scene.surface.E_star, hardness, tuple(pair[:1]))

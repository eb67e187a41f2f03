"""What stands above a table: where it comes from, its units, and where its gap is zero."""

from importlib.metadata import PackageNotFoundError, version

from analytic import Nayak
from mcgw.ensemble.ensemble import Ensemble
from mcgw.exports.curves import Curve
from mcgw.exports.kinds import Kind
from mcgw.exports.unit_systems import UnitSystem
from mcgw.formats.sheet import brief
from mcgw.scene.scene import Scene

__all__ = ["heading"]


def heading(ensemble: Ensemble, kind: Kind, curve: Curve, system: UnitSystem, digest: str) -> list[str]:
    """Lines of plain ASCII text, without the mark of a comment."""
    scene = ensemble.scene
    over = f"{ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, seed {scene.seed}"
    value, argument = (
        getattr(system, kind.quantity),
        system.length if kind.against == "gap" else system.pressure,
    )
    what = kind.quantity if kind.quantity == "pressure" else f"{kind.quantity} per nominal area"
    return [
        f"{kind.name}, {_curve(curve.name)} over {over}, at equal {kind.against}",
        f"scene: {brief(scene.title) or 'without a title'}",
        f"mcgw {_version()}; SHA-256 of the {digest}",
        f"units: {what} in {value[1]}; {kind.against} in {argument[1]}",
        *(_zero(scene, system) if kind.against == "gap" else ()),
    ]


def _curve(name: str) -> str:
    return "mean" if name == "mean" else f"{name[1:]} % quantile"


def _version() -> str:
    try:
        return version("mcgw")
    except PackageNotFoundError:
        return "unknown"


def _zero(scene: Scene, system: UnitSystem) -> list[str]:
    """From which plane gaps d count."""
    factor, unit = system.length
    lines = ["gap d: of the rigid plane from the mean plane of the summits"]
    if isinstance(scene.heights, Nayak):
        rise = factor * scene.surface.sigma * scene.heights.mean / scene.heights.std
        lines.append(f"(from the mean plane of the surface it is larger by {rise:.9e} {unit})")
    if scene.interaction is not None:
        felt = (
            "nominal"
            if scene.interaction.nominal
            else "what the asperities feel, without what the bulk gives"
        )
        lines.append(f"asperities press each other down; d is {felt}")
    return lines

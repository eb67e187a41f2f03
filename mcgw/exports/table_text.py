"""A curve as the text of a file that a program reads."""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

import numpy as np

from analytic.arrays import Array
from mcgw.exports.curves import Curve, Kind
from mcgw.exports.programs import Program, foot_of, rows_of
from mcgw.formats.sheet import brief
from mcgw.formats.table import Column, Table
from mcgw.machine.terminal import one_line
from mcgw.scene.in_words import joint_text
from mcgw.scene.scene import Scene


@dataclass(frozen=True)
class UnitSystem:
    """Factors from SI, and names.

    Parameters
    ----------
    length, pressure, stiffness, conductance : tuple of (float, str)
        Factor and unit of lengths (m), pressures (Pa), stiffness (Pa/m), conductance (W/(m^2 K) or S/m^2).
    """

    length: tuple[float, str]
    pressure: tuple[float, str]
    stiffness: tuple[float, str]
    conductance: tuple[float, str]


# Of mm, N and s the unit of power is N mm/s = mW, so that 1 W/(m^2 K) = 1e3 mW / (1e6 mm^2 K). With volts
# that of currents is mW/V = mA.
UNIT_SYSTEMS = {
    "SI": UnitSystem((1.0, "m"), (1.0, "Pa"), (1.0, "Pa/m"), (1.0, "W/(m^2 K), or S/m^2")),
    "mm-N-s": UnitSystem((1e3, "mm"), (1e-6, "MPa"), (1e-9, "MPa/mm"), (1e-3, "mW/(mm^2 K), or mA/(mm^2 V)")),
}


def heading(
    scene: Scene, surfaces: int, kind: Kind, curve: Curve, system: UnitSystem, digest: str
) -> list[str]:
    """Lines of plain ASCII text, without the mark of a comment."""
    over = f"{surfaces} surfaces of {scene.n_asperities:g} asperities, seed {scene.seed}"
    argument = system.length if kind.against == "gap" else system.pressure
    what = kind.quantity if kind.quantity == "pressure" else f"{kind.quantity} per nominal area"
    curve_name = curve.name if curve.name == "mean" else f"{curve.name[1:]} % quantile"
    return [
        f"{kind.name}, {curve_name} over {over}, at equal {kind.against}",
        f"scene: {brief(scene.title) or 'without a title'}",
        f"mcgw {_version()}; SHA-256 of the {digest}",
        f"units: {what} in {unit_of(kind, system, scene)}; {kind.against} in {argument[1]}",
        *_filled(kind, scene),
        *(_zero(scene, system) if kind.against == "gap" else ()),
    ]


def unit_of(kind: Kind, system: UnitSystem, scene: Scene) -> str:
    """Unit of the quantity, for heat or current."""
    name: str = getattr(system, kind.quantity)[1]
    heat, _, current = name.partition(", or ")
    return current if current and scene.film is not None and not scene.film.thermal else heat


def _filled(kind: Kind, scene: Scene) -> list[str]:
    """Name what conducts in a joint."""
    if kind.quantity != "conductance" or not scene.thermal:
        return []
    stays = {
        "pressure": "at pressure 0 it has the value of the lowest pressure",
        "gap": "gas also conducts beyond the last line: add separations up to where the bodies part",
    }
    return [f"joint: {joint_text(scene)}", *([stays[kind.against]] if kind.stays(scene) else [])]


def _version() -> str:
    try:
        return version("mcgw")
    except PackageNotFoundError:
        return "unknown"


def _zero(scene: Scene, system: UnitSystem) -> list[str]:
    """Name the plane from which gaps are measured."""
    factor, unit = system.length
    lines = ["gap d: from the rigid plane to the mean plane of the summits"]
    if scene.rise is not None:
        rise = factor * scene.surface.sigma * scene.rise
        lines.append(f"(from the mean plane of the surface it is larger by {rise:.9e} {unit})")
    if scene.interaction is not None:
        felt = "the separation that asperities feel, without the displacement of the bulk"
        lines.append(f"with asperity interaction; d is {felt}")
    return lines


def in_units(curve: Curve, kind: Kind, system: UnitSystem) -> Curve:
    """Convert a curve from SI."""
    factor = (system.length if kind.against == "gap" else system.pressure)[0]
    return Curve(curve.name, factor * curve.x, getattr(system, kind.quantity)[0] * curve.y)


def table_text(
    curve: Curve,
    kind: Kind,
    program: Program,
    system: UnitSystem,
    head: Sequence[str],
    file: str,
    *,
    stays: bool = False,
) -> str:
    """Comments, keyword and rows.

    Parameters
    ----------
    curve : Curve
        In the units of the file.
    kind, program, system
        The kind of table, the program and the units.
    head : sequence of str
        First comment lines.
    file : str
        Name of the file, for its comments.
    stays : bool, optional
        Whether the quantity stays finite at zero load.

    Raises
    ------
    ValueError
        If the program has no room for it.
    """
    foot = foot_of(curve) if kind.against == "gap" and not stays else 0.0
    rows = rows_of(curve, kind, program, foot, stays)
    _check(rows, kind, program)
    hints = (line.format(file=file, kind=kind) for line in program.hints[kind.name])
    comments = [*head, *(_foot(foot, kind, program, system) if foot else ()), *hints]
    lines = [f"{program.comment} {one_line(line)}" for line in comments]
    lines += [program.keywords[kind.name]] if program.keywords[kind.name] else []
    lines += [program.separator.join(f"{x:.9e}" for x in row) for row in rows.tolist()]
    return "\n".join([*lines, ""])


def _foot(foot: float, kind: Kind, program: Program, system: UnitSystem) -> list[str]:
    """State where the curve ends, and what zero means."""
    lines = [
        f"there is no load beyond the gap d0 = {foot:.9e} {system.length[1]}",
        "(where the line through the last two points reaches 0)",
    ]
    if program.overclosure and kind.quantity == "pressure":
        lines.append("overclosure = d0 - d: place the two surfaces so that they meet where the gap is d0")
    return lines


def _check(rows: Array, kind: Kind, program: Program) -> None:
    if program.most is not None and len(rows) > program.most:
        raise ValueError(
            f"points = {len(rows) - 1}: {program.name} reads at most {program.most} lines; give fewer"
        )
    if program.least_step and kind.quantity == "pressure" and np.diff(rows[:, 1]).min() < program.least_step:
        raise ValueError(
            f"points: overclosures are closer than {program.least_step:g}, and {program.name} would separate "
            'them; give fewer points or units = "mm-N-s"'
        )


def all_curves(curves: Sequence[Curve], kind: Kind, system: UnitSystem, scene: Scene) -> Table:
    """All curves side by side, in the units of the files; empty where one carries nothing."""
    x = np.unique(np.concatenate([curve.x for curve in curves])).tolist()
    unit = (system.length if kind.against == "gap" else system.pressure)[1]
    value = unit_of(kind, system, scene)
    columns = [Column(f"{kind.against} ({unit})", x)]
    for curve in curves:
        held = dict(zip(curve.x.tolist(), curve.y.tolist(), strict=True))
        columns.append(Column(f"{kind.quantity} {curve.name} ({value})", [held.get(at, "") for at in x]))
    return Table(tuple(columns))

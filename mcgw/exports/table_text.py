"""A curve as the text of a file that a program reads."""

from collections.abc import Sequence

import numpy as np

from analytic.arrays import Array
from mcgw.exports.curves import Curve, Kind
from mcgw.exports.programs import Program
from mcgw.machine.terminal import brief, one_line
from mcgw.scene.in_words import joint_text
from mcgw.scene.scene import Scene

# Factors from SI, and names. Of mm, N and s the unit of power is N mm/s = mW, so that 1 W/(m^2 K) is
# 1e3 mW / (1e6 mm^2 K). With volts that of currents is mW/V = mA.
UNITS = {
    "SI": {
        "gap": (1.0, "m"), "pressure": (1.0, "Pa"), "stiffness": (1.0, "Pa/m"),
        "conductance": (1.0, "W/(m^2 K)"), "current": (1.0, "S/m^2"),
    },
    "mm-N-s": {
        "gap": (1e3, "mm"), "pressure": (1e-6, "MPa"), "stiffness": (1e-9, "MPa/mm"),
        "conductance": (1e-3, "mW/(mm^2 K)"), "current": (1e-3, "mA/(mm^2 V)"),
    },
}  # fmt: skip


def unit_of(name: str, units: str, scene: Scene) -> str:
    """Return the unit of a quantity or argument; of a conductance, for heat or current."""
    current = name == "conductance" and scene.film is not None and not scene.film.thermal
    return UNITS[units]["current" if current else name][1]


def heading(scene: Scene, surfaces: int, kind: Kind, curve: Curve, units: str, origin: str) -> list[str]:
    """Lines of plain ASCII text, without the mark of a comment; `origin` names program and digest."""
    what = kind.quantity if kind.quantity == "pressure" else f"{kind.quantity} per nominal area"
    name = curve.name if curve.name == "mean" else f"{curve.name[1:]} % quantile"
    lines = [
        f"{kind.name}, {name} over {surfaces} surfaces of {scene.n_asperities:g} asperities, seed "
        f"{scene.seed}, at equal {kind.against}",
        f"scene: {brief(scene.title) or 'without a title'}",
        origin,
        f"units: {what} in {unit_of(kind.quantity, units, scene)}; "
        f"{kind.against} in {unit_of(kind.against, units, scene)}",
    ]
    if kind.quantity == "conductance" and scene.thermal:
        lines.append(f"joint: {joint_text(scene)}")
    if kind.stays(scene) and scene.thermal:
        beyond = "gas also conducts beyond the last line: add separations up to where the bodies part"
        at_0 = "at pressure 0 it has the value of the lowest pressure"
        lines.append(beyond if kind.against == "gap" else at_0)
    return lines + (_zero(scene, *UNITS[units]["gap"]) if kind.against == "gap" else [])


def _zero(scene: Scene, factor: float, unit: str) -> list[str]:
    """Name the plane from which gaps are measured."""
    lines = ["gap d: from the rigid plane to the mean plane of the summits"]
    if scene.rise is not None:
        rise = factor * scene.surface.sigma * scene.rise
        lines.append(f"(from the mean plane of the surface it is larger by {rise:.9e} {unit})")
    if scene.interaction is not None:
        felt = "the separation that asperities feel, without the displacement of the bulk"
        lines.append(f"with asperity interaction; d is {felt}")
    return lines


def in_units(curve: Curve, kind: Kind, units: str) -> Curve:
    """Convert a curve from SI."""
    known = UNITS[units]
    return Curve(curve.name, known[kind.against][0] * curve.x, known[kind.quantity][0] * curve.y)


def table_text(
    curve: Curve,
    kind: Kind,
    program: Program,
    units: str,
    head: Sequence[str],
    file: str,
    *,
    stays: bool = False,
) -> str:
    """Comments, header and rows.

    Parameters
    ----------
    curve : Curve
        In the units of the file.
    kind, program, units
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
    """  # fmt: skip
    foot, lines = 0.0, list(head)
    overclosure = program.overclosure and kind.quantity == "pressure"
    if kind.against == "gap" and not stays:
        (x1, x2), (y1, y2) = curve.x[-2:], curve.y[-2:]
        foot = float(x2 + y2 * (x2 - x1) / (y1 - y2))
        lines.append(f"there is no load beyond the gap d0 = {foot:.9e} {UNITS[units]['gap'][1]}")
        lines.append("(where the line through the last two points reaches 0)")
        if overclosure:
            lines.append("overclosure = d0 - d: place the two surfaces so that they meet where the gap is d0")
    lines += (line.format(file=file, kind=kind) for line in program.hints[kind.name])
    rows = _rows(curve, kind, program, foot, stays)
    if program.most is not None and len(rows) > program.most:
        raise ValueError(
            f"points = {len(rows) - 1}: {program.name} reads at most {program.most} lines; give fewer"
        )
    if overclosure and program.least_step and np.diff(rows[:, 1]).min() < program.least_step:
        raise ValueError(
            f"points: overclosures are closer than {program.least_step:g}, and {program.name} would separate "
            'them; give fewer points or units = "mm-N-s"'
        )
    lines = [f"{program.comment} {one_line(line)}" for line in lines]
    lines += filter(None, [program.header[kind.name]])
    lines += [program.separator.join(f"{x:.9e}" for x in row) for row in rows.tolist()]
    return "\n".join([*lines, ""])


def _rows(curve: Curve, kind: Kind, program: Program, foot: float, stays: bool) -> Array:
    """Rows in the order that a program reads, shape (rows, 2).

    The one at pressure 0 or gap `foot` carries nothing; a curve that stays keeps its value there.
    """
    x, y = curve.x, curve.y
    if kind.against == "pressure":
        x, y = np.append(0.0, x), np.append(y[0] if stays else 0.0, y)
    elif not stays:
        x, y = np.append(x, foot), np.append(y, 0.0)
        if program.overclosure and kind.quantity == "pressure":
            x, y = (foot - x)[::-1], y[::-1]
    return np.column_stack([x, y] if program.first == "x" else [y, x])

"""Kinds of tables, how each finite-element program reads one, and a curve as the text of its file."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from analytic.arrays import Array
from mcgw.machine.terminal import brief, one_line
from mcgw.scene.scene import Scene
from mcgw.scene.writing import joint_text

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


class Kind(NamedTuple):
    """A table of "pressure", "conductance" or "stiffness" against "gap" or "pressure"."""

    quantity: str
    against: str

    @property
    def name(self) -> str:
        """Quantity and argument."""
        return "-".join(self)

    def answer(self, scene: Scene) -> str:
        """Return the tabulated answer of a scene; the conductance is that of the joint, if there is one."""
        if self.quantity != "conductance":
            return self.quantity
        return "contact_conductance" if scene.gas is None else "joint_conductance"

    def stays(self, scene: Scene) -> bool:
        """Whether gas still conducts at zero load."""
        return self.quantity == "conductance" and scene.filled is not None and scene.filled.gas is not None


_ALL = ("pressure-gap", "conductance-pressure", "conductance-gap", "stiffness-pressure")
KINDS = {name: Kind(*name.split("-")) for name in _ALL}


@dataclass(frozen=True)
class Program:
    """A finite-element program and its rules."""

    name: str  # on the command line
    endings: tuple[str, ...]  # of its files
    comment: str  # how a comment line begins
    separator: str  # between two numbers of a row
    # By table that it takes: the line above the rows, empty where there is none; then lines that say how the
    # program includes a ``file``, and what it does beyond the ends.
    tables: dict[str, tuple[str, ...]]
    deck: bool = False  # values stand first, and gaps as overclosures that begin with 0 as the pressure does
    most: int | None = None  # rows
    least_step: float = 0.0  # overclosures nearer than that are moved apart by the program


_BEHAVIOR = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR"
_INCLUDED = "under *SURFACE INTERACTION: *INCLUDE, INPUT={file}"
PROGRAMS = {program.name: program for program in (
    # Rules and limits as in CalculiX's manual and its sources (surfacebehaviors.f, springforc_n2f.f).
    Program(
        "calculix", (".inp",), "**", ", ",
        {
            "pressure-gap": (
                _BEHAVIOR, _INCLUDED,
                "use *CONTACT PAIR, TYPE=NODE TO SURFACE: with SURFACE TO SURFACE CalculiX misreads tables",
                "beyond the last line the pressure is constant",
                "in a thermomechanical step give *GAP CONDUCTANCE too",
            ),
            "conductance-pressure": (
                "*GAP CONDUCTANCE", _INCLUDED,
                "below *SURFACE BEHAVIOR; beyond the last line the conductance is constant",
                "third entry: temperature, which has no effect here",
            ),
        },
        deck=True, most=200, least_step=1e-10,
    ),
    # Abaqus Keywords Guide, *SURFACE BEHAVIOR and *GAP CONDUCTANCE.
    Program(
        "abaqus", (".inp",), "**", ", ",
        {
            "pressure-gap": (
                _BEHAVIOR, _INCLUDED, "beyond the last line the pressure continues with the last slope",
            ),
            "conductance-pressure": (
                "*GAP CONDUCTANCE, PRESSURE", _INCLUDED, "beyond the last line the conductance is constant",
            ),
            "conductance-gap": ("*GAP CONDUCTANCE", _INCLUDED, "beyond the last line nothing is conducted"),
        },
        deck=True,
    ),
    # MOOSE, PiecewiseTabularBase.C: comments "#", rising x.
    Program(
        "moose", (".csv",), "#", ",",
        dict.fromkeys(KINDS, (
            "",
            "[Functions] [{kind.quantity}] type = PiecewiseLinear data_file = {file} format = columns [] []",
            "x: {kind.against}, y: {kind.quantity}; beyond the ends y is constant, unless extrap = true",
        )),
    ),
    # COMSOL Multiphysics Reference Manual, "Spreadsheet Data Format": comments "%".
    Program(
        "comsol", (".txt", ".dat"), "%", " ",
        dict.fromkeys(KINDS, (
            "",
            "Definitions > Functions > Interpolation: Data source File, Data format Spreadsheet, 1 argument",
            "column 1: {kind.against} (argument), column 2: {kind.quantity}; enter their units under Units",
            "beyond the ends: Extrapolation Constant",
        )),
    ),
)}  # fmt: skip


class Sheet(NamedTuple):
    """A kind of table of so many surfaces of a scene, for a program; `origin` names ours and the digest."""

    scene: Scene
    surfaces: int
    kind: Kind
    program: Program
    units: str
    origin: str

    def unit(self, name: str) -> tuple[float, str]:
        """Return factor from SI and unit of a quantity or argument; of a conductance, for heat or current."""
        current = name == "conductance" and not self.scene.thermal
        return UNITS[self.units]["current" if current else name]

    def heading(self, name: str) -> Iterator[str]:
        """Lines of plain text, without the mark of a comment."""
        scene, kind = self.scene, self.kind
        what = kind.quantity if kind.quantity == "pressure" else f"{kind.quantity} per nominal area"
        curve = name if name == "mean" else f"{name[1:]} % quantile"
        yield (
            f"{kind.name}, {curve} over {self.surfaces} surfaces of {scene.n_asperities:g} asperities, seed "
            f"{scene.seed}, at equal {kind.against}"
        )
        yield f"scene: {brief(scene.title) or 'without a title'}"
        yield self.origin
        units = self.unit(kind.quantity)[1], self.unit(kind.against)[1]
        yield f"units: {what} in {units[0]}; {kind.against} in {units[1]}"
        if kind.quantity == "conductance" and scene.thermal:
            yield f"joint: {joint_text(scene)}"
        if kind.stays(scene) and kind.against == "gap":
            yield "gas also conducts beyond the last line: add separations up to where the bodies part"
        elif kind.stays(scene):
            yield "at pressure 0 it has the value of the lowest pressure"
        if kind.against != "gap":
            return
        yield "gap d: from the rigid plane to the mean plane of the summits"
        factor, unit = self.unit("gap")
        if scene.rise is not None:
            rise = factor * scene.surface.sigma * scene.rise
            yield f"(from the mean plane of the surface it is larger by {rise:.9e} {unit})"
        if scene.interaction is not None:
            felt = "the separation that asperities feel, without the displacement of the bulk"
            yield f"with asperity interaction; d is {felt}"

    def text(self, name: str, x: Array, y: Array, file: str) -> str:
        """Comments, header and rows of a curve, "mean" or a quantile, for a file of this name.

        Both columns are in the units of the file; x rises. What the program has no room for is refused.
        """
        kind, program, lines = self.kind, self.program, [*self.heading(name)]
        overclosure = program.deck and kind.quantity == "pressure"
        stays = kind.stays(self.scene)
        if kind.against == "pressure":  # nothing is carried at 0, where a curve that stays keeps its value
            x, y = np.append(0.0, x), np.append(y[0] if stays else 0.0, y)
        elif not stays:  # nor beyond a gap
            foot = float(x[-1] + y[-1] * (x[-1] - x[-2]) / (y[-2] - y[-1]))
            x, y = np.append(x, foot), np.append(y, 0.0)
            lines.append(f"there is no load beyond the gap d0 = {foot:.9e} {self.unit('gap')[1]}")
            lines.append("(where the line through the last two points reaches 0)")
            if overclosure:
                lines.append(
                    "overclosure = d0 - d: place the two surfaces so that they meet where the gap is d0"
                )
                x, y = (foot - x)[::-1], y[::-1]
        header, *hints = program.tables[kind.name]
        lines += (hint.format(file=file, kind=kind) for hint in hints)
        if program.most is not None and len(x) > program.most:
            raise ValueError(
                f"points = {len(x) - 1}: {program.name} reads at most {program.most} lines; give fewer"
            )
        if overclosure and program.least_step and np.diff(x).min() < program.least_step:
            raise ValueError(
                f"points: overclosures are closer than {program.least_step:g}, and {program.name} would "
                'separate them; give fewer points or units = "mm-N-s"'
            )
        lines = [f"{program.comment} {one_line(line)}" for line in lines]
        lines += [header] * bool(header)
        rows = np.column_stack([y, x] if program.deck else [x, y])
        lines += [program.separator.join(f"{x:.9e}" for x in row) for row in rows.tolist()]
        return "\n".join([*lines, ""])

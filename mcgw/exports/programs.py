"""How each finite-element program reads a table: order of columns, signs, comments and requirements."""

import re
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array
from mcgw.exports.curves import KINDS, Curve, Kind


@dataclass(frozen=True)
class Program:
    """A finite-element program and its rules.

    Parameters
    ----------
    name : str
        Its name on the command line.
    endings : tuple of str
        Endings of its files.
    comment : str
        How a comment line begins.
    separator : str
        Between two numbers of a row.
    keywords : dict of str to str
        By table: the line that stands above the rows; empty where there is none. Tables that it does not take
        are not there.
    overclosure : bool
        Whether gaps are written as overclosures that begin with 0 where the pressure does.
    first : {"x", "y"}
        Which column stands first: argument or value.
    hints : dict of str to tuple of str
        By table: lines that say how the program includes a ``file``, and what it does beyond the ends.
    most : int, optional
        Largest number of rows.
    least_step : float, optional
        Overclosures nearer than that are moved apart by the program.
    """

    name: str
    endings: tuple[str, ...]
    comment: str
    separator: str
    keywords: dict[str, str]
    overclosure: bool
    first: str
    hints: dict[str, tuple[str, ...]]
    most: int | None = None
    least_step: float = 0.0


def check_name(file: str, program: Program) -> None:
    """Refuse a file name that cannot stand in an input of the program or in its comments.

    Raises
    ------
    ValueError
        If it is not made of letters, digits and ``._+-``, or is too long for a line.
    """
    if not re.fullmatch(r"[A-Za-z0-9._+-]{1,64}", file):
        raise ValueError(
            f"path = {file!r}: {program.name} includes it by name; give a name of at most 64 letters, digits "
            "and . _ + -"
        )


def foot_of(curve: Curve) -> float:
    """The gap at which a line through the last two points reaches zero pressure."""
    (x1, x2), (y1, y2) = curve.x[-2:], curve.y[-2:]
    return float(x2 + y2 * (x2 - x1) / (y1 - y2))


def rows_of(curve: Curve, kind: Kind, program: Program, foot: float, stays: bool = False) -> Array:
    """Rows in the order that a program reads, shape (rows, 2).

    The first point, at pressure 0 or gap `foot`, carries nothing, unless the curve `stays` as it is.
    """
    x, y = curve.x, curve.y
    if kind.against == "pressure":
        x, y = np.concatenate([[0.0], x]), np.concatenate([y[:1] if stays else [0.0], y])
    elif not stays:
        x, y = np.concatenate([curve.x, [foot]]), np.concatenate([curve.y, [0.0]])
        if program.overclosure and kind.quantity == "pressure":
            x, y = (foot - x)[::-1], y[::-1]
    return np.column_stack([x, y] if program.first == "x" else [y, x])


_BEHAVIOR = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR"
_ANY = dict.fromkeys(KINDS, "")
_INCLUDED = "under *SURFACE INTERACTION: *INCLUDE, INPUT={file}"
PROGRAMS = {
    # Rules and limits as in CalculiX's manual and its sources (surfacebehaviors.f, springforc_n2f.f).
    "calculix": Program(
        "calculix", (".inp",), "**", ", ",
        {"pressure-gap": _BEHAVIOR, "conductance-pressure": "*GAP CONDUCTANCE"},
        overclosure=True, first="y", most=200, least_step=1e-10,
        hints={
            "pressure-gap": (
                _INCLUDED,
                "use *CONTACT PAIR, TYPE=NODE TO SURFACE: with SURFACE TO SURFACE CalculiX misreads tables",
                "beyond the last line the pressure is constant",
                "in a thermomechanical step give *GAP CONDUCTANCE too",
            ),
            "conductance-pressure": (
                _INCLUDED,
                "below *SURFACE BEHAVIOR; beyond the last line the conductance is constant",
                "third entry: temperature, which has no effect here",
            ),
        },
    ),
    # Abaqus Keywords Guide, *SURFACE BEHAVIOR and *GAP CONDUCTANCE.
    "abaqus": Program(
        "abaqus", (".inp",), "**", ", ",
        {
            "pressure-gap": _BEHAVIOR,
            "conductance-pressure": "*GAP CONDUCTANCE, PRESSURE",
            "conductance-gap": "*GAP CONDUCTANCE",
        },
        overclosure=True, first="y",
        hints={
            "pressure-gap": (_INCLUDED, "beyond the last line the pressure continues with the last slope"),
            "conductance-pressure": (_INCLUDED, "beyond the last line the conductance is constant"),
            "conductance-gap": (_INCLUDED, "beyond the last line nothing is conducted"),
        },
    ),
    # MOOSE, PiecewiseTabularBase.C: comments "#", rising x.
    "moose": Program(
        "moose", (".csv",), "#", ",", _ANY, overclosure=False, first="x",
        hints=dict.fromkeys(KINDS, (
            "[Functions] [{kind.quantity}] type = PiecewiseLinear data_file = {file} format = columns [] []",
            "x: {kind.against}, y: {kind.quantity}; beyond the ends y is constant, unless extrap = true",
        )),
    ),
    # COMSOL Multiphysics Reference Manual, "Spreadsheet Data Format": comments "%".
    "comsol": Program(
        "comsol", (".txt", ".dat"), "%", " ", _ANY, overclosure=False, first="x",
        hints=dict.fromkeys(KINDS, (
            "Definitions > Functions > Interpolation: Data source File, Data format Spreadsheet, 1 argument",
            "column 1: {kind.against} (argument), column 2: {kind.quantity}; enter their units under Units",
            "beyond the ends: Extrapolation Constant",
        )),
    ),
}  # fmt: skip

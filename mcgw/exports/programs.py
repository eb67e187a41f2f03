"""How each finite-element program reads a table: a row each."""

from dataclasses import dataclass

from mcgw.exports.curves import KINDS


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
    first: str = "x"  # which column stands first: "x", the argument, or "y", the value
    overclosure: bool = False  # gaps are written as overclosures that begin with 0 where the pressure does
    most: int | None = None  # rows
    least_step: float = 0.0  # overclosures nearer than that are moved apart by the program


_BEHAVIOR = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR"
_INCLUDED = "under *SURFACE INTERACTION: *INCLUDE, INPUT={file}"
_ROWS = (
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
        first="y", overclosure=True, most=200, least_step=1e-10,
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
            "conductance-gap": (
                "*GAP CONDUCTANCE", _INCLUDED, "beyond the last line nothing is conducted",
            ),
        },
        first="y", overclosure=True,
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
)  # fmt: skip
PROGRAMS = {program.name: program for program in _ROWS}

"""How each finite-element program reads a table: a row each."""

from dataclasses import dataclass

from mcgw.exports.curves import KINDS


@dataclass(frozen=True)
class Program:
    """A finite-element program and its rules.

    Parameters
    ----------
    name : str
        Its name on the command line.
    endings : tuple of str
        Endings of its files.
    comment, separator : str
        How a comment line begins; what stands between two numbers of a row.
    tables : dict of str to tuple of str
        By table that it takes: the line above the rows, empty where there is none; then lines that say how
        the program includes a ``file``, and what it does beyond the ends.
    first : {"x", "y"}
        Which column stands first: argument or value.
    overclosure : bool
        Whether gaps are written as overclosures that begin with 0 where the pressure does.
    most : int, optional
        Largest number of rows.
    least_step : float, optional
        Overclosures nearer than that are moved apart by the program.
    """

    name: str
    endings: tuple[str, ...]
    comment: str
    separator: str
    tables: dict[str, tuple[str, ...]]
    first: str = "x"
    overclosure: bool = False
    most: int | None = None
    least_step: float = 0.0


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

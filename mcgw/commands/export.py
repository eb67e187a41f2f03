"""``mcgw export``: contact tables for finite-element programs."""

from pathlib import Path
from typing import Annotated, Literal

from mcgw.commands.kinds import SceneOrFile, values
from mcgw.commands.outputs import CSV, Format, Output, check_outputs
from mcgw.commands.voice import news


def export(
    source: SceneOrFile,
    *,
    to: Literal["calculix", "abaqus", "moose", "comsol", "json"],
    table: Literal[
        "pressure-gap", "conductance-pressure", "conductance-gap", "stiffness-pressure"
    ] = "pressure-gap",
    points: int = 40,
    pressures: Annotated[list[float] | None, values("Pa")] = None,
    quantile: list[float] | None = None,
    units: Literal["SI", "mm-N-s"] = "SI",
    output: Path,
) -> None:
    """Write pressure, conductance or stiffness as a table for a finite-element program.

    Parameters
    ----------
    source : SCENE_OR_FILE
        scene (TOML), whose surfaces are drawn as needed; or an ensemble file (HDF5)
    to
        the program; json: one file with all columns against the gap in SI units, and their origin
    table
        the quantity and its argument
    points : N
        number of rows
    pressures : P
        nominal pressures, such as 10kPa:20MPa:30; default: those that the separations of the scene span
    quantile : Q
        quantiles over the surfaces, besides the mean; default: 0.05 and 0.95
    units
        units of the files
    output : FILE
        file of the mean: .inp, for moose .csv, for comsol .txt, for json .json; quantiles and a joint table
        go beside it

    Examples
    --------
    mcgw export mine.toml --to calculix --units mm-N-s -o contact.inp
    """
    from mcgw.exports.programs import PROGRAMS
    from mcgw.exports.writing import export as exported, files_of_export

    *tables, together = files_of_export(output, quantile)
    if to == "json":
        check_outputs([Output(output, Format("a table", (".json",)))])
    else:
        form = Format(f"a table for {to}", PROGRAMS[to].endings)
        check_outputs([*(Output(path, form) for path in tables), Output(together, CSV)])
    made = exported(
        source, output, to=to, table=table, points=points, pressures=pressures, quantiles=quantile,
        units=units,
    )  # fmt: skip
    words = ["pressure, area and conductance against the gap"]
    if to != "json":
        words = [f"{table}, mean over the surfaces", *["the same for a quantile"] * (len(made) - 2)]
        words.append("all curves")
    news(*(f"{path}: {what}" for path, what in zip(made, words, strict=True)))

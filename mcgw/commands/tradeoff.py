"""``mcgw tradeoff``: error against time of a scene on this machine."""

from pathlib import Path
from typing import Annotated

from mcgw.commands.kinds import SceneIn, file_out, quantity
from mcgw.commands.outputs import table_or_figure
from mcgw.commands.voice import details, news

_FILES = ("{}-tradeoff.csv", "{}-tradeoff-measured.csv", "{}-tradeoff.png")


def tradeoff(
    scene: SceneIn,
    *,
    output: Annotated[list[Path], file_out(table_or_figure, "out", names=_FILES)],
    seconds: Annotated[float, quantity("s")] = 60.0,
) -> None:
    """Measure what each answer costs, how exact it is, and recommend a way.

    Parameters
    ----------
    output : DIR
        folder of tables and figure
    seconds : TIME
        time limit, s, or with a unit, such as "5 min"

    Examples
    --------
    mcgw tradeoff runs/demo.toml -o out
    """
    from mcgw.figures.panels import save
    from mcgw.figures.studies import tradeoff_figure
    from mcgw.statistics.tradeoff import tradeoff as studied
    from mcgw.statistics.ways import TARGETS

    table, measured, figure = output
    found = studied(scene, seconds=seconds)
    found.table().write(table)
    found.measurements().write(measured)
    save(tradeoff_figure(found), figure)
    news(found.sheet(TARGETS).text())
    news(f"{table}: what to run for each error ({found.seconds:.0f} s)", f"{figure}: figure")
    details("", found.measurements().text())

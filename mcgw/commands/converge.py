"""``mcgw converge``: the statistical convergence test of a scene."""

from pathlib import Path
from typing import Annotated

from mcgw.commands.kinds import SceneIn, file_out
from mcgw.commands.outputs import table_or_figure
from mcgw.commands.voice import ALL, news, says

_FILES = ("{}-converge.png",)


def converge(
    scene: SceneIn, *, output: Annotated[list[Path], file_out(table_or_figure, "out", names=_FILES)]
) -> bool:
    """Test statistical convergence: slopes, coverage, variance, skewness, ... (exit code 1 if it fails).

    Parameters
    ----------
    output : DIR
        folder of the figure

    Examples
    --------
    mcgw converge runs/demo.toml -o out
    """
    from mcgw.figures.panels import save
    from mcgw.figures.studies import convergence_figure
    from mcgw.statistics.convergence import SEEDS, converge as tested

    found = tested(scene)
    save(convergence_figure(found), output[0])
    many = f"{SEEDS} ensembles of {found.scene.n_surfaces} surfaces"
    news(f"convergence {found.word}: p = {found.p:.3g} over all checks of {many}", f"{output[0]}: figure")
    if says(ALL) or not found.passed:
        news(found.table().text())
    return found.passed

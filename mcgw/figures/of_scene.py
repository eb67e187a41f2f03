"""The paper's figures, and some that it lacks, of anybody's scene beside its homogeneous reference."""

from collections.abc import Callable, Iterator

from mcgw.figures import scene_further, scene_paper
from mcgw.figures.beside import Beside, NoMeaningError
from mcgw.figures.data import FigureData
from mcgw.machine.progress import steps
from mcgw.scene.scene import Scene

__all__ = ["OF_SCENE", "scene_figures"]

_FIGURES: dict[str, Callable[[Beside], FigureData]] = {
    "figure-1": scene_paper.figure_1,
    "figure-2": scene_paper.figure_2,
    "figure-3": scene_paper.figure_3,
    "figure-4": scene_paper.figure_4,
    "figure-5": scene_paper.figure_5,
    "figure-6": scene_paper.figure_6,
    "equal-load": scene_further.equal_load,
    "area-and-load": scene_further.area_and_load,
    "fluctuations": scene_further.fluctuations,
    "who-yields": scene_further.who_yields,
    "way-back": scene_further.way_back,
}
OF_SCENE = tuple(_FIGURES)  # names of their files


def scene_figures(scene: Scene) -> Iterator[tuple[str, FigureData | str]]:
    """Figures of a scene.

    Parameters
    ----------
    scene : Scene
        Its surface, separations, grading, contact law, height law and seed are used.

    Yields
    ------
    (str, FigureData or str)
        Name of a figure, and its numbers, or why it has no meaning for this scene.
    """
    beside = Beside(scene)
    for name, figure in steps(list(_FIGURES.items()), "figures"):
        try:
            yield name, figure(beside)
        except NoMeaningError as why:
            yield name, str(why)

"""``mcgw figures``: figures of the paper with Monte Carlo, further ones, or figures of a scene."""

from pathlib import Path

from mcgw.commands.kinds import MaybeScene
from mcgw.commands.outputs import Output, check_outputs, table_or_figure
from mcgw.commands.voice import details, news


def figures(
    *,
    output: Path = Path("figures"),
    scene: MaybeScene = None,
    only: list[str] | None = None,
    format: list[str] | None = None,  # noqa: A002
    list: bool = False,  # noqa: A002
    csv: bool = False,
) -> None:
    """Draw Figures 1-6 of the paper with Monte-Carlo points, and some more; or the figures of a scene.

    Parameters
    ----------
    output : DIR
        folder
    scene : SCENE
        draw this scene beside its homogeneous reference instead
    only : NAME
        only these figures; default: all that apply
    format : FORMAT
        png, pdf, svg, ...; default: png
    list
        print the names of all figures without drawing
    csv
        also write the numbers of each figure

    Examples
    --------
    mcgw figures --scene mine.toml --only figure-2 equal-load -o figures
    """
    from mcgw.figures.catalogue import CATALOGUE, figures_of, of_paper
    from mcgw.figures.compared import Compared
    from mcgw.figures.panels import save
    from mcgw.formats.files import together

    names = [*CATALOGUE]
    if list:
        return print(*names, sep="\n")
    for name in only or ():
        if name not in names:
            raise ValueError(f"--only {name}: no such figure; give one of {', '.join(names)}")
    formats = [given.lower().removeprefix(".") for given in format or ["png"]]
    files = {
        name: [output / f"{name}.{ending}" for ending in (*formats, *["csv"] * csv)] for name in only or names
    }
    check_outputs(Output(path, table_or_figure(path)) for paths in files.values() for path in paths)
    drawn: tuple[Path, ...] = ()
    with together():
        for name, data in figures_of(of_paper() if scene is None else Compared(scene), only or names):
            if isinstance(data, str):
                (news if only else details)(f"{name}: not drawn: {data}")
                continue
            save(data, *files[name])
            drawn += tuple(files[name])
    details(*drawn)
    where = f"{output / '*'}.{formats[0]}" if len(formats) == 1 else output
    number = len({path.stem for path in drawn})
    return news(f"{where}: {number} figure{'s' * (number != 1)}; mcgw figures --list for their names")

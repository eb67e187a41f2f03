"""Figures are written faster than matplotlib does, and are the same."""

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from oracles.inside import STYLE, save_figure
from PIL import Image

pytestmark = pytest.mark.site
X = np.linspace(0.0, 4.0, 9)


def labelled():
    """Less than a decade: the minor ticks have labels."""
    figure = Figure(figsize=(4, 3), layout="constrained")
    axis = figure.subplots()
    axis.loglog([2.0, 3.0, 7.0], [0.03, 0.05, 0.08])
    axis.set_xlabel("approach")
    return figure


def sides():
    """Ticks on both sides, at the right alone, within an axis turned round, on a bar of colours, and none."""
    figure = Figure(figsize=(9, 3), layout="constrained")
    both, right, falling, coloured, off = figure.subplots(1, 5)
    both.tick_params(which="both", right=True)
    right.yaxis.tick_right()
    falling.invert_yaxis()
    off.set_axis_off()
    for axis in (both, right, falling, off):
        axis.semilogy(X, 10.0**X)
    points = coloured.scatter(X, X, c=10.0**X, norm=LogNorm())
    figure.colorbar(points, ax=coloured)
    return figure


def pixels(path):
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


@pytest.mark.parametrize("make", [labelled, sides])
def test_pictures_are_those_of_matplotlib(make, tmp_path):
    with mpl.rc_context(STYLE):
        make().savefig(tmp_path / "plain.png")
    with mpl.rc_context(STYLE):
        save_figure(make(), tmp_path / "ours.png")
    plain, ours = pixels(tmp_path / "plain.png"), pixels(tmp_path / "ours.png")
    assert plain.shape == ours.shape
    assert np.array_equal(plain, ours)


def test_a_figure_is_drawn_once(tmp_path, monkeypatch):
    """That is what makes it fast."""
    drawn, draw = [], Figure.draw
    monkeypatch.setattr(Figure, "draw", lambda self, renderer: (drawn.append(self), draw(self, renderer)))
    figures = [sides(), labelled()]
    for figure in figures:
        save_figure(figure, tmp_path / "x.png")
    assert drawn == figures


def written(ending, save, folder, monkeypatch):
    """The bytes of a figure, twice: SOURCE_DATE_EPOCH, matplotlib's clock, is a year later."""
    for at in ("1", "31536000"):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", at)
        with mpl.rc_context(STYLE):
            save(labelled(), folder / f"{at}.{ending}")
        yield (folder / f"{at}.{ending}").read_bytes()


@pytest.mark.parametrize("ending", ["svg", "pdf", "png"])
def test_the_same_bytes_twice_and_texts_stay_texts(ending, tmp_path, monkeypatch):
    one, two = written(ending, save_figure, tmp_path, monkeypatch)
    assert one == two
    if ending == "svg":
        assert b">approach</text>" in one
    if ending == "pdf":
        assert b"/FontFile2" in one  # TrueType
        assert b"/Type3" not in one
        one, two = written(ending, Figure.savefig, tmp_path, monkeypatch)
        assert one != two  # as matplotlib does

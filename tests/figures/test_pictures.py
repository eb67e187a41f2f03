"""Files of figures: the same bytes whenever they are written, and texts stay texts."""

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure
from oracles.inside import STYLE, save_figure

pytestmark = pytest.mark.site


def labelled():
    """Less than a decade: the minor ticks have labels."""
    figure = Figure(figsize=(4, 3), layout="constrained")
    axis = figure.subplots()
    axis.loglog([2.0, 3.0, 7.0], [0.03, 0.05, 0.08])
    axis.set_xlabel("approach")
    return figure


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

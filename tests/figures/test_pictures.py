"""Files of figures: the same bytes whenever they are written, and texts stay texts."""

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure
from oracles.inside import STYLE, save_figure

pytestmark = pytest.mark.site


@pytest.mark.parametrize("ending", ["svg", "pdf", "png"])
def test_the_same_bytes_twice_and_texts_stay_texts(ending, tmp_path, monkeypatch):
    """SOURCE_DATE_EPOCH, matplotlib's clock, is a year later; ticks of less than a decade."""
    for at in ("1", "31536000"):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", at)
        with mpl.rc_context(STYLE):
            figure = Figure(figsize=(4, 3), layout="constrained")
            axis = figure.subplots()
            axis.loglog([2.0, 3.0, 7.0], [0.03, 0.05, 0.08])
            axis.set_xlabel("approach")
            save_figure(figure, tmp_path / f"{at}.{ending}")
    one, two = (path.read_bytes() for path in tmp_path.iterdir())
    assert one == two
    assert ending != "svg" or b">approach</text>" in one
    assert ending != "pdf" or (b"/FontFile2" in one and b"/Type3" not in one)  # TrueType

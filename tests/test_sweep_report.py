"""The page of a sweep: verdict, worst points, cautions and provenance, all text escaped."""

import html
import re
from html.parser import HTMLParser

import mcgw
from mcgw.cli import main
from mcgw.sweeps.cautions import sweep_cautions
from mcgw.sweeps.file import read_attributes

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(
    SURFACE, separations=[2.0, 0.0, 1.0], n_surfaces=200, n_asperities=2000, seed=5, title="<b>&co"
)
OVER = {"grading.gamma": [0.5, 1.0, 2.0], "ensemble.count": ["fixed", "poisson"]}


def test_the_page_of_a_sweep(tmp_path, capsys):
    path = tmp_path / "w.h5"
    sweep = mcgw.sweep(SCENE, OVER, path=path)
    assert main(["report", str(path)]) == 0
    assert "w.html: report" in capsys.readouterr().out
    page = (tmp_path / "w.html").read_text()
    HTMLParser().feed(page)
    assert "<b>" not in page
    assert not re.search(r"<script|https?://(?!www\.w3\.org)", page)
    text = html.unescape(re.sub(r"<[^>]*>", "\n", page))
    compared = mcgw.compare(sweep)
    assert f"p = {compared.verdict.p:.3g} for 6 points together (false alarms: at most 1 in 1000)." in text
    for row in compared.sheet_of(12).rows:
        assert all(cell in text for cell in row)
    for line in sweep_cautions(sweep):
        assert line in text
    assert read_attributes(path)["digest"] in text
    assert main(["report", str(path), "-o", str(path)]) == 2


def test_what_disagrees_says_so(tmp_path, monkeypatch):
    path = tmp_path / "w.h5"
    wrong = mcgw.sweep(SCENE.replace(n_asperities=2100), OVER)
    right = mcgw.sweep(SCENE, OVER, path=path)
    groups = tuple(wrong.groups)
    monkeypatch.setattr(
        "mcgw.commands.report_sweep.open_sweep",
        lambda _: mcgw.sweeps.sweep.Sweep(
            right.axes, right.scenes, right.places, groups, right.edges, right.statistics
        ),
    )
    assert main(["report", str(path)]) == 0
    assert (
        'class="verdict bad">Monte Carlo and theory of this model DISAGREE'
        in (tmp_path / "w.html").read_text()
    )

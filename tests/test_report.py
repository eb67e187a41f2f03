"""The report: one page, whole in itself, that says what the ensemble says."""

import html
import os
import re
import shutil
import subprocess
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import analytic
import mcgw
from mcgw.cli import main
from mcgw.ensemble.intervals import TOO_FEW
from mcgw.jobs.running import run
from mcgw.reports.html import report_html
from mcgw.reports.numbers import columns, number
from mcgw.store.ensembles import read_attributes

QUICK = Path(__file__).parent.parent / "runs" / "quick.toml"
BROWSERS = ("chromium", "google-chrome", "chromium-headless-shell")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "quick.h5"
    run(mcgw.load_scene(QUICK), path)
    return path


@pytest.fixture(scope="module")
def page(file):
    assert main(["report", str(file)]) == 0
    return file.with_suffix(".html").read_text(encoding="utf-8")


class Balanced(HTMLParser):
    """Fails where a tag is closed that is not open."""

    def __init__(self):
        super().__init__()
        self.open, self.ids = [], []

    def handle_starttag(self, tag, attrs):
        if tag not in ("meta", "link", "br", "img"):
            self.open.append(tag)
        self.ids += [value for key, value in attrs if key == "id"]

    def handle_startendtag(self, _, attrs):
        self.ids += [value for key, value in attrs if key == "id"]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_page_is_whole_in_itself(page):
    parser = Balanced()
    parser.feed(page)
    assert not parser.open
    assert len(set(parser.ids)) == len(parser.ids)
    assert len(page.encode()) < 3e6
    assert "<script" not in page
    assert not re.findall(r'(?:src|href)="(?!#|data:,|data:image/png;base64,)', page)
    assert not re.search(r"url\((?!#)", page)
    assert page.count("<svg") == 10  # four against pressure; five quantities and their spread
    assert page.count('<img src="data:image/png;base64,') == 2  # a patch, and its contacts
    assert len(re.findall(r'<img [^>]*alt="[^"]+"', page)) == 2
    assert page.count('role="img" aria-label="') == 10


def test_numbers_of_the_page_are_those_of_the_ensemble(file, page):
    ensemble = mcgw.open_ensemble(file)
    low, high = ensemble.interval("load")
    for k in (0, 4, 8):
        half = columns([(ensemble.mean("load"), 5), ((high - low) / 2, 2)])
        assert f"<td>{half[0][k]}</td><td>{half[1][k] or TOO_FEW}</td>" in page
        load = analytic.load(ensemble.scene.surface, ensemble.separations[k], ensemble.scene.grading)
        shown = f"{float(load) / 30:.4e}".partition("e")[0]
        assert f"<td>{shown}×10" in page  # 1000 asperities, not eta A_n = 30 000
    attributes = read_attributes(file)
    assert attributes["digest"] in page
    assert "Monte Carlo and theory of this model agree" in page


def test_scene_of_the_page_runs_again(file, page):
    text = html.unescape(re.findall(r"<pre>(.*?)</pre>", page, flags=re.DOTALL)[-1])
    assert mcgw.scene_from(text) == mcgw.open_ensemble(file).scene


def test_disagreement_is_shown_and_names_are_no_markup(file):
    ensemble = mcgw.open_ensemble(file)
    stiffer = replace(ensemble.scene.surface, E_star=1.1 * ensemble.scene.surface.E_star)
    wrong = replace(ensemble, scene=replace(ensemble.scene, surface=stiffer, title="<b>&1"))
    page = report_html(wrong, read_attributes(file))
    assert 'class="verdict bad"' in page
    assert "<h1>&lt;b&gt;&amp;1</h1>" in page


def test_one_surface_and_one_separation_have_a_report(file, make_scene):
    lone = mcgw.simulate(make_scene(n_surfaces=1, separations=(1.0,)))
    assert "1 separation from" in report_html(lone, read_attributes(file))


def test_numbers_as_people_write_them():
    assert number(6.698e-7) == "6.698×10⁻⁷"
    assert number(1234.4) == "1234"
    assert number(-0.5) == "−0.5"


def test_numbers_of_a_table_have_one_format():
    mean, half = columns([([6361.2, 801.04], 5), ([6.3, 0.12], 2)])
    assert (mean, half) == (["6361.20", "801.04"], ["6.30", "0.12"])
    mean, half = columns([([6361.2, 6.6982e-7, 0.0], 5), ([6.3, 3.6e-10, np.nan], 2)])
    assert [x.rstrip() for x in mean] == ["6.3612×10³", "6.6982×10⁻⁷", "0"]
    assert [x.rstrip() for x in half] == ["6.3×10⁰", "3.6×10⁻¹⁰", ""]
    assert len({len(x) for x in (*mean[:2], "6.6982×10⁻⁷")}) == 1  # as wide, with blanks behind
    assert columns([([0.0, 0.0], 5)]) == [["0", "0"]]
    assert columns([([-2.5, 4.0], 3)]) == [["−2.50", "4.00"]]


@pytest.mark.slow
@pytest.mark.skipif(BROWSER is None, reason="no Chromium here")
def test_in_a_browser(file, page, tmp_path):
    """No error, nothing wider than a phone of 380 px, and it prints."""
    probe = page.replace(
        "</body>",
        "<script>document.title = `${document.documentElement.scrollWidth} ${innerWidth}`</script></body>",
    )
    (tmp_path / "inner.html").write_text(probe, encoding="utf-8")
    frame = (
        "<body><iframe id=f src=inner.html width=380 height=800></iframe><script>onload = () => {"
        "document.body.dataset.width = document.getElementById('f').contentDocument.title}</script></body>"
    )
    (tmp_path / "frame.html").write_text(frame)
    flags = ["--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files"]

    def browse(*words):
        command = [BROWSER, *flags, f"--user-data-dir={tmp_path / 'profile'}", *words]
        return subprocess.run(command, capture_output=True, text=True, timeout=90, check=True, env=os.environ)

    done = browse("--enable-logging=stderr", "--dump-dom", (tmp_path / "frame.html").as_uri())
    wide, inner = map(int, re.search(r'data-width="(\d+) (\d+)"', done.stdout).groups())
    assert wide <= inner <= 380
    assert "CONSOLE" not in done.stderr
    browse(f"--print-to-pdf={tmp_path / 'page.pdf'}", file.with_suffix(".html").as_uri())
    assert (tmp_path / "page.pdf").read_bytes().startswith(b"%PDF")


METAL = {"law": mcgw.KogutEtsion(critical=0.05), "unload_from": "loop", "film": mcgw.Film(1e-7, 1e-14)}


def test_the_contact_law_and_its_rivals_are_in_the_report(file, make_scene):
    """Ratios of the means at h = 1 from physics.md: Chang .0532829, Kogut .0534662, Zhao .0487678; areas."""
    ensemble = mcgw.simulate(
        make_scene(n_surfaces=5, separations=(0.5, 1.0, 2.0), grading=analytic.Homogeneous(), **METAL)
    )
    page = report_html(ensemble, read_attributes(file))
    assert "Every asperity is a contact by KogutEtsion(critical=0.05, poisson=0.3)" in page
    assert "quantities on the way back start from d/σ = 0.5" in page
    assert "film 1e-14 ohm m^2" in page
    rows = dict(re.findall(r"<tr><td>(chang-etsion-bogy|zhao-maietta-chang)</td><td>([^<]+)</td>", page))
    for name, mean in (
        ("chang-etsion-bogy", 0.05328285176044976),
        ("zhao-maietta-chang", 0.04876778006841703),
    ):
        assert float(rows[name]) == pytest.approx(mean / 0.05346624148043353, rel=1e-4)
    share = re.search(r"a share of (\S+) of the contacts has yielded at the lowest separation", page)[1]
    gone = analytic.contacts(ensemble.scene.surface, 0.55) / analytic.contacts(ensemble.scene.surface, 0.5)
    assert float(share) == pytest.approx(float(gone), abs=1e-3)
    assert "every contact is elastic" not in page


def test_hertz_has_no_rivals(page):
    assert "Other contact laws" not in page
    assert "Every asperity is a Hertz contact." in page
    assert "<code>contact.law</code> has laws of asperities that yield" in page


def test_every_kind_of_report_names_the_law(make_scene, tmp_path, capsys):
    (tmp_path / "s.toml").write_text(mcgw.scene_text(make_scene(n_surfaces=20, **METAL)))
    commands = (
        ["run", "s.toml", "-o", "e.h5"],
        ["show", "--plan", "s.toml"],
        ["show", "e.h5"],
        ["compare", "e.h5"],
        ["solve", "s.toml", "--pressure", "100kPa"],
    )
    for command, *words in commands:
        assert main([command, *(str(tmp_path / x) if "." in x else x for x in words)]) == 0
        said = capsys.readouterr()
        assert command == "run" or "KogutEtsion(critical=0.05, poisson=0.3)" in said.out
        assert 'contact.law = "kogut-etsion": the choice of the law' in said.err
    ensemble = mcgw.open_ensemble(tmp_path / "e.h5")
    for shown in (ensemble, ensemble.scene):
        assert "contact law  KogutEtsion(critical=0.05, poisson=0.3)" in repr(shown)
        assert "resistivity 1e-07 ohm m, film 1e-14 ohm m^2" in repr(shown)

"""A report with all its figures drawn: one page, whole in itself, in a browser too."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

import mcgw
from mcgw.cli import main

pytestmark = pytest.mark.site

QUICK = Path(__file__).parents[2] / "runs" / "quick.toml"
BROWSERS = ("chromium", "google-chrome", "chromium-headless-shell")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "quick.h5"
    mcgw.run(mcgw.load_scene(QUICK), path)
    assert main(["report", str(path)]) == 0
    return path.with_suffix(".html").read_text(encoding="utf-8")


def test_page_is_whole_in_itself(page):
    ids = re.findall(r'\bid="([^"]+)"', page)
    assert len(set(ids)) == len(ids) > 10
    assert len(page.encode()) < 3e6
    assert "<script" not in page
    assert not re.search(r"<svg[^>]* (width|height)=", page)  # it takes the width it is given
    assert not re.findall(r'(?:src|href)="(?!#|data:,)', page)
    assert not re.search(r"url\((?!#)", page)
    assert page.count("<svg") == 10  # four against pressure; five quantities and their spread
    assert page.count('role="img" aria-label="') == 10
    assert page.count("Monte Carlo, 95 %") >= 5


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here")
def test_in_a_browser(page, tmp_path):
    """No error, and nothing wider than a phone of 380 px."""
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
    flags += [f"--user-data-dir={tmp_path / 'profile'}", "--enable-logging=stderr", "--dump-dom"]
    command = [BROWSER, *flags, (tmp_path / "frame.html").as_uri()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=90, check=True)
    wide, inner = map(int, re.search(r'data-width="(\d+) (\d+)"', done.stdout).groups())
    assert wide <= inner <= 380
    assert "CONSOLE" not in done.stderr

"""A report with all its figures drawn: one page, whole in itself, in a browser too."""

import os
import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import pytest

import mcgw
from mcgw.cli import main

pytestmark = pytest.mark.site

QUICK = Path(__file__).parents[2] / "runs" / "quick.toml"
BROWSERS = ("chromium", "google-chrome", "chromium-headless-shell")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "quick.h5"
    mcgw.run(mcgw.load_scene(QUICK), path)
    assert main(["report", str(path)]) == 0
    return path.with_suffix(".html")


@pytest.fixture(scope="module")
def page(path):
    return path.read_text(encoding="utf-8")


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
    assert not re.findall(r'(?:src|href)="(?!#|data:,)', page)
    assert not re.search(r"url\((?!#)", page)
    assert page.count("<svg") == 10  # four against pressure; five quantities and their spread
    assert "<img" not in page
    assert page.count('role="img" aria-label="') == 10
    assert page.count("Monte Carlo, 95 %") >= 5


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here")
def test_in_a_browser(path, page, tmp_path):
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
    browse(f"--print-to-pdf={tmp_path / 'page.pdf'}", path.as_uri())
    assert (tmp_path / "page.pdf").read_bytes().startswith(b"%PDF")

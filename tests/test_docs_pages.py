"""The pages of the site: their code runs and says what they say; all are reached, links lead somewhere."""

import doctest
import inspect
import re
import shlex
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from docs_site import DOCS, ROOT, WRITTEN, blocks, file_name, pages

import analytic
import mcgw
from mcgw.cli import COMMANDS, _parser, main

LOOSE = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
LONG = ("figures", "tradeoff")  # a minute each; what they do has tests of its own
WITH_CODE = [name for name in WRITTEN if blocks((DOCS / name).read_text())]


def run_python(code, names, page):
    if ">>>" not in code:
        exec(compile(code, page, "exec"), names)
        return
    test = doctest.DocTestParser().get_doctest(code, names, page, None, 0)
    said = []
    failed, _ = doctest.DocTestRunner(optionflags=LOOSE).run(test, out=said.append, clear_globs=False)
    names.update(test.globs)
    assert not failed, "".join(said)


def run_commands(code, page):
    for line in code.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words[:1] != ["mcgw"]:
            continue
        assert "-o" in words or words[1] in ("show", "solve", "merge"), f"{page}: where does {line} write?"
        _parser().parse_args(words[1:])
        if words[1] not in LONG:
            assert main(words[1:]) == 0, f"{page}: {line}"


@pytest.mark.usefixtures("blank_figures")
@pytest.mark.parametrize("page", WITH_CODE)
def test_code_of_a_page_runs(page, tmp_path, monkeypatch):
    """In its order, in an empty folder; a block whose first line names a file is that file."""
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "page"}
    with np.printoptions():
        for kind, code in blocks((DOCS / page).read_text()):
            if name := file_name(code):
                Path(name).write_text(code.partition("\n")[2] if kind == "text" else code)
            if kind == "python":
                run_python(code, names, page)
            elif kind == "sh":
                run_commands(code, page)
    plt.close("all")


def test_wrong_numbers_of_a_page_would_be_seen():
    with pytest.raises(AssertionError, match="Expected"):
        run_python(">>> 1 + 1\n3\n", {}, "page")
    with pytest.raises(SystemExit):
        run_commands("mcgw run a.toml -o b.h5 --threat 3", "page")


def targets(name, text):
    """Places of the site and of the repository that a page links to."""
    for target in re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", text):
        yield (DOCS / name).parent.joinpath(target).resolve()


@pytest.mark.parametrize("name", list(pages()))
def test_links_lead_somewhere(name):
    there = {(DOCS / page).resolve() for page in pages()}
    for target in targets(name, pages()[name]):
        made = target.parent in (DOCS / "copied" / "api", DOCS / "gallery")  # by Sphinx
        assert made or target in there or target.is_file(), target


def children(name):
    """Pages in the tables of contents of a page."""
    for block in re.findall(r"^```\{toctree\}\n(.*?)^```", pages()[name], flags=re.DOTALL | re.MULTILINE):
        for line in block.splitlines():
            if line and not line.startswith(":"):
                yield (DOCS / name).parent.joinpath(line).resolve().relative_to(DOCS).as_posix() + ".md"


def test_every_page_is_reached_from_the_first():
    seen, ahead = set(), ["index.md"]
    while ahead:
        name = ahead.pop()
        if name not in seen and name != "gallery/index.md":
            seen.add(name)
            ahead += children(name)
    assert seen == {name for name in pages() if name.endswith(".md")}


def test_every_command_and_flag_is_on_its_page():
    page = pages()["copied/commands.md"]
    (commands,) = (x.choices for x in _parser()._actions if hasattr(x, "choices") and x.choices)
    assert set(commands) == set(COMMANDS)
    for name, parser in commands.items():
        part = page.partition(f"## mcgw {name}\n")[2].partition("\n## ")[0]
        for action in parser._actions:
            assert all(flag in part for flag in action.option_strings), (name, action.dest)


def test_every_public_name_is_on_its_page():
    for package in (mcgw, analytic):
        page = pages()[f"copied/{package.__name__}.md"]
        listed = set(re.findall(r"^   (?:~analytic\.)?(\w+)$", page, flags=re.MULTILINE))
        assert listed == set(package.__all__)


def test_what_the_questions_quote_is_said():
    """Each message that the page quotes is one of the program."""
    program = "".join(path.read_text() for path in (ROOT / "mcgw").rglob("*.py"))
    quoted = re.findall(r'^\*\*"(?:\.\.\. )?(.+?)(?: \.\.\.)?"', pages()["faq.md"], flags=re.MULTILINE)
    assert len(quoted) == 2
    for message in quoted:
        assert message.replace("\\", "") in program, message


def test_the_site_is_offered():
    assert "docs/index.md" in (ROOT / "README.md").read_text()
    assert len(WRITTEN) > 25


def test_every_function_of_the_theory_has_an_example():
    """In its own help, or on a page."""
    shown = "".join(code for name in WRITTEN for kind, code in blocks(pages()[name]) if kind == "python")
    for name in analytic.__all__:
        thing = getattr(analytic, name)
        if inspect.isfunction(thing):
            assert f"analytic.{name}(" in shown or ">>> " in thing.__doc__, name

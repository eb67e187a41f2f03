"""Pages that are not written for the site: names and commands by their own help, documents of the repository.

They are written beside the other pages when the site is built, and never by hand; ``.gitignore`` names them.
"""

import io
import os
import re
import runpy
from contextlib import redirect_stdout, suppress
from importlib import import_module
from pathlib import Path

import house
from paper_page import paper_page

ROOT = Path(__file__).parent.parent

# Documents of the repository that are pages of the site: where they lie, and what they are called here.
DOCUMENTS = {
    "CHANGELOG.md": "about/changes",
    "CODE_OF_CONDUCT.md": "about/code-of-conduct",
    "CONTRIBUTING.md": "about/contributing",
    "runs/ACCURACY.md": "explanation/accuracy",
    "runs/ERRATA.md": "explanation/errata-table",
    "runs/EXTREMES.md": "explanation/extremes",
    "runs/INTERACTION.md": "explanation/interaction",
    "runs/LAWS.md": "explanation/contact-laws",
    "runs/ROUGHNESS.md": "explanation/roughness",
    "runs/reliability/README.md": "explanation/reliability",
    "runs/validation/README.md": "explanation/validation",
    "runs/validation/published.md": "explanation/published-numbers",
}
_LINK = re.compile(r"(!?)\[([^\]]+)\]\(([^)#:]+)\)")
PARTS = ("explanation/errata-table", "explanation/errata-proofs", "front")  # no pages: parts of one
WIDTH = "100"  # columns of the help


def pages() -> dict[str, str]:
    """Text of each page, by its place in the site."""
    found = {name: _moved(path) for path, name in DOCUMENTS.items()}
    found |= {"reference/commands": commands_page(), "about/paper": paper_page()}
    found |= {f"reference/{package}": names_page(package) for package in ("mcgw", "analytic")}
    found |= {"explanation/errata-proofs": proofs()}
    found["front"] = front()
    named = {f"{name}.{'txt' if name in PARTS else 'md'}": text for name, text in found.items()}
    return named | {"explanation/house.svg": house.svg()}


def write(folder: Path) -> None:
    """Write them; a page that is as it was keeps its date, so that it is not read again."""
    for name, text in pages().items():
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        if not path.exists() or path.read_text() != text:
            path.write_text(text)


def _moved(path: str) -> str:
    """A document with its links as they are from a folder of the site."""
    folder = (ROOT / path).parent

    def moved(match: re.Match[str]) -> str:
        picture, words, target = match.groups()
        place = (folder / target).resolve().relative_to(ROOT).as_posix()
        if picture:
            return f"![{words}](../../{place})"
        if place.endswith(".csv"):
            return f"{{download}}`{words} <../../{place}>`"
        return f"[{words}](../{DOCUMENTS[place]}.md)" if place in DOCUMENTS else f"{words} (`{place}`)"

    return _LINK.sub(moved, (ROOT / path).read_text())


def front() -> str:
    """The README down to its table, as the first page of the site."""

    def moved(match: re.Match[str]) -> str:
        picture, words, target = match.groups()
        page = f"{DOCUMENTS[target]}.md" if target in DOCUMENTS else target.removeprefix("docs/")
        return f"{picture}[{words}]({f'../{target}' if picture else page.replace('errata-table', 'errata')})"

    return _LINK.sub(moved, (ROOT / "README.md").read_text().partition("## On the command line")[0])


def names_page(package: str) -> str:
    """What a package says of itself, and every public name, with its own page or that of the theory."""
    module = import_module(package)
    names = sorted(getattr(module, "__all__", dir(module)), key=str.casefold)
    shared = [x for x in names if package == "mcgw" and getattr(module, x).__module__.startswith("analytic.")]
    own = [name for name in names if name not in shared]
    page = f"# `{package}`, name by name\n\n{_rst(f'.. automodule:: {package}', '   :no-members:')}"
    page += f"## All names\n\n{_summary(own, '   :toctree: api')}"
    if shared:
        page += f"## Names that are those of `analytic`\n\n{_summary([f'~analytic.{x}' for x in shared])}"
    return page


def _summary(names: list[str], *options: str) -> str:
    return _rst(".. autosummary::", *options, "   :nosignatures:", "", *(f"   {name}" for name in names))


def _rst(*lines: str) -> str:
    return "\n".join(("```{eval-rst}", *lines, "```", "", ""))


def commands_page() -> str:
    """Every command by its own help, in the order of ``mcgw --help``."""
    parts = [
        "# Commands\n\n`mcgw COMMAND --help` prints what stands here. Every command says where its file is,"
        " and writes nowhere else. Exit codes: 0 done, 1 a comparison or a run failed, 2 bad input, 130"
        " interrupted by Ctrl-C.\n"
    ]
    parts += [f"## mcgw {name}\n\n```text\n{said}```\n" for name, said in helps().items()]
    return "\n".join(parts)


def helps() -> dict[str, str]:
    """The help of every command."""
    from mcgw.cli import COMMANDS, main

    before, os.environ["COLUMNS"] = os.environ.get("COLUMNS"), WIDTH
    try:
        return {name: _said(main, [name, "--help"]) for name in COMMANDS}
    finally:
        os.environ.pop("COLUMNS") if before is None else os.environ.update(COLUMNS=before)


def _said(main, words) -> str:  # type: ignore[no-untyped-def]
    with redirect_stdout(io.StringIO()) as said, suppress(SystemExit):
        main(words)
    return said.getvalue()


def proofs() -> str:
    """What ``python runs/errata.py`` prints."""
    return _said(lambda _: runpy.run_path(str(ROOT / "runs" / "errata.py"), run_name="__main__"), [])

"""The draft paper as a page of the site: pandoc's citations and figures in Markdown that Sphinx reads."""

import re
from pathlib import Path

FOLDER = Path(__file__).parent / "paper"

Entry = dict[str, str]
_ACCENTS = {'"': "\N{COMBINING DIAERESIS}", "'": "\N{COMBINING ACUTE ACCENT}"}


def paper_page() -> str:
    """All of it, with a list of references at its end."""
    _, front, text = (FOLDER / "paper.md").read_text(encoding="utf-8").split("---\n", 2)
    entries = bibliography()
    title, date = (
        re.findall(rf"^{key}: '?(.+?)'?$", front, flags=re.MULTILINE)[0] for key in ("title", "date")
    )
    text = re.sub(r"^# ", "## ", text, flags=re.MULTILINE)
    text = re.sub(r"\[(@[^\]]+)\]", lambda m: cited(m[1], entries), figures(text))
    head = f"# {title}\n\n*A draft in the form of the Journal of Open Source Software; {date}.*\n"
    return f"{head}{text}\n" + "".join(f"- {reference(entry)}\n" for entry in _in_order(entries))


def bibliography() -> dict[str, Entry]:
    """Entries by their keys: of each the fields, one a line."""
    text = (FOLDER / "paper.bib").read_text(encoding="utf-8")
    found = re.findall(r"^@\w+\{(\w+),\n(.*?)^\}", text, flags=re.DOTALL | re.MULTILINE)
    return {key: dict(re.findall(r"^ +(\w+) = \{(.*)\},$", body, flags=re.MULTILINE)) for key, body in found}


def cited(keys: str, entries: dict[str, Entry]) -> str:
    """What stands in the text for ``@a; @b``."""
    each = (entries[key.strip().removeprefix("@")] for key in keys.split(";"))
    return "(" + ", ".join(f"{_short(entry)} {entry['year']}" for entry in each) + ")"


def reference(entry: Entry) -> str:
    """A line of the list."""
    place = ", ".join(entry[key] for key in ("journal", "booktitle", "volume", "pages") if key in entry)
    said = f"{', '.join(_authors(entry))}: {_plain(entry['title'])}. {_plain(place)} ({entry['year']})."
    return f"{said} *Checked: {entry['checked']}.*"


def _in_order(entries: dict[str, Entry]) -> list[Entry]:
    return sorted(entries.values(), key=lambda entry: (_plain(entry["author"]).casefold(), entry["year"]))


def _short(entry: Entry) -> str:
    """Family names: two at most."""
    names = [name.partition(",")[0] for name in _authors(entry)]
    return " and ".join(names) if len(names) < 3 else f"{names[0]} et al."


def _authors(entry: Entry) -> list[str]:
    return [name.replace("others", "et al.") for name in _plain(entry["author"]).split(" and ")]


def _plain(text: str) -> str:
    """TeX's accents, quotes, dashes and braces as characters."""
    text = re.sub(r"\{\\(.)(\w)\}", lambda m: m[2] + _ACCENTS[m[1]], text)
    text = text.replace("``", "\N{LEFT DOUBLE QUOTATION MARK}").replace(
        "''", "\N{RIGHT DOUBLE QUOTATION MARK}"
    )
    return re.sub(r"[{}]", "", text).replace("--", "\N{EN DASH}")


def figures(text: str) -> str:
    """Pictures with their captions below, and their numbers where they are referred to."""
    labels = re.findall(r"\\label\{(fig:\w+)\}\]", text)
    for k, label in enumerate(labels, 1):
        text = text.replace(f"\\autoref{{{label}}}", f"Figure {k}")
        picture = re.compile(rf"!\[([^\]]*?)\\label\{{{label}\}}\]\((.*?)\)")
        text = picture.sub(lambda m, k=k: f"![{m[1]}]({m[2]})\n\n*Figure {k}. {m[1]}*", text)
    return text

"""What an object shows of itself: a dozen lines in a terminal, a table in a notebook."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape

from mcgw.formats.table import Table
from mcgw.machine.terminal import one_line

Facts = Sequence[tuple[str, str]]
_LONGEST = 88  # characters of one fact


def brief(text: str) -> str:
    """A text on one line, with dots in place of its end if it is longer than 88 characters."""
    plain = one_line(text)
    return plain if len(plain) <= _LONGEST else f"{plain[: _LONGEST - 3]}..."


def listed(facts: Iterable[tuple[str, str]], width: int = 0) -> Iterator[str]:
    """Lines of names and texts, the texts under each other; names take `width` characters or more."""
    facts = list(facts)
    width = max([width, *(len(name) for name, _ in facts)])
    return (f"  {name:{width}}  {text}" for name, text in facts)


@dataclass(frozen=True)
class Sheet:
    """A title, facts by name, and a table.

    Parameters
    ----------
    title : str
        What it is.
    facts : sequence of (str, str), optional
        Name and text.
    table : Table, optional
        Below them.
    """

    title: str
    facts: Facts = ()
    table: Table | None = None

    def text(self) -> str:
        """Plain lines, the columns under each other."""
        facts = listed((name, brief(text)) for name, text in self.facts)
        return "\n".join([brief(self.title), *facts, *([] if self.table is None else [self.table.text()])])

    def html(self) -> str:
        """The same as HTML; nothing in it is a tag but what stands here."""
        cells = "<tr><th>{}</th><td>{}</td></tr>".format
        facts = "".join(cells(escape(name), escape(brief(text))) for name, text in self.facts)
        facts = f"<table>{facts}</table>" if facts else ""
        return f"<b>{escape(brief(self.title))}</b>{facts}{'' if self.table is None else self.table.html()}"


class Shown:
    """Shows a sheet of itself."""

    def sheet(self) -> Sheet:
        """What is shown, at most a dozen lines."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return self.sheet().text()

    def _repr_html_(self) -> str:
        return self.sheet().html()

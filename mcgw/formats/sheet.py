"""Display of an object: a dozen lines in a terminal, a table in a notebook."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape

from mcgw.formats.table import Table
from mcgw.machine.terminal import one_line

Facts = Sequence[tuple[str, str]]
_LONGEST = 88  # characters of one fact


def brief(text: str) -> str:
    """Shorten a text to one line of at most 88 characters, with dots at its end."""
    plain = one_line(text)
    return plain if len(plain) <= _LONGEST else f"{plain[: _LONGEST - 3]}..."


def listed(facts: Iterable[tuple[str, str]], width: int = 0) -> Iterator[str]:
    """Lines of names and aligned texts; names take at least `width` characters."""
    facts = list(facts)
    width = max([width, *(len(name) for name, _ in facts)])
    return (f"  {name:{width}}  {text}" for name, text in facts)


@dataclass(frozen=True)
class Sheet:
    """A title, facts by name, and a table.

    Parameters
    ----------
    title : str
        Its title.
    facts : sequence of (str, str), optional
        Name and text.
    table : Table, optional
        Below them.
    """

    title: str
    facts: Facts = ()
    table: Table | None = None

    def text(self) -> str:
        """Plain text with aligned columns."""
        facts = listed((name, brief(text)) for name, text in self.facts)
        return "\n".join([brief(self.title), *facts, *([] if self.table is None else [self.table.text()])])

    def html(self) -> str:
        """Return the same as HTML, with all texts escaped."""
        cells = "<tr><th>{}</th><td>{}</td></tr>".format
        facts = "".join(cells(escape(name), escape(brief(text))) for name, text in self.facts)
        facts = f"<table>{facts}</table>" if facts else ""
        return f"<b>{escape(brief(self.title))}</b>{facts}{'' if self.table is None else self.table.html()}"


class Shown:
    """Displays itself as a sheet."""

    def sheet(self) -> Sheet:
        """Return the sheet to show, at most a dozen lines."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return self.sheet().text()

    def _repr_html_(self) -> str:
        return self.sheet().html()

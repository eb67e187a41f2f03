"""What an object shows of itself: a dozen lines in a terminal, a table in a notebook."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape

from mcgw.machine.terminal import one_line

__all__ = ["Sheet", "Shown", "brief"]

_LONGEST = 88  # characters of one fact


def brief(text: str) -> str:
    """A text on one line, with dots in the place of its end if it is longer than 88 characters."""
    plain = one_line(text)
    return plain if len(plain) <= _LONGEST else f"{plain[: _LONGEST - 3]}..."


@dataclass(frozen=True)
class Sheet:
    """A title, facts by name, and a table.

    Parameters
    ----------
    title : str
        What it is.
    facts : sequence of (str, str), optional
        Name and text.
    header : sequence of str, optional
        Of the table's columns, the first one to the left, numbers to the right.
    rows : sequence of sequence of str, optional
        Of the table.
    """

    title: str
    facts: Sequence[tuple[str, str]] = ()
    header: Sequence[str] = ()
    rows: Sequence[Sequence[str]] = ()

    def text(self) -> str:
        """Plain lines, the columns under each other."""
        return "\n".join([brief(self.title), *self._facts(), *self._table()])

    def html(self) -> str:
        """The same as HTML; nothing in it is a tag but what stands here."""
        facts = "".join(f"<tr><th>{escape(name)}</th>{_cell(brief(text))}</tr>" for name, text in self.facts)
        head = "".join(f"<th>{escape(name)}</th>" for name in self.header)
        rows = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in self.rows)
        table = f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>" if head else ""
        return f"<b>{escape(brief(self.title))}</b>{f'<table>{facts}</table>' if facts else ''}{table}"

    def _facts(self) -> Iterator[str]:
        width = max((len(name) for name, _ in self.facts), default=0)
        for name, text in self.facts:
            yield f"  {name:{width}}  {brief(text)}"

    def _table(self) -> Iterator[str]:
        lines = [self.header, *self.rows] if self.header else []
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        for first, *others in lines:
            cells = (f"{cell:>{width}}" for cell, width in zip(others, widths[1:], strict=True))
            yield "  ".join([f"  {first:{widths[0]}}", *cells])


def _cell(text: str) -> str:
    return f"<td>{escape(text)}</td>"


class Shown:
    """Shows a sheet of itself."""

    def sheet(self) -> Sheet:
        """What is shown, at most a dozen lines."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return self.sheet().text()

    def _repr_html_(self) -> str:
        return self.sheet().html()

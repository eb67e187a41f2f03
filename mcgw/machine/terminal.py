"""Output: text that cannot control a terminal, streams that may be closed or full; and who draws results.

Readers do not affect the work: text that a stream refuses is lost, and its error is kept.
"""

import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from typing import Any

# Draws a result, as ``draw(result, ax, **options)``: figures lie above the results that they draw, so these
# cannot import them, and `mcgw` itself puts it here.
drawers: list[Callable[..., Any]] = []
_LONGEST = 88  # characters of one fact
_SHORT = {"\n": "\\n", "\r": "\\r", "\t": "\\t"}


def one_line(text: str) -> str:
    r"""Escape every character that is not printable.

    >>> one_line("red \x1b[31m\nE*")
    'red \\u001b[31m\\nE*'
    """
    if text.isprintable():
        return text
    codes = ((c, f"\\u{ord(c):04x}" if ord(c) < 2**16 else f"\\U{ord(c):08x}") for c in text)
    return "".join(c if c.isprintable() else _SHORT.get(c, code) for c, code in codes)


def plain_text(text: str) -> str:
    """Escape each line as `one_line` does; TOML stays TOML."""
    return "\n".join(map(one_line, text.split("\n")))


def brief(text: str) -> str:
    """Shorten a text to one line of at most 88 characters, with dots at its end."""
    plain = one_line(text)
    return plain if len(plain) <= _LONGEST else f"{plain[: _LONGEST - 3]}..."


def listed(facts: Iterable[tuple[str, str]], width: int = 0) -> Iterator[str]:
    """Lines of names and aligned texts; names take at least `width` characters."""
    facts = list(facts)
    width = max([width, *(len(name) for name, _ in facts)])
    return (f"  {name:{width}}  {text}" for name, text in facts)


class Plain:
    """A stream that passes on printable characters and line ends, and never fails.

    `lost` is the first error of the stream below; later text is lost too.
    """

    lost: OSError | None = None

    def __init__(self, stream: Any, name: str, ends: str) -> None:
        self._stream, self._name, self._ends = stream, name, ends
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")  # not every terminal has an eta

    def write(self, text: str) -> int:
        """Write a text, escaping what is not printable."""
        shown = re.sub(f"[^{self._ends}]+", lambda line: one_line(line[0]), text)
        with self._unfailing():
            self._stream.write(shown)
        return len(text)

    def flush(self) -> None:
        """Flush the stream below."""
        with self._unfailing():
            self._stream.flush()

    @contextmanager
    def _unfailing(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            error.filename, self.lost = self._name, self.lost or error
            with suppress(OSError, ValueError), open(os.devnull, "wb") as nowhere:
                os.dup2(nowhere.fileno(), self._stream.fileno())  # its buffer would fail again

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextmanager
def plain_output() -> Iterator[Plain]:
    """Let only text reach the terminal, and replace closed streams by an empty one.

    Yields the new standard output.
    """
    with open(os.devnull, "w") as nowhere:
        output = Plain(sys.stdout or nowhere, "standard output", "\n")
        errors = Plain(sys.stderr or nowhere, "standard error", "\n\r")
        with redirect_stdout(output), redirect_stderr(errors):
            try:
                yield output
            finally:
                output.flush()
                errors.flush()

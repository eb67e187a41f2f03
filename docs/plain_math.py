"""Equations as MathML, which browsers show without a script and without a net."""

import re
from html import escape
from typing import Any

from latex2mathml.converter import convert

_TAG = re.compile(r"\\tag\{([^}]*)\}")


def inline(visitor: Any, node: Any) -> None:
    """Write an equation within a line."""
    visitor.body.append(convert(node.astext()))
    _skip()


def block(visitor: Any, node: Any) -> None:
    r"""Write equations of their own, each with the number that its ``\tag`` gives."""
    for one in re.split(r"\n\s*\n", node.astext().strip()):
        number = "".join(_TAG.findall(one))
        said = f"<span>({escape(number)})</span>" if number else ""
        visitor.body.append(
            f'<div class="equation">{convert(_TAG.sub("", one), display="block")}{said}</div>\n'
        )
    _skip()


def _skip() -> None:
    from docutils import nodes

    raise nodes.SkipNode


def setup(app: Any) -> dict[str, bool]:
    """Offer it to Sphinx as a renderer."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}

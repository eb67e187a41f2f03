"""What is said beside the numbers of a model: whether theory was tested, how far elasticity is."""

from html import escape

from mcgw.scene.validity import Validity

__all__ = ["against_elasticity", "elasticity_section", "two_questions"]


def two_questions(found: Validity, file: object = "FILE.h5") -> list[str]:
    """Where nothing was compared: how to, and the verdict against elasticity."""
    return [
        f"Whether Monte Carlo and theory of this model agree: mcgw compare {file}",
        *against_elasticity(found),
    ]


def against_elasticity(found: Validity) -> list[str]:
    """The verdict, and where it was measured, a line each."""
    return [found.verdict, *([f"  {found.details}"] if found.details else [])]


def elasticity_section(found: Validity) -> str:
    """The same as HTML, with a table over the separations."""
    sheet = found.sheet()
    head = "".join(f"<th>{escape(name)}</th>" for name in sheet.header)
    body = "".join(f"<tr>{''.join(f'<td>{escape(x)}</td>' for x in row)}</tr>" for row in sheet.rows)
    table = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>\n" if body else ""
    words = (
        "<p>Model over elasticity, less 1: mean over the maps ± scatter, that of surfaces with so many "
        "contacts, or twice the standard error of the mean. Area, stiffness and gap are those at the load of "
        "that separation; the load is that at the separation itself, taken for the mean gap of a periodic "
        f"cell. Pressure: {escape(found.axis)}.</p>\n"
    )
    known = f"{escape(found.details)}.</p>\n{words}{table}" if table else f"{escape(found.verdict)}.</p>\n"
    return f"<h2>Against elasticity</h2>\n<p>{known[0].upper()}{known[1:]}"

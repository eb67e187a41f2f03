"""What is said beside the numbers of a model: whether theory was tested, how far elasticity is."""

from mcgw.scene.validity import Validity

__all__ = ["against_elasticity", "elasticity_words", "two_questions"]


def two_questions(found: Validity, file: object = "FILE.h5") -> list[str]:
    """Where nothing was compared: how to, and the verdict against elasticity."""
    return [
        f"Whether Monte Carlo and theory of this model agree: mcgw compare {file}",
        *against_elasticity(found),
    ]


def against_elasticity(found: Validity) -> list[str]:
    """The verdict, and where it was measured, a line each."""
    return [found.verdict, *([f"  {found.details}"] if found.details else [])]


def elasticity_words(found: Validity) -> list[str]:
    """The same in paragraphs of a page; the second one tells of a table over the separations."""
    if not found.measured.any():
        return [f"{found.verdict}."]
    details = f"{found.details}."
    return [
        f"{details[0].upper()}{details[1:]}",
        "Model over elasticity, less 1: mean over the maps ± what holds 95 % of surfaces with so many "
        "contacts and long waves. Area, stiffness and gap are those at the load of that separation; the load "
        "is that at the separation itself, taken for the mean gap of a periodic cell. Pressure: "
        f"{found.axis}.",
    ]

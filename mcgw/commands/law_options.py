"""The options ``--law``, ``--critical``, ``--hardness``, ...: a contact law and its constants."""

import argparse
from contextlib import suppress
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from analytic.laws import ContactLaw

__all__ = ["add_law_options", "law_of"]

_CONSTANTS = {
    "critical": ("X", "penetration over sigma at which asperities yield"),
    "hardness": ("H", "of the softer body, as 1.2GPa"),
    "yield-strength": ("SY", "of the softer body, as 400MPa (jackson-green)"),
    "poisson": ("NU", "Poisson's ratio"),
    "bridge": ("hermite", "join fits that jump"),
    "k": ("K", "exponent of the depth (power-law-graded)"),
    "c0": ("DEPTH", "depth of the modulus E*, as 1um (power-law-graded)"),
    "thickness": ("T", "of the coating, as 0.5um (coated)"),
    "ratio": ("R", "modulus of the coating over that of the substrate (coated)"),
    "work": ("W", "of adhesion, J/m^2 (the laws that stick)"),
    "pull-off": ("D", "stretch over sigma at which contacts break off (the laws that stick)"),
}


def add_law_options(parser: argparse.ArgumentParser) -> None:
    """A group of options; the values are checked as those of a scene file."""
    group = parser.add_argument_group("another contact law, and its constants as in a scene file")
    group.add_argument("--law", metavar="LAW", help="its name, as kogut-etsion; a wrong one gets the list")
    for name, (metavar, what) in _CONSTANTS.items():
        group.add_argument(f"--{name}", metavar=metavar, help=what)


def law_of(args: argparse.Namespace) -> "ContactLaw | None":
    """The law that was asked for, or None.

    Raises
    ------
    ValueError
        If a constant is given without a law.
    SceneError
        If a value is wrong; the line names the key.
    """
    from mcgw.scene.law_section import read_law

    given = {key: getattr(args, key) for key in (name.replace("-", "_") for name in _CONSTANTS)}
    constants = {key: _plain(value) for key, value in given.items() if value is not None}
    if args.law is None:
        if constants:
            key = next(iter(constants)).replace("_", "-")
            raise ValueError(f"--{key}: is a constant of a contact law; give --law too")
        return None
    return read_law({"law": args.law, **constants})


def _plain(text: str) -> Any:
    """A number where it is one; else the text, with its unit."""
    with suppress(ValueError):
        return float(text)
    return text

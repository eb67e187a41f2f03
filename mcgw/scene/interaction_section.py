"""How the asperities of a scene press each other down: the table [interaction]."""

from typing import Any

from analytic import Interaction
from mcgw.scene.section import Section

__all__ = ["interaction_argument", "interaction_table", "interaction_values"]


_REFERENCES = ("body", "mean-plane")


def interaction_values(section: Section) -> Interaction | None:
    """Read the table; mistakes are noted in the section, and give None."""
    before = len(section.problems)
    if "reference" not in section:
        advice = 'give "body", the undeformed body far away, or "mean-plane", the mean of the deformed plane'
        section.problems.append(f"interaction.reference: missing; {advice}")
    reference = section.choice("reference", _REFERENCES[0], _REFERENCES)
    at = section.choice("at", "effective", ("effective", "nominal"))
    modulus = section.number("bulk_modulus", unit="Pa") if "bulk_modulus" in section else None
    section.known("bulk_modulus")
    section.finish()
    if len(section.problems) > before:
        return None
    return Interaction(reference, at=at, bulk_modulus=modulus)  # type: ignore[arg-type]  # checked above


def interaction_argument(given: Any, problems: list[str]) -> Interaction | None:
    """Read what Python gives: an `Interaction`, its reference alone, or its keys in a scene file."""
    if isinstance(given, Interaction):
        return given
    table = {"reference": given} if isinstance(given, str) else given
    if not isinstance(table, dict):
        advice = 'give mcgw.Interaction("body"), or mcgw.Interaction("mean-plane")'
        Section("", {}, problems).fail("interaction", given, advice)
        return None
    return interaction_values(Section("interaction", table, problems))


def interaction_table(interaction: Interaction) -> dict[str, Any]:
    """The table that gives it back."""
    modulus = {} if interaction.bulk_modulus is None else {"bulk_modulus": float(interaction.bulk_modulus)}
    return {"reference": interaction.reference, "at": interaction.at, **modulus}

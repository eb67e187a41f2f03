"""What a report says of its surface, its run and its law, as pairs of texts."""

from typing import Any

from mcgw.ensemble.ensemble import Ensemble
from mcgw.figures.style import grading_label
from mcgw.formats.numbers import number
from mcgw.reports.laws_section import contacts_sentence
from mcgw.scene.contact_text import contact_facts

__all__ = ["opening_words", "provenance_facts", "surface_facts"]

Facts = list[tuple[str, str]]


def opening_words(ensemble: Ensemble) -> str:
    """What was drawn, in two sentences."""
    scene = ensemble.scene
    count = "" if scene.count == "fixed" else " on average (a Poisson number)"
    separations = f"{len(scene.separations)} separation{'s' * (len(scene.separations) > 1)}"
    return (
        f"{ensemble.n_surfaces} rough surfaces of {scene.n_asperities:g} asperities{count}, "
        f"{grading_label(scene.grading)}, each pressed on a plane at {separations} from d/σ = "
        f"{min(scene.separations):g} to {max(scene.separations):g}. {contacts_sentence(scene)}"
    )


def surface_facts(ensemble: Ensemble) -> Facts:
    """Parameters in SI, and the same in units of sigma."""
    scene, x = ensemble.scene, ensemble.scene.surface
    contacts = float(scene.theory.mean("contacts", scene.lowest))
    return [
        ("standard deviation σ of the summit heights", f"{number(x.sigma)} m"),
        ("summit radius R", f"{number(x.radius)} m = {number(x.radius / x.sigma)} σ"),
        ("summits per area η", f"{number(x.eta)} m⁻²; ηRσ = {number(x.eta * x.radius * x.sigma)}"),
        (
            "nominal area Aₙ",
            f"{number(x.nominal_area)} m² = {number(x.nominal_area / x.sigma**2)} σ²",
        ),
        ("composite modulus E*", f"{number(x.E_star)} Pa"),
        ("grading E*(s)/E*", grading_label(scene.grading)),
        *contact_facts(scene),
        ("contacts expected at the lowest separation", number(contacts)),
    ]


def provenance_facts(attributes: dict[str, Any], seed: int) -> Facts:
    """Of the file; of a run that goes on, what is known."""
    known = {"seed": seed} | attributes
    keys = ("digest", "seed", "sampler", "date", "versions", "commit", "cpu")
    return [(key, str(known[key])) for key in keys]

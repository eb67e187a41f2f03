"""What a report says of the contact law: which it is, and what other laws would give."""

from dataclasses import dataclass

from analytic import Hertz
from mcgw.reports.numbers import columns
from mcgw.scene.law_text import law_text
from mcgw.scene.other_laws import other_laws
from mcgw.scene.scene import Scene

__all__ = ["LawsTable", "contacts_sentence", "laws_table"]


@dataclass(frozen=True)
class LawsTable:
    """Other laws beside that of a scene: words above, and rows of a law's name, load and area."""

    words: str
    rows: tuple[tuple[str, str, str], ...]


def laws_table(scene: Scene) -> LawsTable | None:
    """Other laws beside that of a scene; None where nothing yields."""
    others = other_laws(scene)
    if others is None:
        return None
    low, high = others.spread
    names = [f"{scene.law.name} (this one)", *others.load]
    loads, areas = columns(
        [([1.0, *others.load.values()], 4), ([1.0, *(others.area[name] for name in others.load)], 4)]
    )
    words = (
        f"Means at d/σ = {others.separation:g} by theory, over those of this report, for the same critical "
        f"penetration of {others.critical:.4g} σ. Among the laws of asperities that yield the choice is "
        f"worth {high / low - 1:.0%} of the load."
    )
    return LawsTable(words, tuple(zip(names, loads, areas, strict=True)))


def contacts_sentence(scene: Scene) -> str:
    """What law holds, and what else is done with the surfaces."""
    if type(scene.law) is Hertz:
        words = "Every asperity is a Hertz contact"
    else:
        words = f"Every asperity is a contact by {law_text(scene.law)}"
    if scene.unload_from is not None:
        words += f"; quantities on the way back start from d/σ = {scene.unload_from:g}"
    return f"{words}."

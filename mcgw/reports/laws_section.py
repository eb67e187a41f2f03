"""What a report says of the contact law: which it is, and what other laws would give."""

from analytic import Hertz
from mcgw.formats.table import Column, Table
from mcgw.scene.law_text import law_text
from mcgw.scene.other_laws import other_laws
from mcgw.scene.scene import Scene

__all__ = ["contacts_sentence", "laws_table"]


def laws_table(scene: Scene) -> Table | None:
    """Other laws beside that of a scene, under what its numbers mean; None where nothing yields."""
    others = other_laws(scene)
    if others is None:
        return None
    low, high = others.spread
    names = [f"{scene.law.name} (this one)", *others.load]
    words = (
        f"Means at d/σ = {others.separation:g} by theory, over those of this report, for the same critical "
        f"penetration of {others.critical:.4g} σ. Among the laws of asperities that yield the choice is "
        f"worth {high / low - 1:.0%} of the load."
    )
    load, area = ([1.0, *(each[name] for name in others.load)] for each in (others.load, others.area))
    numbers = (Column(name, x, unit="1", form=".4g") for name, x in (("load", load), ("area", area)))
    return Table((Column("law", names, "contact law"), *numbers), words)


def contacts_sentence(scene: Scene) -> str:
    """What law holds, and what else is done with the surfaces."""
    if type(scene.law) is Hertz:
        words = "Every asperity is a Hertz contact"
    else:
        words = f"Every asperity is a contact by {law_text(scene.law)}"
    if scene.unload_from is not None:
        words += f"; quantities on the way back start from d/σ = {scene.unload_from:g}"
    return f"{words}."

"""What a report says of the contact law: which it is, and what other laws would give."""

from html import escape

from analytic import Hertz
from mcgw.scene.law_text import law_text
from mcgw.scene.other_laws import other_laws
from mcgw.scene.scene import Scene

__all__ = ["contacts_sentence", "laws_section", "yielding_item"]


def laws_section(scene: Scene) -> str:
    """A table of other laws beside that of a scene, as HTML; empty where nothing yields."""
    others = other_laws(scene)
    if others is None:
        return ""
    low, high = others.spread
    rows = [(f"{scene.law.name} (this one)", 1.0, 1.0)]
    rows += [(name, others.load[name], others.area[name]) for name in others.load]
    body = "".join(
        f"<tr><td>{escape(name)}</td><td>{load:.4g}</td><td>{area:.4g}</td></tr>" for name, load, area in rows
    )
    return (
        "<h2>Other contact laws</h2>\n"
        f"<p>Means at d/σ = {others.separation:g} by theory, over those of this report, for the same "
        f"critical penetration of {others.critical:.4g} σ. Among the laws of asperities that yield the "
        f"choice is worth {high / low - 1:.0%} of the load.</p>\n"
        "<table><thead><tr><th>contact law</th><th>load</th><th>area</th></tr></thead>"
        f"<tbody>{body}</tbody></table>\n"
    )


def contacts_sentence(scene: Scene) -> str:
    """What law holds, and what else is done with the surfaces."""
    if type(scene.law) is Hertz:
        words = "Every asperity is a Hertz contact"
    else:
        words = f"Every asperity is a contact by {escape(law_text(scene.law))}"
    if scene.unload_from is not None:
        words += f"; quantities on the way back start from d/σ = {scene.unload_from:g}"
    return f"{words}."


def yielding_item(scene: Scene) -> str:
    """What to check where contacts stay elastic; who yields is one of the cautions."""
    if not scene.law.elastic:
        return ""
    return (
        "<li>every contact is elastic: with the hardness H and slope of the material at hand, check the "
        "plasticity index (analytic.plasticity_index) before using loads at small separations; "
        "<code>contact.law</code> has laws of asperities that yield</li>"
    )

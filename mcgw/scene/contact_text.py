"""What a scene says of its contacts besides separations: law, way back, film, sliding; in words."""

from analytic import Hertz
from mcgw.scene.fields import Fields
from mcgw.scene.law_text import law_text

__all__ = ["accuracy_facts", "contact_facts"]

_PLANES = {"body": "undeformed body", "mean-plane": "mean deformed plane"}


def contact_facts(scene: Fields) -> list[tuple[str, str]]:
    """A word and what holds, only for what is not Hertz's contact pressed once; for reports of any kind."""
    facts = []
    if type(scene.law) is not Hertz:
        facts.append(("contact law", law_text(scene.law)))
    if scene.unload_from is not None:
        facts.append(("way back", f"from d/sigma = {scene.unload_from:g}"))
    if scene.film is not None:
        film = f", film {scene.film.film_resistance:g} ohm m^2" if scene.film.film_resistance else ""
        facts.append(("film", f"resistivity {scene.film.resistivity:g} ohm m{film}"))
    if scene.tangential is not None:
        pushed = scene.tangential
        facts.append(
            (
                "sideways",
                f"friction {pushed.friction:g}, Poisson's ratio {pushed.poisson:g}, "
                f"u up to {max(pushed.displacements):g} m",
            )
        )
    if scene.interaction is not None:
        felt = "as nominal ones" if scene.interaction.nominal else "as asperities feel them"
        facts.append(("interaction", f"from the {_PLANES[scene.interaction.reference]}, separations {felt}"))
    return facts


def accuracy_facts(scene: Fields) -> list[tuple[str, str]]:
    """A word and what holds, only for what is not exact; for reports of any kind."""
    facts = []
    if not scene.exact:
        facts.append(("accuracy", f"{scene.accuracy:g} of every value of a surface"))
    if scene.law_error:
        facts.append(("law_error", f"up to {scene.law_error:g} from the exact laws"))
    return facts

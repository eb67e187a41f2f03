"""A scene in words: its laws with their numbers, and what differs from Hertz and exact values."""

from collections.abc import Mapping

from analytic import Hertz
from analytic.laws import Film
from mcgw.formats.law_text import law_text
from mcgw.formats.table import Table
from mcgw.machine.terminal import brief
from mcgw.scene.fields import Fields
from mcgw.scene.keys import SURFACE_UNITS

_PLANES = {"body": "undeformed body", "mean-plane": "mean deformed plane"}


def conducting_text(film: Film) -> str:
    """Conductivities or resistivities of the spots, as given."""
    if film.conductivities is None:
        held, unit = f"resistivity {film.resistivity:g} ohm m", "ohm m^2"
    else:
        held, unit = "{:g} and {:g} W/(m K)".format(*film.conductivities), "m^2 K/W"
    thin = f", film {film.film_resistance:g} {unit}" if film.film_resistance else ""
    layer = f", layer {film.layer.thickness:g} m of {film.layer.conductivity:g} W/(m K)" if film.layer else ""
    return f"{held}{thin}{layer}"


def contact_facts(scene: Fields) -> list[tuple[str, str]]:
    """Facts, by name, that differ from Hertz's contact pressed once."""
    facts = []
    if type(scene.law) is not Hertz:
        facts.append(("contact law", law_text(scene.law)))
    if scene.unload_from is not None:
        facts.append(("unloading", f"from d/sigma = {scene.unload_from:g}"))
    if scene.film is not None:
        facts.append(("bodies", conducting_text(scene.film)))
    if scene.interaction is not None:
        plane = _PLANES[scene.interaction.reference]
        facts.append(("interaction", f"from the {plane}, separations effective"))
    if scene.thermal:
        facts.append(("joint", joint_text(scene)))
    return facts


def joint_text(scene: Fields) -> str:
    """Return what fills the gap; by default nothing: spots only, as in vacuum."""
    if scene.gas is None or scene.filled is None or (gas := scene.filled.gas) is None:
        return "spots only (vacuum)"
    name = scene.gas.gas if isinstance(scene.gas.gas, str) else "gas"
    return (
        f"{name}, {gas.conductivity:.4g} W/(m K), temperature-jump distance {gas.jump:.3g} m; "
        f"combined rms roughness {scene.filled.rms:.4g} m"
    )


def accuracy_facts(scene: Fields) -> list[tuple[str, str]]:
    """Facts, by name, about laws that are not exact."""
    return [("accuracy", f"up to {scene.accuracy:g} from the exact laws")] if scene.accuracy else []


def sheet_of(scene: Fields) -> Table:
    """Display of a scene, at most a dozen lines."""
    x = {key: f"{key} = {getattr(scene.surface, key):g} {unit}" for key, unit in SURFACE_UNITS.items()}
    h, among = scene.separations, f"{len(scene.separations)} from " if len(scene.separations) > 1 else ""
    ends = " to ".join(f"{end:g}" for end in sorted({min(h), max(h)}))
    stop = "" if scene.rel_err is None else f"until rel_err = {_wish(scene.rel_err)}, at most "
    facts = [
        ("surface", ", ".join((x["sigma"], x["radius"], x["eta"]))),
        ("", f"{x['nominal_area']}, {x['E_star']}"),
        ("grading", law_text(scene.grading) + ("" if scene.negative == "error" else f", {scene.negative}")),
        ("heights", law_text(scene.heights)),
        *([] if scene.summits is None else [("radii", law_text(scene.summits))]),
        *([] if scene.fitted is None else zip(("fitted to", ""), scene.fitted.lines(), strict=True)),
        *contact_facts(scene),
        ("separations", f"{among}{ends} (d/sigma)"),
        ("quantities", ", ".join(scene.quantities)),
        (
            "ensemble",
            f"{stop}{scene.n_surfaces} surfaces of {scene.n_asperities} asperities ({scene.count}), "
            f"seed {scene.seed}, sampler {scene.sampler}",
        ),
        *accuracy_facts(scene),
    ]
    return Table((), brief(f"Scene: {scene.title}") if scene.title else "Scene", facts)


def _wish(rel_err: float | Mapping[str, float | list[float]]) -> str:
    if not isinstance(rel_err, Mapping):
        return f"{rel_err:g}"
    least = {name: f"{min(x):g} at best" if isinstance(x, list) else f"{x:g}" for name, x in rel_err.items()}
    return ", ".join(map(" ".join, least.items()))

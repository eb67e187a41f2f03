"""Conductance of a joint under three contact laws, over correlations for it.

    python runs/law_for_joint.py

Two Gaussian surfaces are in contact, together of 1 um rms and with profiles of 0.1 rms slope; the softer
body has H = 2.5 GPa. Ratios of the conductance of the spots by the model (Nayak's heights, one radius) to
that by Cooper, Mikic and Yovanovich, 1.25 k (m/sigma) (P/H)^0.95, by Nayak's alpha and by the pressure over
the hardness; under Hertz's law also to that by Mikic, 1.55 k (m/sigma) (P sqrt(2)/(E* m))^0.94.

A first table has the share of contacts that are past first yield, for each scene of ``mcgw init``.
"""

from collections.abc import Iterator
from functools import lru_cache
from importlib.resources import files

import analytic
import mcgw
from analytic import summit_plasticity_index, yielding_share
from analytic.correlation import cooper_mikic_yovanovich, mean_absolute_slope, mikic_elastic
from mcgw.commands.starting import PRESETS

M0, M2, AREA = 1e-12, 1e-2, 1e-4
HARDNESS, POISSON = 2.5e9, 0.3
TABOR = 2.84  # hardness over yield strength, as Jackson and Green take it
MODULI = {"Metal, E*/H = 46": 46 * HARDNESS, "Glass or polymer, E*/H = 10": 10 * HARDNESS}
ALPHAS = (3.0, 10.0, 30.0, 100.0)
RELATIVE = (1e-5, 1e-4, 1e-3, 1e-2)
LAWS = {
    "kogut-etsion": analytic.KogutEtsion(hardness=HARDNESS, poisson=POISSON),
    "jackson-green": analytic.JacksonGreen(yield_strength=HARDNESS / TABOR, poisson=POISSON),
    "hertz": analytic.Hertz(),
}
PRESSURES = (1e5, 1e6, 1e7)  # Pa
LEAST = 1e-5  # share that is told


def shares(preset: str) -> list[float]:
    """Return the plasticity index of a preset, and the share of its contacts that yield at each pressure."""
    scene = mcgw.scene_from((files("mcgw.scene") / "presets" / f"{preset}.toml").read_text(encoding="utf-8"))
    hardness, poisson = scene.softer or (scene.law.hardness, scene.law.poisson)
    separations = [scene.theory.separation_at("pressure", pressure) for pressure in PRESSURES]
    yielding = yielding_share(scene.theory, separations, hardness, poisson)
    return [summit_plasticity_index(scene.surface, hardness, poisson), *yielding.tolist()]


def percent(share: float) -> str:
    """Return a share in per cent."""
    return f"{share:.1%}" if share >= LEAST else f"< {LEAST:.4%}"


@lru_cache
def conductances(law: analytic.ContactLaw, alpha: float, E_star: float) -> tuple[float, ...]:
    """Return the contact conductance at each pressure of `RELATIVE`, W/(m^2 K), at 1 W/(m K)."""
    moments = analytic.SpectralMoments(M0, M2, alpha * M2**2 / M0)
    model = analytic.Model(moments.surface(AREA, E_star), heights=analytic.Nayak(alpha), law=law)
    separations = (model.separation_at("pressure", relative * HARDNESS) for relative in RELATIVE)
    return tuple(float(model.mean("conductance", h)) / (2 * AREA) for h in separations)  # k = 2/resistivity


def correlated(E_star: float) -> dict[str, list[float]]:
    """Return that of both correlations, by name."""
    joint = {"rms": M0**0.5, "slope": mean_absolute_slope(M2), "conductivity": 1.0}
    pressures = [relative * HARDNESS for relative in RELATIVE]
    return {
        "Cooper": cooper_mikic_yovanovich(pressures, hardness=HARDNESS, **joint).tolist(),
        "Mikic": mikic_elastic(pressures, E_star=E_star, **joint).tolist(),
    }


def rows(E_star: float, alphas: tuple[float, ...] = ALPHAS) -> Iterator[list[str]]:
    """Yield the rows of the table of a pair of bodies."""
    references = correlated(E_star)
    for name, law in LAWS.items():
        for reference in ("Cooper", "Mikic") if name == "hertz" else ("Cooper",):
            for alpha in alphas:
                found = zip(conductances(law, alpha, E_star), references[reference], strict=True)
                yield [name, reference, f"{alpha:g}", *(f"{x / y:.2f}" for x, y in found)]


def main() -> None:
    """Print the table of presets, and one for each pair of bodies."""
    print("| preset | psi | " + " | ".join(f"{x / 1e6:g} MPa" for x in PRESSURES) + " |")
    print("|" + "---|" * (2 + len(PRESSURES)))
    for name in PRESETS:
        index, *found = shares(name)
        print(f"| `{name}` | {index:.2g} | " + " | ".join(percent(x) for x in found) + " |")
    print()
    for name, E_star in MODULI.items():
        surface = analytic.SpectralMoments(M0, M2, 10 * M2**2 / M0).surface(AREA, E_star)
        print(f"{name}; psi = {summit_plasticity_index(surface, HARDNESS, POISSON):.2g} at alpha = 10\n")
        print("| law | over | α | " + " | ".join(f"{x:.0e}" for x in RELATIVE) + " |")
        print("|" + "---|" * (3 + len(RELATIVE)))
        for row in rows(E_star):
            print("| " + " | ".join(row) + " |")
        print()


if __name__ == "__main__":
    main()

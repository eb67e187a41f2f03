"""Hold what `solve` says of the very summits of a map to boundary elements, beside laws of their heights.

    python runs/validation/listed.py     (two minutes)

On the 16 maps of fitted_maps.py, of which half are no isotropic Gaussian ones, at p/(E* g) = 0.002, 0.01 and
0.05. Area on the first of each kind, of the very summits, of one radius, and of Nayak's law:

    lay 4 : 1         +33 +20 +10    -26 -27 -38    -31  -28  -32 %
    plateau-honed      -9 -10 -14    -30 -35 -42    -57  -57  -57
    lognormal         -14 -12 -18   +161 +82 +10   +254 +157  +61
    mirrored Weibull  +31 +33 +34    -72 -58 -41    -82  -70  -55

Second maps of each kind say the same: +3 ... +12, -8 ... -18, -3 ... -18 and +26 ... +35 % of area. Stiffness
of the very summits: -5, -4, -4, +1 % at 0.002, and -42, -50, -23, -39 % at 0.05, where spots interact.
"""

from fitted_maps import LOADS, MAPS, MODULUS, SIDE, SLOPE, read

import mcgw
from mcgw.maps.topography import Topography

LAWS = ("summits", "gaussian", "nayak")


def main() -> None:
    """Print area and stiffness over those of boundary elements, less 1."""
    solves = read()
    columns = (f"{law + ', ' + x:>22s}" for law in LAWS for x in ("area", "stiffness"))
    print(f"{'':22s}  p/(E* g)" + "".join(columns))
    for each in MAPS:
        z = SLOPE * SIDE * each.heights()
        fit = mcgw.fit(Topography(z, (SIDE / len(z),) * 2, periodic=True), cutoff=None, form="none")
        scenes = {law: mcgw.fitted_scene(fit, heights=law, E_star=MODULUS) for law in LAWS}
        pressures = [p * MODULUS * SLOPE for p in LOADS]
        found = {
            law: mcgw.solve(scene if scene.as_measured else scene.replace(n_surfaces=2), pressure=pressures)
            for law, scene in scenes.items()
        }
        for k, row in enumerate(solves[each.name]):
            right = row["area"] * fit.area, row["stiffness"] * MODULUS * fit.area / SIDE
            off = (
                found[law][k].theory[name] / value - 1
                for law in LAWS
                for name, value in zip(("area", "stiffness"), right, strict=True)
            )
            print(f"{each.name:22s}  {row['p']:8g}" + "".join(f"{x:+22.1%}" for x in off), flush=True)


if __name__ == "__main__":
    main()

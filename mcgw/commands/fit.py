"""``mcgw fit``: a scene from a measured map."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mcgw.maps.fit import Fit

HELP = "fit summit density, radius and spread to a measured height map, and write a scene"
EXAMPLE = "mcgw fit map.sdf --cutoff 5um -o fitted.toml"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("map", type=Path, metavar="MAP", help="SDF, X3P, .npy, .h5 or text")
    parser.add_argument(
        "--cutoff", required=True, metavar="LENGTH",
        help="shortest wavelength that counts, as 5um (Gaussian filter, ISO 16610-61); or none",
    )  # fmt: skip
    parser.add_argument(
        "--form",
        choices=("none", "plane", "quadratic"),
        default="plane",
        help="what is taken off first; default: plane",
    )
    parser.add_argument("--pixel", metavar="LENGTH", help="size of a pixel, where the file does not tell it")
    parser.add_argument(
        "--unit", metavar="UNIT", help="of the heights, as um, where the file does not tell it; default: m"
    )
    parser.add_argument(
        "--use", choices=("moments", "summits", "caps"), default="summits",
        help="which estimate goes into the scene; default: summits",
    )  # fmt: skip
    parser.add_argument(
        "--heights", choices=("gaussian", "table", "measured"), default="gaussian",
        help="gaussian, or the summits' own, resampled or just as they are; default: gaussian",
    )  # fmt: skip
    parser.add_argument(
        "--E-star", default="100 GPa", metavar="E", help="composite modulus; default: 100 GPa"
    )
    parser.add_argument(
        "--parts", type=int, default=4, help="sub-areas along each axis, for errors; default: 4"
    )
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="SCENE", help="TOML file")


def execute(args: argparse.Namespace) -> int:
    """Print the estimates side by side with warnings, write the scene, and say where it is."""
    from mcgw.commands.outputs import NPY, TOML, Output, check_outputs
    from mcgw.formats.units import parse
    from mcgw.maps.cautions import cautions
    from mcgw.maps.files import files_of_map, read_map
    from mcgw.maps.fit import fit_map
    from mcgw.maps.fitted_scene import fitted_scene, heights_beside, write_scene

    if args.parts < 2:
        raise ValueError(f"--parts {args.parts}: give 2 or more, to have sub-areas to compare")
    cutoff = None if args.cutoff == "none" else parse(args.cutoff, "m", "--cutoff")
    E_star = parse(args.E_star, "Pa", "--E-star")
    pixel = None if args.pixel is None else (parse(args.pixel, "m", "--pixel"),) * 2
    topography = read_map(args.map, pixel=pixel, unit=args.unit)
    beside = [Output(heights_beside(args.output), NPY)] if args.heights == "measured" else []
    check_outputs([Output(args.output, TOML), *beside], inputs=files_of_map(args.map))
    fit = fit_map(topography, cutoff=cutoff, form=args.form, across=args.parts)
    filtered = "none" if cutoff is None else f"{cutoff:g} m (Gaussian, ISO 16610-61)"
    head = f"{args.map.name}: form taken off: {args.form}; cutoff: {filtered}"
    if topography.assumed_unit:
        head += f"; heights taken in {topography.assumed_unit}, since the file tells no unit"
    text = [head, *_table(fit), *(f"warning: {line}" for line in cautions(fit, topography, cutoff))]
    print("\n".join(text))
    scene = fitted_scene(fit, use=args.use, heights=args.heights, E_star=E_star, title=f"Fitted to {head}")
    for path in write_scene(scene, args.output, fit if args.heights == "measured" else None, text):
        print(path)
    return 0


def _table(fit: "Fit") -> list[str]:
    """Estimates by all methods, one a line, with standard errors over the sub-areas."""
    from mcgw.maps.fit import METHODS

    m = fit.moments
    lines = [
        f"m0 = {m.m0:.4g} m^2, m2 = {m.m2:.4g}, m4 = {m.m4:.4g} 1/m^2, "
        f"alpha = {fit.alpha[0]:.3g} +- {fit.alpha[1]:.1g}, "
        f"skewness {fit.skewness[0]:.2f} +- {fit.skewness[1]:.1g}",
        f"{fit.summits.size} summits on {fit.area:.4g} m^2, "
        f"on average {fit.mean_summit:.3g} m above the mean plane",
        f"{'':36}{'eta (1/m^2)':22}{'R (m)':22}{'sigma (m)':22}eta R sigma",
    ]
    for name, label in METHODS.items():
        if name in fit.estimates:
            e = fit.estimates[name]
            cells = (f"{value:.4g} +- {error:.1g}" for value, error in (e.eta, e.radius, e.sigma))
            lines.append(f"{label:36}" + "".join(f"{cell:22}" for cell in cells) + f"{e.overlap:.3g}")
    if fit.visible is not None:
        lines.append(
            f"of independent caps like these the map shows {100 * fit.visible.share:.3g} %: what is counted "
            f"is off by {100 * (fit.visible.share - 1):+.2g} % in eta and "
            f"{100 * (fit.visible.std - 1):+.2g} % in sigma"
        )
    return lines

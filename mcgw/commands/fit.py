"""``mcgw fit``: a scene from a measured map, or from profiles."""

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from analytic import Surface
    from mcgw.maps.fit import Fit
    from mcgw.maps.preparation import Preparation, Prepared
    from mcgw.maps.profile_fit import ProfileFit

    Fitted = tuple[Fit | ProfileFit, list[str], Callable[[], list[str]]]  # lines; writes the rest, tells what

HELP = "fit summit density, radius and spread to measured height maps, and write a scene"
EXAMPLE = "mcgw fit map.h5 --cutoff 5um -o fitted.toml"
E_STAR = "100 GPa"  # default
_AREA = "1 mm^2"  # default, of numbers alone


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    from mcgw.maps.steps import STEPS

    parser.add_argument(
        "map", type=Path, nargs="*", metavar="MAP",
        help=".npy, .h5 or text (SDF, X3P, ... with the extra maps); several of one surface are pooled; or "
            "profiles of one surface (text with x and z), recognised by their shape",
    )  # fmt: skip
    parser.add_argument(
        "--iso", nargs="+", metavar="NUMBER",
        help="no map, but numbers that an instrument states: Sq=0.8um Sdq=0.12 Spc=0.043/um (or Spd; Rq, "
        "Rdq, Rpd, RSm of profiles; Sal autocorrelation=gaussian; pruning=0 if all peaks counted)",
    )  # fmt: skip
    parser.add_argument("--profile", action="store_true", help="read each file as a profile")
    for step in STEPS:
        told = f"; default: {step.kinds[0]}" if step.kinds else ""
        parser.add_argument(
            f"--{step.name.replace('_', '-')}", help=step.words + told,
            choices=step.kinds or None, default=step.kinds[0] if step.kinds else None,
            metavar=None if step.kinds else "LENGTH",
        )  # fmt: skip
    parser.add_argument(
        "--trim",
        type=int,
        default=0,
        metavar="N",
        help="number of points to remove along each edge; default: 0",
    )
    parser.add_argument("--pixel", metavar="LENGTH", help="size of a pixel, if the file does not give it")
    parser.add_argument(
        "--unit",
        metavar="UNIT",
        help="unit of the heights, such as um, if the file does not give it; default: m",
    )
    parser.add_argument(
        "--missing-value", type=float, metavar="V",
        help="number that stands for a missing point, in the unit of the file, such as -9999",
    )  # fmt: skip
    parser.add_argument(
        "--use", choices=("auto", "moments", "summits", "caps"), default="auto",
        help="estimate used in the scene; auto: caps if all summits have one radius, otherwise summits; "
        "default: auto",
    )  # fmt: skip
    parser.add_argument(
        "--heights", choices=("gaussian", "nayak", "table", "measured", "summits"), default="gaussian",
        help="gaussian; nayak: from the moments, each summit with its own radius; or the measured heights, "
        "resampled (table), as they are (measured), or with their radii (summits); default: gaussian",
    )  # fmt: skip
    parser.add_argument("--E-star", metavar="E", help=f"composite modulus; default: {E_STAR}")
    parser.add_argument(
        "--nominal-area",
        metavar="AREA",
        help="nominal area of the scene, such as 1cm^2; default: that of the map",
    )
    parser.add_argument(
        "--parts",
        type=int,
        default=4,
        help="number of sub-areas along each axis, to estimate errors; default: 4",
    )
    parser.add_argument(
        "--summits", type=Path, metavar="CSV", help="write every summit: position, height, radius, curvatures"
    )
    parser.add_argument("--tiles", type=Path, metavar="CSV", help="write the estimates of each sub-area")
    parser.add_argument(
        "--picture", type=Path, metavar="PNG",
        help="also draw the map before and after, its summits, their distributions, and moments against "
            "cutoff",
    )  # fmt: skip
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="SCENE", help="TOML file")


def execute(args: argparse.Namespace) -> int:
    """Write the scene with all estimates as comments; print it and its cautions."""
    from mcgw.commands.voice import details, news, notes
    from mcgw.formats.files import together
    from mcgw.formats.units import parse
    from mcgw.maps.fit import Fit
    from mcgw.maps.fitted_scene import fitted_scene, write_scene
    from mcgw.maps.fitting import are_profiles
    from mcgw.maps.preparation import preparation_of

    if args.iso is not None:
        return _of_numbers(args)
    if not args.map:
        raise ValueError("MAP: give a map or profiles, or --iso with numbers such as Sq=0.8um Sdq=0.12")
    if args.cutoff is None:
        raise ValueError("--cutoff: give the shortest wavelength of the roughness, such as 5um, or none")
    asked, across = preparation_of(
        vars(args), lambda key, text: parse(text, "m", f"--{key.replace('_', '-')}")
    )
    E_star = parse(E_STAR if args.E_star is None else args.E_star, "Pa", "--E-star")
    area = None if args.nominal_area is None else parse(args.nominal_area, "m^2", "--nominal-area")
    pixel = None if args.pixel is None else parse(args.pixel, "m", "--pixel")
    of_profiles = are_profiles(args.map, profile=args.profile)
    fit, lines, write = (
        _of_profiles(args, asked, pixel) if of_profiles else _of_map(args, asked, pixel, across)
    )
    on = {} if area is None else {"nominal_area": area}
    more = f" and {len(args.map) - 1} more" if len(args.map) > 1 else ""
    title = f"Fitted to {args.map[0].name[:50]}{more}"
    scene = fitted_scene(fit, use=args.use, heights=args.heights, E_star=E_star, title=title, **on)
    comments = [*lines, "", "units: sigma and radius in m, eta in 1/m^2, nominal_area in m^2, E_star in Pa"]
    measured = fit if isinstance(fit, Fit) and args.heights == "measured" else None
    with together():
        path, *beside = write_scene(scene, args.output, measured, comments)
        others = write()
    s = scene.surface
    news(
        f"{path}: {_parameters(s, args)}",
        lines[0],
        *(line for line in lines[1:] if line.startswith("missing: ")),
        *beside,
        *others,
    )
    details(*(line for line in lines[1:] if not line.startswith("missing: ")))
    notes(*([] if scene.fitted is None else scene.fitted.gravest))
    news(
        f"next: mcgw run {args.output} -o {args.output.with_suffix('.h5')}, "
        f"or at a load: mcgw solve {args.output} --pressure 1MPa"
    )
    return 0


def _of_numbers(args: argparse.Namespace) -> int:
    """Write the scene of an isotropic Gaussian surface with these numbers."""
    from mcgw.commands.outputs import TOML, Output, check_outputs
    from mcgw.commands.voice import news, notes
    from mcgw.formats.units import parse
    from mcgw.maps.fitted_scene import scene_of_moments, write_scene
    from mcgw.maps.iso import moments_from

    if args.map:
        raise ValueError(f"{args.map[0]}: give a map, or --iso with numbers, not both")
    pairs = [part.partition("=")[::2] for part in args.iso]
    if wrong := next((part for part in args.iso if "=" not in part), None):
        raise ValueError(f"--iso {wrong!r}: give NAME=VALUE, such as Sq=0.8um")
    names = [key for key, _ in pairs]
    if twice := next((key for key in names if names.count(key) > 1), None):
        raise ValueError(f"--iso: gives {twice} more than once")
    numbers = dict(pairs)
    pruning = {} if "pruning" not in numbers else {"pruning": _share(numbers.pop("pruning"))}
    moments, doubts = moments_from(numbers, **pruning)
    area = parse(args.nominal_area or _AREA, "m^2", "--nominal-area")
    E_star = parse(args.E_star or E_STAR, "Pa", "--E-star")
    check_outputs([Output(args.output, TOML)])
    scene = scene_of_moments(moments, area, E_star, "From " + " ".join(args.iso)[:60])
    told = f"m0 = {moments.m0:.4g} m^2, m2 = {moments.m2:.4g}, m4 = {moments.m4:.4g} 1/m^2"
    write_scene(scene, args.output, None, [" ".join(args.iso), told, *doubts])
    news(
        f"{args.output}: {told}, alpha = {moments.alpha:.4g}",
        f"{_parameters(scene.surface, args)}, "
        f"nominal_area = {area:.4g} m^2{' (assumed; give --nominal-area)' * (args.nominal_area is None)}",
    )
    notes(*doubts)
    return 0


def _parameters(s: "Surface", args: argparse.Namespace) -> str:
    """The parameters of a surface, and whether its modulus was given."""
    assumed = " (assumed; give --E-star)" if args.E_star is None else ""
    return (
        f"sigma = {s.sigma:.4g} m, radius = {s.radius:.4g} m, eta = {s.eta:.4g} 1/m^2, "
        f"E_star = {s.E_star:.4g} Pa{assumed}"
    )


def _share(text: str) -> float:
    """A fraction of Sz, which may be 0."""
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"pruning = {text!r}: give a fraction of Sz, such as 0.05, or 0") from None


def _of_map(args: argparse.Namespace, asked: "Preparation", pixel: float | None, across: int) -> "Fitted":
    """Fit a map."""
    from mcgw.commands.outputs import CSV, NPY, TOML, Output, check_outputs, figure_format
    from mcgw.maps.fitted_scene import heights_beside
    from mcgw.maps.fitting import fit_maps
    from mcgw.maps.map_files import files_of_map
    from mcgw.reports.fitted import fit_lines, map_line

    if len(args.map) > 1 and args.picture is not None:
        raise ValueError(f"--picture {args.picture}: draws one map; give one")
    beside = [Output(heights_beside(args.output), NPY)] if args.heights == "measured" else []
    tables = {"--summits": args.summits, "--tiles": args.tiles}
    beside += [Output(path, CSV, option) for option, path in tables.items() if path is not None]
    if args.picture is not None:
        beside.append(Output(args.picture, figure_format(), "--picture"))
    check_outputs(
        [Output(args.output, TOML), *beside],
        inputs=[file for path in args.map for file in files_of_map(path)],
    )
    fit, ready = fit_maps(
        args.map, asked, across, pixel=pixel, unit=args.unit, missing=args.missing_value, use=args.use
    )
    head = map_line([path.name for path in args.map], asked, ready.levelled.assumed_unit)
    return fit, [head, *fit.notes, *fit_lines(fit)], partial(_write_beside, args, fit, ready, pixel)


def _write_beside(args: argparse.Namespace, fit: "Fit", ready: "Prepared", pixel: float | None) -> list[str]:
    """Write the requested tables and picture, and return a line for each."""
    from mcgw.maps.map_files import read_map
    from mcgw.maps.summits import SUMMITS, TILES

    told = []
    if args.summits is not None:
        fit.listed.table().write(args.summits, comment=SUMMITS)
        told.append(f"{args.summits}: every summit")
    if args.tiles is not None:
        fit.tiles.write(args.tiles, comment=TILES)
        told.append(f"{args.tiles}: every sub-area")
    if args.picture is not None:
        from mcgw.figures.map_fit import save_fit_picture

        size = None if pixel is None else (pixel, pixel)
        save_fit_picture(
            fit,
            read_map(args.map[0], pixel=size, unit=args.unit, missing=args.missing_value),
            ready,
            args.picture,
        )
        told.append(f"{args.picture}: figure")
    return told


def _of_profiles(args: argparse.Namespace, asked: "Preparation", spacing: float | None) -> "Fitted":
    """Fit profiles."""
    from mcgw.commands.outputs import TOML, Output, check_outputs
    from mcgw.maps.fitting import fit_lines
    from mcgw.reports.fitted import profile_line, profile_lines

    for option, given in (("--summits", args.summits), ("--tiles", args.tiles), ("--picture", args.picture)):
        if given is not None:
            raise ValueError(
                f"{option} {given}: a profile shows no summits, and has no sub-areas; give a map"
            )
    check_outputs([Output(args.output, TOML)], inputs=args.map)
    fit, profiles = fit_lines(args.map, asked, spacing=spacing, unit=args.unit)
    head = profile_line([path.name for path in args.map], asked, profiles)
    return fit, [head, *profile_lines(fit)], list

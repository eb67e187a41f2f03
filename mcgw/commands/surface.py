"""``mcgw surface``: one surface of an ensemble as a map; or a Gaussian map."""

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mcgw.maps.synthetic import Asperities
    from mcgw.maps.topography import Topography
    from mcgw.scene.scene import Scene

HELP = "write one surface of an ensemble, or a Gaussian map, as a height map"
EXAMPLE = "mcgw surface runs/demo.toml --surface 3 -o map.h5"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this command."""
    parser.add_argument("scene", type=Path, nargs="?", metavar="SCENE", help="TOML file, SI units")
    parser.add_argument(
        "--surface", type=int, default=0, metavar="I", help="number of the surface; default: 0"
    )
    parser.add_argument(
        "--shape", default="1024", metavar="N", help="columns of the map, or COLUMNSxROWS; default: 1024"
    )
    parser.add_argument("--width", metavar="LENGTH", help="extent along x, such as 5mm; default: a square")
    parser.add_argument("--periodic", action="store_true", help="let caps reach across the edges")
    parser.add_argument(
        "--from-spectrum",
        metavar="LIST",
        help="a Gaussian map instead: rms=1um,long=100um,short=5um[,hurst=0.8], or m0=..,m2=..,m4=.. (SI)",
    )
    parser.add_argument("--pixel", metavar="LENGTH", help="pixel of a Gaussian map, such as 0.5um")
    parser.add_argument("--seed", type=int, default=0, help="seed of a Gaussian map; default: 0")
    parser.add_argument(
        "-o", "--output", type=Path, required=True, metavar="FILE",
        help="file ending in .npy, .h5 or .sdf",
    )  # fmt: skip


def execute(args: argparse.Namespace) -> int:
    """Write the map; print its path and the number of hidden summits."""
    if args.from_spectrum is not None:
        return _spectrum(args)
    if args.scene is None:
        raise ValueError("SCENE: give a scene (TOML), or --from-spectrum")
    return _asperities(args)


def _check_output(args: argparse.Namespace) -> None:
    from mcgw.commands.outputs import JSON, Format, Output, check_outputs
    from mcgw.maps.map_files import WRITTEN, files_of_map
    from mcgw.scene.scene_file import files_of

    inputs = files_of(args.scene) if args.scene else []
    map_file, *beside = files_of_map(args.output)
    outputs = [Output(map_file, Format("a map", WRITTEN)), *(Output(path, JSON) for path in beside)]
    check_outputs(outputs, inputs=inputs)


def _shape(text: str) -> tuple[int, int | None]:
    """Columns, and rows if given."""
    found = re.fullmatch(r"(\d{1,9})(?:x(\d{1,9}))?", text)
    if found is None:
        raise ValueError(
            f"--shape {text!r}: give columns, such as 1024, or columns and rows, such as 1024x512"
        )
    return int(found[1]), int(found[2]) if found[2] else None


def _asperities(args: argparse.Namespace) -> int:
    from mcgw.commands.voice import news, notes, tell_cautions
    from mcgw.formats.units import parse
    from mcgw.maps.envelope import envelope
    from mcgw.maps.map_files import write_map
    from mcgw.maps.synthetic import asperities_of
    from mcgw.scene.scene_file import load_scene, scene_text

    scene = load_scene(args.scene)
    width = None if args.width is None else parse(args.width, "m", "--width")
    _check_output(args)
    field = asperities_of(scene, args.surface, width=width)
    columns, rows = _shape(args.shape)
    if rows is None:
        rows = max(round(columns * field.size[1] / field.size[0]), 1)
    topography = envelope(field, (rows, columns), periodic=args.periodic)
    news(*write_map(topography, args.output, field, scene=scene_text(scene)))
    said, doubts = _account(scene, field, topography)
    news(*said)
    notes(*doubts)
    tell_cautions(scene, f"mcgw show --plan {args.scene}")
    return 0


def _account(scene: "Scene", field: "Asperities", topography: "Topography") -> tuple[list[str], list[str]]:
    """Describe the map and how many of its summits are not independent."""
    from mcgw.maps.envelope import hidden_summits
    from mcgw.maps.hidden_caps import CROWDED

    hidden = hidden_summits(field, periodic=topography.periodic)
    touching = field.z > scene.lowest * scene.surface.sigma
    density = field.number / (field.size[0] * field.size[1])
    overlap = density * field.radius * scene.surface.sigma
    rows, columns = topography.heights.shape
    dx, dy = topography.pixel
    lines = [
        f"{columns} x {rows} points of {dx:.4g} x {dy:.4g} m, {field.number} asperities, seed {scene.seed}",
        f"eta R sigma = {overlap:.4g}; hidden under taller neighbours: {hidden.sum()} summits "
        f"({100 * hidden.mean():.3g} %), {(hidden & touching).sum()} of the {touching.sum()} that touch at "
        f"h = {scene.lowest:g}",
    ]
    doubts = []
    if overlap > CROWDED:
        doubts.append("the caps overlap, so this map is not a field of independent asperities")
    if max(topography.pixel) > 0.5 * (2 * field.radius * scene.surface.sigma) ** 0.5:
        doubts.append("a pixel is wider than half a cap, sqrt(2 R sigma); give a larger --shape")
    return lines, doubts


def _spectrum(args: argparse.Namespace) -> int:
    import numpy as np

    from mcgw.commands.voice import news
    from mcgw.formats.units import parse
    from mcgw.maps.map_files import write_map
    from mcgw.maps.synthetic import gaussian_map, moments_on_grid, spectrum_from

    if args.scene is not None:
        raise ValueError("--from-spectrum: draws a map without asperities; leave out SCENE")
    if args.pixel is None:
        raise ValueError("--pixel: give the size of a pixel, as --pixel 0.5um")
    if args.seed < 0:
        raise ValueError(f"--seed {args.seed}: give a whole number >= 0")
    pixel = parse(args.pixel, "m", "--pixel")
    columns, rows = _shape(args.shape)
    shape = (columns if rows is None else rows, columns)
    spectrum = spectrum_from(args.from_spectrum)
    _check_output(args)
    topography = gaussian_map(spectrum, shape, (pixel, pixel), np.random.default_rng(args.seed))
    news(*write_map(topography, args.output))
    m = moments_on_grid(spectrum, shape, (pixel, pixel))
    news(f"m0 = {m.m0:.6g} m^2, m2 = {m.m2:.6g}, m4 = {m.m4:.6g} 1/m^2, alpha = {m.alpha:.4g}")
    news(f"summits (Nayak): eta = {m.eta:.4g} 1/m^2, R = {m.radius:.4g} m, sigma = {m.sigma:.4g} m")
    return 0

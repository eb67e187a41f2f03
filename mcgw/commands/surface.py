"""``mcgw surface``: one surface of an ensemble as a map; or a Gaussian map."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from mcgw.commands.kinds import Length, scene_file
from mcgw.commands.outputs import JSON, Format, Output, check_outputs, news, notes

if TYPE_CHECKING:
    from mcgw.scene.scene import Scene


def surface(
    scene: Annotated["Scene | None", scene_file()] = None,
    *,
    surface: int = 0,
    shape: str = "1024",
    width: Length = None,
    periodic: bool = False,
    from_spectrum: str | None = None,
    pixel: Length = None,
    seed: int = 0,
    output: Path,
) -> None:
    """Write one surface of an ensemble, or a Gaussian map, as a height map.

    Parameters
    ----------
    surface : I
        number of the surface
    shape : N
        columns of a square map, or COLUMNSxROWS
    width : LENGTH
        extent of the map along x, such as 200um; default: that of the nominal area, a square
    periodic
        let caps reach across the edges
    from_spectrum : LIST
        a Gaussian map instead: rms=1um,long=100um,short=5um[,hurst=0.8], or m0=..,m2=..,m4=.. (SI)
    pixel : LENGTH
        pixel of a Gaussian map, such as 0.5um
    seed : K
        seed of a Gaussian map
    output : FILE
        file ending in .npy, .h5 or .sdf

    Examples
    --------
    mcgw surface runs/demo.toml --surface 3 -o map.h5
    """
    from mcgw.maps.envelope import envelope, hidden_summits
    from mcgw.maps.estimates import CROWDED
    from mcgw.maps.map_files import WRITTEN, files_of_map, write_map
    from mcgw.maps.synthetic import asperities_of
    from mcgw.scene.scene_file import scene_text

    found = re.fullmatch(r"(\d{1,9})(?:x(\d{1,9}))?", shape)
    if found is None:
        raise ValueError(
            f"--shape {shape!r}: give columns, such as 1024, or columns and rows, such as 1024x512"
        )
    points = int(found[2] or found[1]), int(found[1])
    map_file, *beside = files_of_map(output)
    check_outputs([Output(map_file, Format("a map", WRITTEN)), *(Output(path, JSON) for path in beside)])
    if from_spectrum is not None:
        if scene is not None:
            raise ValueError("--from-spectrum: draws a map without asperities; leave out SCENE")
        if pixel is None:
            raise ValueError("--pixel: give the size of a pixel, as --pixel 0.5um")
        if seed < 0:
            raise ValueError(f"--seed {seed}: give a whole number >= 0")
        return _gaussian(from_spectrum, points, pixel, seed, output)
    if scene is None:
        raise ValueError("SCENE: give a scene (TOML), or --from-spectrum")
    field = asperities_of(scene, surface)
    topography = envelope(field, points, width=width, periodic=periodic)
    news(*write_map(topography, output, field, scene=scene_text(scene)))
    hidden = hidden_summits(field, periodic=topography.periodic)
    touching = field.z > scene.lowest * scene.surface.sigma
    overlap = field.number / (field.size[0] * field.size[1]) * field.radius * scene.surface.sigma
    rows, columns = topography.heights.shape
    dx, dy = topography.pixel
    news(
        f"{columns} x {rows} points of {dx:.4g} x {dy:.4g} m, {field.number} asperities, seed {scene.seed}",
        f"eta R sigma = {overlap:.4g}; hidden under taller neighbours: {hidden.sum()} summits "
        f"({100 * hidden.mean():.3g} %), {(hidden & touching).sum()} of the {touching.sum()} that touch at "
        f"h = {scene.lowest:g}",
    )
    if overlap > CROWDED:
        notes("the caps overlap, so this map is not a field of independent asperities")
    if max(topography.pixel) > 0.5 * (2 * field.radius * scene.surface.sigma) ** 0.5:
        notes("a pixel is wider than half a cap, sqrt(2 R sigma); give a larger --shape")
    return None


def _gaussian(text: str, shape: tuple[int, int], pixel: float, seed: int, path: Path) -> None:
    import numpy as np

    from mcgw.maps.map_files import write_map
    from mcgw.maps.synthetic import gaussian_map, moments_on_grid, spectrum_from

    spectrum = spectrum_from(text)
    topography = gaussian_map(spectrum, shape, (pixel, pixel), np.random.default_rng(seed))
    news(*write_map(topography, path))
    m = moments_on_grid(spectrum, shape, (pixel, pixel))
    news(f"m0 = {m.m0:.6g} m^2, m2 = {m.m2:.6g}, m4 = {m.m4:.6g} 1/m^2, alpha = {m.alpha:.4g}")
    news(f"summits (Nayak): eta = {m.eta:.4g} 1/m^2, R = {m.radius:.4g} m, sigma = {m.sigma:.4g} m")

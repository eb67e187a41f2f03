"""Measured and made maps: ``mcgw fit``, a scene from a map, profiles or numbers; ``mcgw surface``, a map."""

import re
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from mcgw.commands import kinds
from mcgw.commands.outputs import Output, check_outputs, details, news, notes
from mcgw.maps.steps import Form, LinesTo, Missing, SpikesTo

if TYPE_CHECKING:
    from mcgw.scene.scene import Scene


def _maps(paths: list[Path], call: kinds.Call) -> list[Path]:
    """Return maps or profiles; the files beside them that say their units are read as well."""
    from mcgw.maps.map_files import files_of_map

    call.inputs.extend(file for path in paths for file in files_of_map(path))
    return paths


def fit(
    map: Annotated[list[Path], kinds.file_in(opened=_maps)] = [],  # noqa: A002, B006
    *,
    iso: list[str] | None = None,
    cutoff: str | None = None,
    long_cutoff: str | None = None,
    form: Form = "plane",
    missing: Missing = "auto",
    spikes: SpikesTo = "keep",
    lines: LinesTo = "keep",
    trim: int = 0,
    pixel: kinds.Pixel = None,
    unit: kinds.Unit = None,
    missing_value: float | None = None,
    use: Literal["auto", "moments", "summits", "caps"] = "auto",
    heights: Literal["gaussian", "nayak", "table", "measured", "summits"] = "gaussian",
    E_star: Annotated[float | None, kinds.quantity("Pa")] = None,
    nominal_area: Annotated[float | None, kinds.quantity("m^2")] = None,
    parts: int = 4,
    summits: kinds.Table = None,
    tiles: kinds.Table = None,
    picture: Annotated[Path | None, kinds.file_out("a figure")] = None,
    output: Annotated[Path, kinds.file_out("a scene")],
) -> None:
    """Fit summit density, radius and spread to measured height maps, and write a scene.

    map (MAP): .npy, .h5 or text (SDF, X3P, ... with the extra maps); several of one surface are pooled; or
        profiles of one surface (text with x and z), recognised by their shape
    iso (NUMBER): no map, but numbers that an instrument states: Sq=0.8um Sdq=0.12 Spc=0.043/um (or Spd; Rq,
        Rdq, Rpd, RSm of profiles; Sal autocorrelation=gaussian; pruning=0 if all peaks counted)
    cutoff (LENGTH): shortest wavelength of the roughness, such as 5um (Gaussian filter, ISO 16610-61); or
        none
    long_cutoff (LENGTH): longest wavelength of the roughness, such as 80um; default: no limit
    form: form to remove
    missing: missing points are filled from the edges of their holes; mask: ignore them and their neighbours;
        fill: use them; auto: mask if half of the other points remain
    spikes: remove points that stand out
    lines: remove offsets between rows or columns, as from a line scan
    trim (N): number of points to remove along each edge
    missing_value (V): number that stands for a missing point, in the unit of the file, such as -9999
    use: estimate used in the scene; auto: caps if all summits have one radius, otherwise summits
    heights: gaussian; nayak: from the moments, each summit with its own radius; or the measured heights,
        resampled (table), as they are (measured), or with their radii (summits)
    E_star (E): composite modulus; default: 100 GPa
    nominal_area (AREA): nominal area of the scene, such as 1cm^2; default: that of the map
    parts (N): number of sub-areas along each axis, to estimate errors
    summits (CSV): write every summit: position, height, radius, curvatures
    tiles (CSV): write the estimates of each sub-area
    picture (PNG): also draw the map before and after, its summits, their distributions, and moments against
        cutoff
    output (SCENE): TOML file

    example: mcgw fit map.h5 --cutoff 5um -o fitted.toml
    """
    from mcgw.formats.files import together
    from mcgw.maps.fit import Fit
    from mcgw.maps.fitted_scene import fitted_scene, heights_beside, write_scene
    from mcgw.maps.fitting import fit_sources
    from mcgw.maps.heights_files import read_heights, read_map
    from mcgw.maps.preparation import preparation_of
    from mcgw.maps.summit_sums import SUMMITS, TILES

    assumed = " (assumed; give --E-star)" if E_star is None else ""
    E_star = 100e9 if E_star is None else E_star
    if iso is not None:
        if map:
            raise ValueError(f"{map[0]}: give a map, or --iso with numbers, not both")
        return _of_iso(iso, output, E_star, assumed, nominal_area)
    if not map:
        raise ValueError("MAP: give a map or profiles, or --iso with numbers such as Sq=0.8um Sdq=0.12")
    if cutoff is None:
        raise ValueError("--cutoff: give the shortest wavelength of the roughness, such as 5um, or none")
    asked = preparation_of({
        "cutoff": cutoff, "long_cutoff": long_cutoff, "form": form, "missing": missing, "spikes": spikes,
        "lines": lines, "trim": trim, "parts": parts,
    })  # fmt: skip
    names = [path.name for path in map]
    if picture and len(map) > 1:
        raise ValueError(f"--picture {picture}: draws one map; give one")
    if heights == "measured":
        check_outputs([Output(heights_beside(output), "heights")])
    size = None if pixel is None else (pixel, pixel)
    of_file: dict[str, Any] = {"pixel": size, "unit": unit, "missing": missing_value}
    found, ready, assumed_unit = fit_sources(map, partial(read_heights, **of_file), asked, use)
    for option, path in (("--summits", summits), ("--tiles", tiles), ("--picture", picture)):
        if path and ready is None:
            raise ValueError(f"{option} {path}: a profile shows no summits, and has no sub-areas; give a map")
    filtered = "none" if asked.cutoff is None else f"{asked.cutoff:g} m (Gaussian)"
    said = [f"{', '.join(names)}: form removed: {asked.form}; cutoff: {filtered}"]
    said[0] += f"; lengths in {assumed_unit}, since the file gives no unit" if assumed_unit else ""
    said += [*getattr(found, "notes", ()), *repr(replace(found, cautions=())).splitlines()]
    title = f"Fitted to {names[0][:50]}{f' and {len(map) - 1} more' * (len(map) > 1)}"
    on = {} if nominal_area is None else {"nominal_area": nominal_area}
    scene = fitted_scene(found, use=use, heights=heights, E_star=E_star, title=title, **on)
    units = "units: sigma and radius in m, eta in 1/m^2, nominal_area in m^2, E_star in Pa"
    measured = found if isinstance(found, Fit) and heights == "measured" else None
    with together():
        told = [str(each) for each in write_scene(scene, output, measured, [*said, "", units])[1:]]
        if summits and isinstance(found, Fit):
            found.listed.table().write(summits, comment=SUMMITS)
            told.append(f"{summits}: every summit")
        if tiles and isinstance(found, Fit):
            found.tiles.write(tiles, comment=TILES)
            told.append(f"{tiles}: every sub-area")
        if picture and isinstance(found, Fit) and ready:
            from mcgw.figures.map_fit import fit_figure
            from mcgw.figures.panels import save

            save(fit_figure(found, read_map(map[0], **of_file), ready), picture)
            told.append(f"{picture}: figure")
    lost = [line for line in said[1:] if line.startswith("missing: ")]
    news(f"{output}: {_parameters(scene.surface, assumed)}", said[0], *lost, *told)
    details(*(line for line in said[1:] if line not in lost))
    notes(*([] if scene.fitted is None else scene.fitted.gravest))
    news(
        f"next: mcgw run {output} -o {output.with_suffix('.h5')}, "
        f"or at a load: mcgw solve {output} --pressure 1MPa"
    )
    return None


def _of_iso(iso: list[str], output: Path, E_star: float, assumed: str, nominal_area: float | None) -> None:
    """Write the scene of an isotropic Gaussian surface with these numbers."""
    from mcgw.maps.fitted_scene import scene_of_moments, write_scene
    from mcgw.maps.iso import moments_from

    numbers: dict[str, str] = {}
    for part in iso:
        key, value = kinds.pair(part, "--iso", "NAME=VALUE, such as Sq=0.8um")
        if key in numbers:
            raise ValueError(f"--iso: gives {key} more than once")
        numbers[key] = value
    pruning = {}
    if (text := numbers.pop("pruning", None)) is not None:
        try:
            pruning["pruning"] = float(text)
        except ValueError:
            raise ValueError(f"pruning = {text!r}: give a fraction of Sz, such as 0.05, or 0") from None
    moments, doubts = moments_from(numbers, **pruning)
    area = nominal_area or 1e-6  # m^2, default of numbers alone
    scene = scene_of_moments(moments, area, E_star, "From " + " ".join(iso)[:60])
    told = f"m0 = {moments.m0:.4g} m^2, m2 = {moments.m2:.4g}, m4 = {moments.m4:.4g} 1/m^2"
    write_scene(scene, output, None, [" ".join(iso), told, *doubts])
    news(
        f"{output}: {told}, alpha = {moments.alpha:.4g}",
        f"{_parameters(scene.surface, assumed)}, "
        f"nominal_area = {area:.4g} m^2{' (assumed; give --nominal-area)' * (nominal_area is None)}",
    )
    notes(*doubts)


def _parameters(s: Any, assumed: str) -> str:
    """Return the parameters of a surface, and whether its modulus was given."""
    return (
        f"sigma = {s.sigma:.4g} m, radius = {s.radius:.4g} m, eta = {s.eta:.4g} 1/m^2, "
        f"E_star = {s.E_star:.4g} Pa{assumed}"
    )


def surface(
    scene: Annotated["Scene | None", kinds.scene_file()] = None,
    *,
    surface: int = 0,
    shape: str = "1024",
    width: kinds.Length = None,
    periodic: bool = False,
    from_spectrum: str | None = None,
    pixel: kinds.Length = None,
    seed: int = 0,
    output: Path,
) -> None:
    """Write one surface of an ensemble, or a Gaussian map, as a height map.

    surface (I): number of the surface
    shape (N): columns of a square map, or COLUMNSxROWS
    width (LENGTH): extent of the map along x, such as 200um; default: that of the nominal area, a square
    periodic: let caps reach across the edges
    from_spectrum (LIST): a Gaussian map instead: rms=1um,long=100um,short=5um[,hurst=0.8], or
        m0=..,m2=..,m4=.. (SI)
    pixel (LENGTH): pixel of a Gaussian map, such as 0.5um
    seed (K): seed of a Gaussian map
    output (FILE): file ending in .npy, .h5 or .sdf

    example: mcgw surface runs/demo.toml --surface 3 -o map.h5
    """
    import numpy as np

    from mcgw.maps.envelope import envelope, hidden_summits
    from mcgw.maps.estimates import CROWDED
    from mcgw.maps.map_files import WRITTEN, files_of_map, write_map
    from mcgw.maps.synthetic import asperities_of, gaussian_map, moments_on_grid, spectrum_from
    from mcgw.scene.scene_file import scene_text

    found = re.fullmatch(r"(\d{1,9})(?:x(\d{1,9}))?", shape)
    if found is None:
        raise ValueError(
            f"--shape {shape!r}: give columns, such as 1024, or columns and rows, such as 1024x512"
        )
    points = int(found[2] or found[1]), int(found[1])
    map_file, *beside = files_of_map(output)
    pixels = (Output(path, "the size of a pixel") for path in beside)
    check_outputs([Output(map_file, "a map", endings=WRITTEN), *pixels])
    if from_spectrum is not None:
        if scene is not None:
            raise ValueError("--from-spectrum: draws a map without asperities; leave out SCENE")
        if pixel is None:
            raise ValueError("--pixel: give the size of a pixel, as --pixel 0.5um")
        if seed < 0:
            raise ValueError(f"--seed {seed}: give a whole number >= 0")
        spectrum, grid = spectrum_from(from_spectrum), (pixel, pixel)
        made = gaussian_map(spectrum, points, grid, np.random.default_rng(seed))
        m = moments_on_grid(spectrum, points, grid)
        return news(
            *write_map(made, output),
            f"m0 = {m.m0:.6g} m^2, m2 = {m.m2:.6g}, m4 = {m.m4:.6g} 1/m^2, alpha = {m.alpha:.4g}",
            f"summits (Nayak): eta = {m.eta:.4g} 1/m^2, R = {m.radius:.4g} m, sigma = {m.sigma:.4g} m",
        )
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

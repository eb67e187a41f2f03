"""Load an exported sparse map with Tamaas, a boundary-element solver, and compare with sums over asperities.

    python runs/bem_check.py [-o FILE.png]        (needs tamaas: the extra ``bem``)

The map is that of ``runs/bem.toml``: periodic, eta R sigma = 0.0064. At the load that the independent
asperities carry at each separation the solver gives the true contact area and the separation. Two
differences are expected. Asperities pull each other down: of that, a model takes account in which each
contact is Hertz's and sinks by what all others' point loads press the half-space down (Ciavarella,
Greenwood and Paggi 2008, discrete form, on the periodic cell). And the solver's area is made
of whole pixels, too many of them at the rim of each spot: corrected by the perimeter (Yastrebov, Anciaux
and Molinari 2017). What is left is the figure's lower panel.
"""

import argparse
import math
from pathlib import Path

import matplotlib as mpl
import numpy as np
import tamaas
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullFormatter, ScalarFormatter
from scipy import fft
from scipy.optimize import root

import mcgw
from mcgw.figures.style import HOMOGENEOUS, STYLE, look, save_figure
from mcgw.maps.envelope import envelope
from mcgw.maps.synthetic import Asperities, asperities_of

HERE = Path(__file__).parent
POINTS = 2048
SURFACE = 0
_MODELS = {"independent": ("area", "plane"), "interacting": ("interacting", "plane_interacting")}
# Potential at a point charge of a square lattice with a neutral background, over charge/side.
SQUARE_LATTICE = -3.900264920001956


def green_function(field: Asperities, E_star: float) -> np.ndarray:
    """Sinking of asperity i under a unit load on j: shape (asperities, asperities), m/N.

    By the Fourier series 2/(E* q), the mean taken off, cut smoothly far below the asperities' distance.
    """
    side = field.size[0]
    n = 1024
    q = 2 * math.pi * np.hypot(fft.fftfreq(n, side / n)[:, None], fft.rfftfreq(n, side / n))
    q[0, 0] = np.inf
    width = 1.5 * side / n  # exp(-q^2 w^2/2): a Gaussian load; beyond 4 w that of a point
    table = fft.irfft2(2 / (E_star * q) * np.exp(-((q * width) ** 2) / 2) * n * n / side**2, s=(n, n))
    i, j = (np.rint(v / side * n).astype(int) for v in (field.x, field.y))
    matrix = table[(j[:, None] - j) % n, (i[:, None] - i) % n]
    np.fill_diagonal(matrix, SQUARE_LATTICE / (math.pi * E_star * side))
    return matrix


def interacting_loads(
    field: Asperities, E_star: float, total: float, start: float
) -> tuple[np.ndarray, float]:
    """Loads of the asperities and the plane's height under a total load."""
    green = green_function(field, E_star)
    stiff = 4 / 3 * E_star * math.sqrt(field.radius)

    unit = float(field.z.std())

    def misfit(unknown: np.ndarray) -> np.ndarray:
        depth, plane = unknown[:-1], unknown[-1]
        loads = stiff * np.maximum(unit * depth, 0) ** 1.5
        gaps = (field.z - green @ loads) / unit - plane - depth
        return np.append(gaps, loads.sum() / total - 1)

    found = root(misfit, np.append(field.z - start, start) / unit, tol=1e-11)
    if not found.success:
        raise RuntimeError(found.message)
    return stiff * np.maximum(unit * found.x[:-1], 0) ** 1.5, unit * float(found.x[-1])


def solve(surface: np.ndarray, side: float, E_star: float, pressure: float) -> tuple[float, float]:
    """Contact area (m^2) and height of the plane (m) by the solver."""
    model = tamaas.Model(tamaas.model_type.basic_2d, [side, side], list(surface.shape))
    model.nu, model.E = 0.0, E_star
    solver = tamaas.PolonskyKeerRey(model, surface, 1e-10)
    solver.solve(pressure)
    touching = model.traction[...] > 0
    sunk = model.displacement[...]
    plane = float((surface - (sunk - sunk.mean()))[touching].mean())
    return corrected_area(touching) * side**2, plane


def corrected_area(touching: np.ndarray) -> float:
    """Share of the area, less the share of the pixels at the rim (Yastrebov et al. 2017)."""
    n = touching.shape[0]
    steps = sum(np.count_nonzero(touching != np.roll(touching, 1, axis=k)) for k in (0, 1))
    return touching.mean() - (math.pi - 1 + math.log(2)) / 24 * steps / n**2


def study() -> list[dict[str, float]]:
    """One row for each separation of the scene."""
    scene = mcgw.load_scene(HERE / "bem.toml")
    field = asperities_of(scene, SURFACE)
    surface = np.ascontiguousarray(envelope(field, (POINTS, POINTS), periodic=True).heights)
    E_star, R, side = scene.surface.E_star, scene.surface.radius, field.size[0]
    rows = []
    for h in scene.separations:
        plane = h * scene.surface.sigma
        depth = np.maximum(field.z - plane, 0)
        load = float((4 / 3 * E_star * math.sqrt(R) * depth**1.5).sum())
        loads, sunk = interacting_loads(field, E_star, load, plane)
        area, found = solve(surface, side, E_star, load / side**2)
        rows.append(
            {
                "h": h,
                "load": load,
                "contacts": float(np.count_nonzero(depth)),
                "area": math.pi * R * float(depth.sum()),
                "interacting": math.pi * float(((3 * loads * R / (4 * E_star)) ** (2 / 3)).sum()),
                "solver": area,
                "plane": plane,
                "plane_interacting": sunk,
                "plane_solver": found,
            }
        )
        print("  ".join(f"{key} {value:.6g}" for key, value in rows[-1].items()))
    return rows


def draw(rows: list[dict[str, float]], path: Path) -> None:
    """Area and separation against load, and what is left."""
    column = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    load = 1e3 * column["load"]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(8.2, 5.6), layout="constrained")
        (area, plane), (less_area, less_plane) = figure.subplots(2, 2, sharex=True, height_ratios=[3, 2])
        for name, (each, height) in _MODELS.items():
            line = {"color": look(name)["color"], "linestyle": look(name)["linestyle"]}
            label = "with interaction" if name == "interacting" else "independent asperities"
            area.plot(load, 1e12 * column[each], label=label, **line)
            plane.plot(load, 1e6 * column[height], **line)
            less_area.plot(load, 100 * (column["solver"] / column[each] - 1), **look(name), ms=4)
            less_plane.plot(load, 1e6 * (column["plane_solver"] - column[height]), **look(name), ms=4)
        for axis, values in ((area, 1e12 * column["solver"]), (plane, 1e6 * column["plane_solver"])):
            label = "boundary elements (Tamaas)"
            axis.plot(load, values, "o", color=HOMOGENEOUS, mfc="none", label=label)
        area.set(xscale="log", yscale="log", ylabel="real area (µm²)", title="Area at equal load")
        plane.set(ylabel="height of the plane (µm)", title="Separation at equal load")
        less_area.set(xlabel="load (mN)", ylabel="solver less model (%)")
        less_plane.set(xlabel="load (mN)", ylabel="solver less model (µm)")
        for axis in (less_area.xaxis, less_plane.xaxis):
            axis.set_major_locator(FixedLocator([20, 50, 100, 200, 400]))
            axis.set_major_formatter(ScalarFormatter())
            axis.set_minor_formatter(NullFormatter())
        area.legend()
        save_figure(figure, path)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=HERE / "out" / "bem_check.png")
    output = parser.parse_args().output
    output.parent.mkdir(parents=True, exist_ok=True)
    draw(study(), output)
    print(output)

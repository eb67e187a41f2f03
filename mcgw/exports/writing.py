"""``mcgw.export``: write a table, one file for each curve and one for all; or all columns as JSON.

Its numbers: mean and quantiles over surfaces against gap or pressure, SI.
"""

import json
import re
from collections.abc import Sequence
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.at_load import pressures_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.ensemble.solution import solutions
from mcgw.exports.programs import KINDS, PROGRAMS, UNITS, Kind, Sheet
from mcgw.formats.files import together, write_whole
from mcgw.formats.table import Column, Table, evenly
from mcgw.scene.kinds import List, Number, Whole, Word, arguments
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.store.ensembles import open_ensemble, read_attributes

SCHEMA = Path(__file__).with_name("contact-table.schema.json")
_QUANTILES = (0.05, 0.95)
_MOST = 2000  # surfaces drawn again where an ensemble keeps statistics alone
_ARGUMENTS = {
    "to": Word((*PROGRAMS, "json")), "table": Word(tuple(KINDS)), "units": Word(tuple(UNITS)),
    "points": Whole(2, 10_000, "give a whole number from 2 to 10000"),
    "pressures": List(Number("Pa"), least=2, advice="give two or more increasing numbers in Pa"),
    "quantiles": List(Number(high=1 - 1e-9), 0, advice="give numbers between 0 and 1, each once", once=True),
}  # fmt: skip


Curves = tuple[Array, list[Array]]  # rising gaps or pressures, and there means and quantiles


def export(
    what: Scene | Ensemble | str | Path,
    path: str | Path,
    *,
    to: str,
    table: str = "pressure-gap",
    points: int = 40,
    pressures: Any = None,
    quantiles: Sequence[float] | None = None,
    units: str = "SI",
) -> list[Path]:
    """Write a contact table in the format of a finite-element program.

    Means and quantiles are those over the surfaces, at equal gap in tables against the gap. In tables against
    the pressure the mean is `Solution.value` of `mcgw.solve`, and quantiles are of its specimens.

    Parameters
    ----------
    what : Scene, Ensemble, str or Path
        A scene, whose surfaces are drawn at separations that suit the table; or an ensemble or its file, with
        its own separations. Tables against the pressure are made from the scene of either.
    path : str or Path
        Of the table of means; those of quantiles lie beside it, such as ``NAME.q05.inp``, and all
        together as ``NAME.all.csv``.
    to : {"calculix", "abaqus", "moose", "comsol", "json"}
        The program; "json": one file with everything in SI units, for any other.
    table : {"pressure-gap", "conductance-pressure", "conductance-gap", "stiffness-pressure"}
        What is tabulated, against what. Stiffness and conductance are per nominal area;
        conductance is that of the joint, where the scene has one.
    points : int, optional
        Rows, besides the one where nothing is carried. Default: 40.
    pressures : array_like or sequence of str, optional
        Nominal pressures of the rows, rising, Pa or text such as "1 MPa"; against the gap those of the
        mean surface, or bounds, where there is an ensemble. Default: those that the scene's separations
        span, on the mean surface.
    quantiles : sequence of float, optional
        Default: 0.05 and 0.95, or none where there are not several surfaces.
    units : {"SI", "mm-N-s"}
        Of the files.

    Returns
    -------
    list of Path
        The files: mean, quantiles, all.

    Raises
    ------
    ValueError
        If a program does not take a table or the name of a file, a scene has none, or an argument is wrong.
    SceneError
        If a pressure is none.
    StoreError
        If the ensemble cannot be read.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 3], n_surfaces=50, seed=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     files = mcgw.export(scene, f"{folder}/soft.inp", to="abaqus", units="mm-N-s")
    >>> [file.name for file in files]
    ['soft.inp', 'soft.q05.inp', 'soft.q95.inp', 'soft.all.csv']
    """
    if to == "json" and (table, quantiles, units) != ("pressure-gap", None, "SI"):
        raise ValueError('to = "json": it has all columns, in SI units; leave out table, quantiles, units')
    given = {"to": to, "table": table, "units": units, "points": points}
    given |= {"pressures": pressures, "quantiles": quantiles}
    asked = arguments({name: value for name, value in given.items() if value is not None}, _ARGUMENTS)
    wanted, kind = np.array(asked["pressures"]) if "pressures" in asked else None, KINDS[table]
    if wanted is not None and np.any(np.diff(wanted) <= 0):
        raise ValueError(f"pressures = {wanted.tolist()!r}: give two or more increasing numbers")
    if to != "json" and not re.fullmatch(r"[A-Za-z0-9._+-]{1,64}", name := Path(path).name):
        raise ValueError(
            f"path = {name!r}: {to} includes it by name; give a name of at most 64 letters, digits and "
            ". _ + -"
        )
    if to != "json" and table not in (taken := PROGRAMS[to].tables):
        raise ValueError(f"table = {table!r}: {to} does not support it; choose one of {', '.join(taken)}")
    source = open_ensemble(what) if isinstance(what, str | Path) else what
    if not isinstance(source, Scene | Ensemble):
        raise ValueError(f"{type(what).__name__}: give a scene, an ensemble, or the file of an ensemble")
    scene = source if isinstance(source, Scene) else source.scene
    if isinstance(what, str | Path):
        digest = f"data {read_attributes(Path(what))['digest']}"
    else:  # without numbers in a file, that of the scene
        digest = f"scene {sha256(scene_text(scene).encode()).hexdigest()}"
    if to == "json":
        text = json.dumps(_contact_table(source, wanted, points, digest), indent=1, allow_nan=False)
        write_whole(Path(path), text.encode())
        return [Path(path)]
    if kind.quantity == "conductance" and scene.film is None:
        raise ValueError(
            "joint.conductivities: missing for a table of conductance; give conductivities = [k1, k2] in "
            "W/(m K), or resistivity, in the scene"
        )
    shares = asked.get("quantiles", _QUANTILES if source.n_surfaces > 1 else ())
    if kind.against == "gap":
        x, curves = at_gaps(source, kind, wanted, points, shares)
    else:
        x, curves = at_pressures(scene, kind, wanted, points, shares)
    columns = dict(zip(["mean", *map(quantile_name, shares)], curves, strict=True))
    check_monotone(kind, x, columns)
    carried = columns["mean"] > 0
    origin = f"mcgw {version('mcgw')}; SHA-256 of the {digest}"
    sheet = Sheet(scene, source.n_surfaces, kind, PROGRAMS[to], units, origin)
    files = files_of_export(path, shares)
    (per_x, unit_x), (per_y, unit_y) = sheet.unit(kind.against), sheet.unit(kind.quantity)
    every = [Column(kind.against, per_x * x[carried], unit=unit_x)]
    with together():
        for file, (name, y) in zip(files, columns.items(), strict=False):
            some = carried & (y > 0)  # a quantile may carry nothing where the mean does
            text = sheet.text(name, per_x * x[some], per_y * y[some], file.name)
            write_whole(file, text.encode("ascii", "replace"))
            values = np.where(some, (per_y * y).astype(object), "")[carried].tolist()
            every.append(Column(f"{kind.quantity} {name}", values, unit=unit_y))
        Table(tuple(every)).write(files[-1], comment=f"{kind.name}; SHA-256 of the {digest}")
    return files


def files_of_export(path: str | Path, quantiles: Sequence[float] | None = None) -> list[Path]:
    """File of each curve, the mean first, and the file of all curves."""
    path = Path(path)
    names = map(quantile_name, _QUANTILES if quantiles is None else quantiles)
    beside = [path.with_name(f"{path.stem}.{name}{path.suffix}") for name in names]
    return [path, *beside, path.with_name(f"{path.stem}.all.csv")]


def _contact_table(source: Scene | Ensemble, pressures: Any, points: int, digest: str) -> dict[str, Any]:
    """Return what a file holds, by ``contact-table.schema.json``: means where they carry a load, SI."""
    scene = source if isinstance(source, Scene) else source.scene
    conducts = scene.film is not None and (source is scene or "conductance_si" in scene.quantities)
    needs = ("load", "area", *["conductance_si"] * conducts)
    ensemble = surfaces_for(source, needs, pressures, points)
    scene, order = ensemble.scene, np.argsort(ensemble.separations)
    order = order[ensemble.mean("pressure")[order] > 0]
    gap, pressure = ensemble.separations[order] * scene.surface.sigma, ensemble.mean("pressure")[order]
    check_monotone(KINDS["pressure-gap"], gap, {"mean": pressure})
    conductance = covariance = None
    if conducts:
        conductance = ensemble.mean(KINDS["conductance-gap"].answer(scene))[order].tolist()
    if ensemble.n_surfaces > 1:
        covariance = ensemble.covariance("pressure")[np.ix_(order, order)].tolist()
    return {
        "format": "mcgw-contact-table-1",
        "units": {"gap": "m", "pressure": "Pa", "area": "1", "conductance": "per nominal area"},
        "gap": gap.tolist(),
        "pressure": pressure.tolist(),
        "area": ensemble.mean("area_fraction")[order].tolist(),
        "conductance": conductance,
        "covariance": covariance,
        "provenance": {
            "program": f"mcgw {version('mcgw')}",
            "digest": digest,
            "scene": scene_text(scene),
            "surfaces": ensemble.n_surfaces,
            "seed": scene.seed,
            "nominal_area": scene.surface.nominal_area,
        },
        "validity": scene.validity().verdict,
    }


def surfaces_for(
    source: Scene | Ensemble, needs: tuple[str, ...], pressures: Array | None, points: int
) -> Ensemble:
    """Return the ensemble itself; of a scene its surfaces, with only what a table against the gap needs.

    They are drawn at so many separations, evenly between the lowest and the highest of the scene, or at those
    where the mean surface has the pressures.
    """
    if isinstance(source, Ensemble):
        if missing := [name for name in needs if name not in source.scene.quantities]:
            raise ValueError(
                f"contact.quantities: the ensemble has no {', '.join(missing)}; give its scene instead"
            )
        return source
    h = np.linspace(min(source.separations), max(source.separations), points)
    if pressures is not None:
        h = np.array([float(source.theory.separation_at("pressure", p)) for p in pressures])
    changes = {"keep": "sums", "unload_from": None, "rel_err": None, "max_seconds": None}
    return simulate(source.replace(separations=tuple(h.tolist()), quantities=needs, **changes))


def at_gaps(
    source: Scene | Ensemble, kind: Kind, pressures: Array | None, points: int, shares: tuple[float, ...]
) -> Curves:
    """Return mean and quantiles of these shares over surfaces at equal gap, m.

    The pressures are those of the rows of a scene; the first and the last bound those of an ensemble, which
    has its own separations.
    """
    needs = ("load", "conductance_si") if kind.quantity == "conductance" else ("load",)
    ensemble = surfaces_for(source, needs, pressures, points)
    h, rows = np.unique(ensemble.separations, return_index=True)
    mean = ensemble.mean("pressure")[rows]
    if np.any(mean < 0):
        raise ValueError(
            f"contact.law: surfaces attract each other (mean pressure {mean.min():.3g} Pa at d/sigma = "
            f"{h[np.argmin(mean)]:g}), and a contact table has no negative pressures; give a law without "
            "adhesion"
        )
    if ensemble is source:
        if pressures is not None:
            rows = rows[(mean >= pressures[0] * (1 - 1e-9)) & (mean <= pressures[-1] * (1 + 1e-9))]
        rows = rows[evenly(len(rows), points)]
    some = ensemble
    if shares and ensemble.scene.keep == "statistics":  # its first surfaces are drawn again
        drawn = ensemble.scene.drawn_by(ensemble.sampler)
        some = simulate(drawn, keep="sums", n_surfaces=min(ensemble.n_surfaces, _MOST))
    name = kind.answer(ensemble.scene)
    values = [ensemble.mean(name)[rows], *(some.quantile(name, share)[rows] for share in shares)]
    return ensemble.separations[rows] * ensemble.scene.surface.sigma, values


def at_pressures(
    scene: Scene, kind: Kind, pressures: Array | None, points: int, shares: tuple[float, ...]
) -> Curves:
    """Return mean and quantiles over specimens that all carry the same load: those of `mcgw.solve`."""
    x = pressures_of(scene, points) if pressures is None else pressures
    area, name = scene.surface.nominal_area, kind.answer(scene)
    solved = solutions(scene, "load", (area * x).tolist())
    per = area if kind.quantity == "stiffness" else 1.0
    values = [np.array([each.value[name] for each in solved])]
    values += [np.array([np.quantile(each.surfaces[name], share) for each in solved]) for share in shares]
    return x, [each / per for each in values]


def check_monotone(kind: Kind, x: Array, columns: dict[str, Array]) -> None:
    """Refuse a mean or quantile that is not monotone where it carries something."""
    for name, every in columns.items():
        at, y = x[every > 0], every[every > 0]
        if at.size < 2:
            raise ValueError(
                f"{kind.name}, {name}: {at.size} point(s) with load; give more or smaller separations, or a "
                "wider range of pressures"
            )
        steps = np.diff(y) * (-1 if kind.against == "gap" else 1)
        if np.any(steps <= 0):
            worst = at[int(np.argmin(steps))]
            raise ValueError(
                f"{kind.name}, {name}: is not monotone at {kind.against} = {worst:.4g}, as programs require; "
                "give more surfaces, fewer points, or a contact law without jumps"
            )


def quantile_name(quantile: float) -> str:
    """Name of a quantile in file names: q05 for 0.05."""
    return f"q{100 * quantile:02.6g}"

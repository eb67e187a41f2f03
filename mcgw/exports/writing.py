"""``mcgw.export``: write a table, one file for each curve and one for all."""

import json
from collections.abc import Sequence
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.exports.contact_table import contact_table
from mcgw.exports.curves import CONDUCTING, CONTACT, KINDS, Kind, curves_at_gaps, curves_at_pressures
from mcgw.exports.programs import PROGRAMS, Program, check_name
from mcgw.exports.table_text import UNIT_SYSTEMS, UnitSystem, all_curves, heading, in_units, table_text
from mcgw.formats.files import write_whole
from mcgw.scene.arguments import argument, as_toml
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.store.ensembles import open_ensemble, read_attributes

DEFAULT_POINTS, DEFAULT_QUANTILES = 40, (0.05, 0.95)
_MOST_POINTS = 10_000


def export(
    what: Scene | Ensemble | str | Path,
    path: str | Path,
    *,
    to: str,
    table: str = "pressure-gap",
    points: int = DEFAULT_POINTS,
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
    if to == "json":
        if (table, quantiles, units) != ("pressure-gap", None, "SI"):
            raise ValueError(
                'to = "json": it has all columns, in SI units; leave out table, quantiles, units'
            )
        return [_contact_table(what, Path(path), _pressures(pressures), points)]
    program, kind, system = _asked(to, table, units)
    check_name(Path(path).name, program)
    wanted = _pressures(pressures)
    _check_points(points)
    source, digest = _source(what)
    scene = source if isinstance(source, Scene) else source.scene
    checked(scene, kind)
    surfaces = scene.n_surfaces if source is scene else source.n_surfaces
    shares = _quantiles(quantiles, surfaces)
    if kind.against == "pressure":
        curves = curves_at_pressures(scene, kind, wanted, points, shares)
    else:
        ensemble = _drawn(source, kind, wanted, points)
        bounds, rows = wanted, points
        if wanted is not None and ensemble is not source:
            bounds, rows = None, len(wanted)  # drawn at the separations of the rows
        curves = curves_at_gaps(ensemble, kind, bounds, rows, shares)
    files = files_of_export(path, [curve.name for curve in curves])
    scaled = [in_units(curve, kind, system) for curve in curves]
    texts = [
        table_text(
            curve,
            kind,
            program,
            system,
            heading(scene, surfaces, kind, curve, system, digest),
            file.name,
            stays=kind.stays(scene),
        )
        for file, curve in zip(files, scaled, strict=False)
    ]
    for file, text in zip(files, texts, strict=False):
        write_whole(file, [text.encode("ascii", "replace")])
    all_curves(scaled, kind, system, scene).write(files[-1], comment=f"{kind.name}; SHA-256 of the {digest}")
    return files


def _contact_table(
    what: Scene | Ensemble | str | Path, path: Path, pressures: Array | None, points: int
) -> Path:
    """All columns against the gap, with their provenance."""
    _check_points(points)
    source, digest = _source(what)
    scene = source if isinstance(source, Scene) else source.scene
    conducts = scene.film is not None and (scene is source or "conductance_si" in scene.quantities)
    ensemble = _drawn(source, CONDUCTING if conducts else CONTACT, pressures, points)
    text = json.dumps(contact_table(ensemble, digest), indent=1, allow_nan=False)
    write_whole(path, [text.encode()])
    return path


def _drawn(source: Scene | Ensemble, kind: Kind, pressures: Array | None, points: int) -> Ensemble:
    """The ensemble itself, or that of a scene."""
    if isinstance(source, Scene):
        return surfaces_for(source, kind, pressures, points)
    if missing := [name for name in kind.needs if name not in source.scene.quantities]:
        raise ValueError(
            f"contact.quantities: the ensemble has no {', '.join(missing)}; give its scene instead"
        )
    return source


def files_of_export(path: str | Path, names: Sequence[str]) -> list[Path]:
    """File of each curve, the mean first, and the file of all curves."""
    path = Path(path)
    beside = [path.with_name(f"{path.stem}.{name}{path.suffix}") for name in names[1:]]
    return [path, *beside, path.with_name(f"{path.stem}.all.csv")]


def _asked(to: str, table: str, units: str) -> tuple[Program, Kind, UnitSystem]:
    for key, value, known in (("to", to, PROGRAMS), ("table", table, KINDS), ("units", units, UNIT_SYSTEMS)):
        if value not in known:
            raise ValueError(f"{key} = {value!r}: choose one of {', '.join(known)}")
    program = PROGRAMS[to]
    if table not in program.keywords:
        raise ValueError(
            f"table = {table!r}: {to} does not support it; choose one of {', '.join(program.keywords)}"
        )
    return program, KINDS[table], UNIT_SYSTEMS[units]


def _check_points(points: int) -> None:
    if isinstance(points, bool) or not isinstance(points, int) or not 2 <= points <= _MOST_POINTS:
        raise ValueError(f"points = {points!r}: give a whole number from 2 to {_MOST_POINTS}")


def _pressures(given: Any) -> Array | None:
    if given is None:
        return None
    plain = as_toml(given)
    listed = plain if isinstance(plain, list) else [plain]
    found = np.array([argument("pressures", x, "Pa") for x in listed])
    if found.size < 2 or np.any(np.diff(found) <= 0):
        raise ValueError(f"pressures = {listed!r}: give two or more increasing numbers")
    return found


def _quantiles(given: Sequence[float] | None, n_surfaces: int) -> tuple[float, ...]:
    if given is None:
        return DEFAULT_QUANTILES if n_surfaces > 1 else ()
    found = tuple(float(q) for q in given)
    wrong = [q for q in found if not 0 < q < 1]
    if wrong or len(set(found)) < len(found):
        raise ValueError(
            f"quantiles = {list(found)!r}: give numbers between 0 and 1, each once, such as 0.05"
        )
    return found


def _source(what: Scene | Ensemble | str | Path) -> tuple[Scene | Ensemble, str]:
    """A scene or an ensemble, with the digest of its numbers or, without numbers, of its scene."""
    if isinstance(what, str | Path):
        return open_ensemble(what), f"data {read_attributes(Path(what))['digest']}"
    if not isinstance(what, Scene | Ensemble):
        raise ValueError(f"{type(what).__name__}: give a scene, an ensemble, or the file of an ensemble")
    scene = what if isinstance(what, Scene) else what.scene
    return what, f"scene {sha256(scene_text(scene).encode()).hexdigest()}"


def checked(scene: Scene, kind: Kind) -> None:
    """Refuse a scene without such a table.

    Raises
    ------
    ValueError
        With what the scene lacks.
    """
    if kind.quantity == "conductance" and scene.film is None:
        raise ValueError(
            "contact.conductivities: missing for a table of conductance; give conductivities = [k1, k2] in "
            "W/(m K), or resistivity, in the scene"
        )


def surfaces_for(scene: Scene, kind: Kind, pressures: Array | None, points: int) -> Ensemble:
    """Draw the surfaces of a scene with only what a table against the gap needs.

    Parameters
    ----------
    scene : Scene
        Its surfaces; its lowest and highest separations bound the table where no pressures are given.
    kind : Kind
        Of table.
    pressures : ndarray or None
        Of the table, Pa.
    points : int
        Rows of the table.

    Returns
    -------
    Ensemble
        In memory, at as many separations as there are points, or at those where the mean surface has the
        pressures.
    """
    if pressures is None:
        h = np.linspace(min(scene.separations), max(scene.separations), points)
    else:
        h = np.array([float(scene.theory.separation_at("pressure", p)) for p in pressures])
    return simulate(
        replace(
            scene, separations=tuple(h.tolist()), quantities=kind.needs, keep="sums", unload_from=None,
            rel_err=None, max_seconds=None,
        )
    )  # fmt: skip

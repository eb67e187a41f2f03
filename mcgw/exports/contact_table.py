"""Contact tables as JSON, which any program can read, with their provenance; and as a law to evaluate."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, hold
from mcgw.ensemble.ensemble import Ensemble
from mcgw.errors import StoreError
from mcgw.exports.curves import KINDS
from mcgw.formats.files import write_whole
from mcgw.scene.scene_file import scene_text

FORMAT = "mcgw-contact-table-1"
SCHEMA = Path(__file__).with_name("contact-table.schema.json")
COLUMNS = {"gap": "m", "pressure": "Pa", "area": "1", "conductance": "per nominal area"}


@dataclass(frozen=True)
class ContactTable:
    """Pressure, real area and contact conductance of a joint against its gap, as a law to interpolate.

    Parameters
    ----------
    gap : ndarray
        Distance of the rigid plane from the mean plane of the summits, rising, m.
    pressure : ndarray
        Mean pressure over surfaces, falling, Pa.
    area : ndarray
        Real area over nominal area.
    conductance : ndarray, optional
        Conductance per nominal area, W/(m^2 K) or S/m^2, of the whole joint if gas is in its gap; None where
        nothing conducts.
    covariance : ndarray, optional
        Covariance of the pressures over surfaces of the nominal area, Pa^2, shape (rows, rows); None for a
        single surface.
    provenance : mapping
        Program, digest, scene, number of surfaces, seed, nominal area.
    validity : str
        Error of the model against elasticity, in words.

    Raises
    ------
    ValueError
        If columns are not of one length and finite, gaps do not rise, pressures do not fall, or anything else
        is not > 0.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 3], n_surfaces=50, seed=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     (file,) = mcgw.export(scene, f"{folder}/pad.json", to="json")
    ...     law = mcgw.ContactTable.read(file)
    >>> float(law("pressure", law.gap_at(1e6)).round(3))
    1000000.0
    """

    gap: Array
    pressure: Array
    area: Array
    conductance: Array | None = None
    covariance: Array | None = None
    provenance: Mapping[str, Any] = field(default_factory=dict)
    validity: str = ""

    def __post_init__(self) -> None:
        for name in (*COLUMNS, "covariance"):
            given = getattr(self, name)
            if given is None and name in ("conductance", "covariance"):
                continue
            column = np.array(given, dtype=np.float64)
            hold(self, **{name: column})
            if name == "covariance":
                if column.shape != 2 * self.gap.shape:
                    raise ValueError("covariance: give a square matrix with as many rows as gaps")
            elif column.shape != self.gap.shape or column.ndim != 1 or len(column) < 2:
                raise ValueError(f"{name}: give two numbers or more, as many as gaps")
            elif not np.all(np.isfinite(column)) or (name != "gap" and np.any(column <= 0)):
                raise ValueError(f"{name}: give finite numbers > 0")
        if np.any(np.diff(self.gap) <= 0) or np.any(np.diff(self.pressure) >= 0):
            raise ValueError("give increasing gaps with decreasing pressures")

    @classmethod
    def of(cls, ensemble: Ensemble, digest: str) -> Self:
        """Make the table of means over the surfaces of an ensemble, where any of them carries a load."""
        scene = ensemble.scene
        order = np.argsort(ensemble.separations)
        order = order[ensemble.mean("pressure")[order] > 0]
        area = scene.surface.nominal_area
        conducts = "conductance_si" in scene.quantities
        several = ensemble.n_surfaces > 1
        return cls(
            gap=ensemble.separations[order] * scene.surface.sigma,
            pressure=ensemble.mean("pressure")[order],
            area=ensemble.mean("area_fraction")[order],
            conductance=ensemble.mean(KINDS["conductance-gap"].answer(scene))[order] if conducts else None,
            covariance=ensemble.covariance("pressure")[np.ix_(order, order)] if several else None,
            provenance={
                "program": f"mcgw {version('mcgw')}", "digest": digest, "scene": scene_text(scene),
                "surfaces": ensemble.n_surfaces, "seed": scene.seed, "nominal_area": area,
            },
            validity=scene.validity().verdict,
        )  # fmt: skip

    def __call__(self, name: str, gap: ArrayLike) -> Array:
        """A column at other gaps, interpolated without overshoot in its logarithm.

        Raises
        ------
        ValueError
            If there is no such column, or a gap is outside of the table.
        """
        from scipy.interpolate import PchipInterpolator

        column = getattr(self, name) if name in COLUMNS else None
        if column is None:
            raise ValueError(f"{name!r}: the table has no such column")
        x = np.asarray(gap, dtype=np.float64)
        low, high = self._ends
        if np.any((x < low) | (x > high)):
            raise ValueError(f"gap = {gap!r}: the table has {self.gap[0]:.4g} to {self.gap[-1]:.4g} m")
        return np.asarray(np.exp(PchipInterpolator(self.gap, np.log(column))(x)))

    def gap_at(self, pressure: float) -> float:
        """The gap at a pressure, m.

        Raises
        ------
        ValueError
            If the pressure is outside the table.
        """
        from scipy.optimize import brentq

        low, high = self.pressure[-1], self.pressure[0]
        if not low <= pressure <= high:
            raise ValueError(f"pressure = {pressure!r}: the table has {low:.4g} to {high:.4g} Pa")
        return float(brentq(lambda x: float(self("pressure", x)) / pressure - 1, *self._ends, xtol=1e-18))

    @property
    def _ends(self) -> tuple[float, float]:
        """Of the gaps, with room for rounding, m."""
        slack = 1e-12 * float(self.gap[-1])
        return float(self.gap[0]) - slack, float(self.gap[-1]) + slack

    def write(self, path: str | Path) -> None:
        """Write the table as JSON; the file is never left half-written."""
        columns = {name: getattr(self, name) for name in (*COLUMNS, "covariance")}
        rows = {name: None if x is None else x.tolist() for name, x in columns.items()}
        whole = {
            "format": FORMAT, "units": COLUMNS, **rows,
            "provenance": dict(self.provenance), "validity": self.validity,
        }  # fmt: skip
        write_whole(Path(path), [json.dumps(whole, indent=1, allow_nan=False).encode()])

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """Read a table from its file.

        Raises
        ------
        StoreError
            If the file is not such a table; the line says why.
        """
        try:
            whole = json.loads(Path(path).read_bytes())
            if whole["format"] != FORMAT:
                raise ValueError(f"format {whole['format']!r} is not {FORMAT!r}")
            names = *COLUMNS, "covariance", "provenance", "validity"
            return cls(**{name: whole[name] for name in names})
        except (OSError, ValueError, KeyError, TypeError) as error:
            said = f"it has no {error}" if isinstance(error, KeyError) else error
            raise StoreError(f"{path}: not a contact table: {said}") from error

"""Sweeps: many scenes on the same surfaces; and opening a result file of either kind."""

from pathlib import Path
from typing import TYPE_CHECKING

from mcgw.ensemble.ensemble import Ensemble
from mcgw.store.ensembles import open_ensemble, read_attributes

if TYPE_CHECKING:
    from mcgw.sweeps.sweep import Sweep


def open_results(path: Path) -> "Ensemble | Sweep":
    """Open an ensemble, a sweep or a run in progress; errors as of `open_ensemble` and `open_sweep`."""
    if "axes" not in read_attributes(path):
        return open_ensemble(path)
    from mcgw.sweeps.file import open_sweep  # imports the samplers

    return open_sweep(path)

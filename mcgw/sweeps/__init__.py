"""Sweeps: many scenes as one question; and a file of results opened as what it is, one scene or many."""

from pathlib import Path
from typing import TYPE_CHECKING

from mcgw.ensemble.ensemble import Ensemble
from mcgw.store.ensembles import open_ensemble, read_attributes

if TYPE_CHECKING:
    from mcgw.sweeps.sweep import Sweep


def open_results(path: Path) -> "Ensemble | Sweep":
    """Open whatever a file holds, or a run in progress; errors as of `open_ensemble` and `open_sweep`."""
    if "axes" not in read_attributes(path):
        return open_ensemble(path)
    from mcgw.sweeps.file import open_sweep  # which loads what draws

    return open_sweep(path)

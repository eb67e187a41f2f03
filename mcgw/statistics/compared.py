"""``mcgw.compare``: an ensemble, or all points of a sweep, against theory."""

from typing import TYPE_CHECKING, overload

from mcgw.ensemble.ensemble import Ensemble
from mcgw.machine.progress import Progress
from mcgw.scene.wrong_object import check_object
from mcgw.statistics import comparison
from mcgw.statistics.comparison import Comparison

if TYPE_CHECKING:
    from mcgw.statistics.sweep_comparison import SweepComparison
    from mcgw.sweeps.sweep import Sweep

__all__ = ["compare"]


@overload
def compare(result: Ensemble, *, progress: Progress = None) -> Comparison: ...
@overload
def compare(result: "Sweep", *, progress: Progress = None) -> "SweepComparison": ...
def compare(result: "Ensemble | Sweep", *, progress: Progress = None) -> "Comparison | SweepComparison":
    """Compare the means of an ensemble, or those of every point of a sweep, with theory.

    Parameters
    ----------
    result : Ensemble or Sweep
        Of independent surfaces.
    progress : bool or callable, optional
        Of a sweep. True: a bar; a function: called with (done, total) points.

    Returns
    -------
    Comparison or SweepComparison
        Curves and verdict; of a sweep its points, with one verdict on all of them.

    Raises
    ------
    ValueError
        If the surfaces are stratified: their fluctuations are not those of an ensemble.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1], n_surfaces=100, seed=1)
    >>> mcgw.compare(mcgw.simulate(scene)).verdict.agrees
    True
    >>> mcgw.compare(mcgw.sweep(scene, {"grading.gamma": [0.5, 2.0]})).verdict.agrees
    True
    """
    if not isinstance(result, Ensemble):
        from mcgw.statistics.sweep_comparison import compare_sweep  # which loads what draws
        from mcgw.sweeps.sweep import Sweep

        if isinstance(result, Sweep):
            return compare_sweep(result, progress=progress)
    check_object("compare", result, Ensemble)
    return comparison.compare(result)

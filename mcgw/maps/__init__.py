"""Height maps and profiles: synthetic ones are written, measured ones are read and fitted by `mcgw.fit`.

>>> import numpy as np
>>> from mcgw.maps import Spectrum, gaussian_map
>>> spectrum, rng = Spectrum(rms=1e-6, long=50e-6, short=5e-6), np.random.default_rng(1)
>>> z = gaussian_map(spectrum, (64, 64), (1e-6, 1e-6), rng)
>>> z.heights.shape, z.periodic
((64, 64), True)
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcgw.maps.heights_files import read_heights as read_heights, read_map as read_map
    from mcgw.maps.map_files import write_map as write_map
    from mcgw.maps.synthetic import (
        Asperities as Asperities,
        Spectrum as Spectrum,
        asperities_of as asperities_of,
        gaussian_map as gaussian_map,
        moments_on_grid as moments_on_grid,
        spectrum_from as spectrum_from,
    )
    from mcgw.maps.topography import Profile as Profile, Topography as Topography

# Where names come from; they are imported on first use, as those of `mcgw` are.
_HOMES = {
    "map_files": "write_map",
    "heights_files": "read_heights read_map",
    "synthetic": "Asperities Spectrum asperities_of gaussian_map moments_on_grid spectrum_from",
    "topography": "Profile Topography",
}
_HOME = {name: f"mcgw.maps.{module}" for module, names in _HOMES.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'mcgw.maps' has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)

"""Height maps and profiles: synthetic ones are written, measured ones are read and fitted by `mcgw.fit`.

>>> import numpy as np
>>> from mcgw.maps import Spectrum, gaussian_map
>>> spectrum, rng = Spectrum(rms=1e-6, long=50e-6, short=5e-6), np.random.default_rng(1)
>>> z = gaussian_map(spectrum, (64, 64), (1e-6, 1e-6), rng)
>>> z.heights.shape, z.periodic
((64, 64), True)
"""

from importlib import import_module
from typing import Any

from mcgw.machine.door import homes_of_names

_HOME = homes_of_names(__file__)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'mcgw.maps' has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)

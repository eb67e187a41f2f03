# Public names and where they come from; `mcgw/maps/__init__.py` imports each on first use.

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

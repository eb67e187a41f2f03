"""A stand-in for SurfaceTopography, which does what the words of a file ask for."""

from pathlib import Path

import numpy as np


class Channel:
    dim, unit, is_periodic, physical_sizes, height_scale_factor = 2, "um", False, (3.0, 1.0), None

    def __init__(self, path, columns, rows):
        self.path, self.nb_grid_pts = path, (columns, rows)
        sizes = self.physical_sizes or (columns, rows)
        self.pixel_size = tuple(length / n for length, n in zip(sizes, self.nb_grid_pts, strict=True))
        self.default_channel, self.height_channels = None, [self]

    def topography(self):
        self.path.with_name("read").touch()
        return self

    def heights(self):
        return np.arange(6.0).reshape(self.nb_grid_pts)


class Line(Channel):
    dim = 1

    def positions_and_heights(self):
        x = np.arange(float(self.nb_grid_pts[0])) * 0.5
        self.path.with_name("read").touch()
        return x, np.ma.masked_array(x * x, mask=x == 2.0)


class Unknown(Line):
    unit = None


class Bare(Channel):
    physical_sizes, unit, is_periodic = None, None, True

    def topography(self, physical_sizes):
        assert physical_sizes == self.nb_grid_pts
        return self

    def heights(self):
        found = np.ma.masked_array(super().heights(), mask=False)
        found[0, 1], found[2, 0] = np.ma.masked, np.nan
        return found


def open_topography(path):
    path = Path(path)
    words = path.read_text().split()
    if kind := {"line": Line, "unknown": Unknown, "bare": Bare}.get(words[0]):
        return kind(path, *map(int, words[1:3]))
    if words[0] == "silent":
        raise ValueError
    if words[0] == "greedy":
        raise MemoryError
    if words[0] == "deep":
        raise RecursionError("maximum recursion depth exceeded")
    if words[0] == "current":
        only = Channel(path, 3, 2)
        only.height_channels, only.channels, only.name, only.data_unit = [], [only], "I", "nA"
        only.default_channel = only
        return only
    return Channel(path, int(words[0]), int(words[1]))

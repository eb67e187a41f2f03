"""Files of instruments, made by hand as their formats are described, and read by SurfaceTopography."""

import struct

import numpy as np
import pytest

from mcgw.maps import read_map

pytest.importorskip("SurfaceTopography")
pytestmark = pytest.mark.filterwarnings("ignore")

NM = np.array([[1, 2, 3, 4], [4, np.nan, 6, 7], [7, 8, 9, 10], [5, 3, 2, 0]])  # what each holds, nm
PIXEL = (1.5e-6, 4e-6)


def sdf(code, dtype, missing):
    """Binary SDF (ISO 25178-71) of one type of numbers, with its mark of a missing point."""
    rows, columns = NM.shape
    head = b"bISO-1.0", b"", b"", b"", columns, rows, *PIXEL, 1e-9, 0, 0, code, 0
    raw = np.where(np.isnan(NM), missing, NM).astype(dtype)
    return struct.pack("<8s10s12s12sHHddddBBB", *head) + raw.tobytes()


MARKS = {"<u2": (1, 2**16 - 1), "<i2": (5, -(2**15)), "<i4": (6, -(2**31)),
         "<f4": (3, np.finfo("f4").min), "<f8": (7, np.finfo("f8").min)}  # fmt: skip
FILES = {f"{dtype[1:]}.sdf": sdf(code, dtype, mark) for dtype, (code, mark) in MARKS.items()}


@pytest.mark.parametrize("name", FILES)
def test_heights_pixel_and_missing_points(name, tmp_path):
    """The first channel of heights, in single precision where the file has no more."""
    (tmp_path / name).write_bytes(FILES[name])
    found = read_map(tmp_path / name)
    assert found.heights == pytest.approx(1e-9 * NM, nan_ok=True, rel=1e-6)
    assert found.pixel == pytest.approx(PIXEL, rel=1e-9)
    assert (found.missing, found.assumed_unit) == (1, "")

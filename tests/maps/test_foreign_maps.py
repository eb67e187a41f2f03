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


def al3d():
    """Alicona: lines of a name, a value and an end; rows of heights in m, padded to eight bytes."""
    tags = {"Cols": 4, "Rows": 4, "PixelSizeXMeter": 1.5e-6, "PixelSizeYMeter": 4e-6}
    tags |= {"InvalidPixelValue": "1.e9", "DepthImageOffset": 17 + 52 * 8 + 256}
    lines = {"Version": 1, "TagCount": len(tags), **tags}
    head = b"".join(struct.pack("<20s30s2s", k.encode(), str(v).encode(), b"\r\n") for k, v in lines.items())
    heights = np.where(np.isnan(NM), 1e9, 1e-9 * NM).astype("<f4")
    return b"AliconaImaging\0\r\n" + head + bytes(256) + heights.tobytes()


def gwy():
    """Gwyddion with two channels, the first of volts, and a mask on the heights."""

    def item(name, kind, data):
        return f"{name}\0{kind}".encode() + data

    def thing(name, *items):
        return f"{name}\0".encode() + struct.pack("<L", len(b"".join(items))) + b"".join(items)

    def array(values):
        return struct.pack("<L", values.size) + values.astype("<f8").tobytes()

    def field(values, unit):
        sizes = [item("xreal", "d", struct.pack("<d", 6e-6)), item("yreal", "d", struct.pack("<d", 16e-6))]
        points = [item(name, "i", struct.pack("<i", 4)) for name in ("xres", "yres")]
        units = [
            item(f"si_unit_{axis}", "o", thing("GwySIUnit", item("unitstr", "s", f"{text}\0".encode())))
            for axis, text in (("xy", "m"), ("z", unit))
        ]
        return thing("GwyDataField", *points, *sizes, *units, item("data", "D", array(values)))

    missing = np.isnan(NM)
    return b"GWYP" + thing(
        "GwyContainer",
        item("/0/data", "o", field(NM * 7, "V")),
        item("/1/data", "o", field(np.where(missing, 5, NM) * 1e-9, "m")),
        item("/1/mask", "o", field(1.0 * missing, "")),
    )


def ibw():
    """Igor binary wave, version 5: two layers, of which labels name the first the height."""
    layers = np.stack([NM[::-1] * 1e-9, NM * 7]).astype("<f4")  # rows from the bottom up
    labels = b"".join(name.ljust(32, b"\0") for name in (b"", b"HeightTrace", b"PhaseTrace"))
    note = b"Version: 1\r"
    start = struct.pack("<hhiiii4i4iiii", 5, 0, 320 + layers.nbytes, 0, len(note), 0, *[0] * 4,
                        0, 0, len(labels), 0, 0, 0, 0)  # fmt: skip
    wave = struct.pack("<IIIihh6xh32siI4i", 0, 0, 0, layers.size, 2, 0, 1, b"map", 0, 0, 4, 4, 2, 0)
    scales = struct.pack(
        "<8d4s4s4s4s4shhdd", *PIXEL, 1, 1, 0, 0, 0, 0, b"m", b"m", b"m", b"", b"", 0, 0, 0, 0
    )
    return start + (wave + scales).ljust(320, b"\0") + layers.tobytes() + note + labels


MARKS = {"<u2": (1, 2**16 - 1), "<i2": (5, -(2**15)), "<i4": (6, -(2**31)),
         "<f4": (3, np.finfo("f4").min), "<f8": (7, np.finfo("f8").min)}  # fmt: skip
FILES = {f"{dtype[1:]}.sdf": sdf(code, dtype, mark) for dtype, (code, mark) in MARKS.items()}
FILES |= {"map.al3d": al3d(), "map.gwy": gwy(), "map.ibw": ibw()}


@pytest.mark.parametrize("name", FILES)
def test_heights_pixel_and_missing_points(name, tmp_path):
    """The first channel of heights, in single precision where the file has no more."""
    (tmp_path / name).write_bytes(FILES[name])
    found = read_map(tmp_path / name)
    assert found.heights == pytest.approx(1e-9 * NM, nan_ok=True, rel=1e-6)
    assert found.pixel == pytest.approx(PIXEL, rel=1e-9)
    assert (found.missing, found.assumed_unit) == (1, "")

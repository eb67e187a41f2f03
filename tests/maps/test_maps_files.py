"""Files of maps: every digit back, other people's readers, and damaged ones refused in one line."""

import json
import math
import re
import struct
from datetime import UTC, datetime, timedelta

import h5py
import numpy as np
import pytest
from oracles.inside import envelope, smooth

from mcgw.maps import (
    Asperities,
    Spectrum,
    Topography,
    gaussian_map,
    read_heights,
    read_map,
    spectrum_from,
    write_map,
)
from mcgw.maps.topography import checked_shape


@pytest.fixture
def topography():
    """Neither square nor symmetric, so that a turned or mirrored map is another one."""
    return Topography(1e-6 * np.random.default_rng(1).normal(size=(5, 7)), (1e-6, 2.5e-6))


BY_HAND = np.array([[1, 2, 3], [4, np.nan, 6]])  # what each of the files below holds, in nm


def test_other_files_made_by_hand(tmp_path):
    """Sizes along x and y, units, and missing points."""
    np.save(tmp_path / "a.npy", 1e-9 * BY_HAND)
    (tmp_path / "a.json").write_text('{"pixel": [1.5e-6, 4e-6], "unit": "m"}')
    with h5py.File(tmp_path / "h.h5", "w") as file:
        file["height"] = BY_HAND
        file["height"].attrs["units"] = "nm"
        file.attrs.update(filetype="mcgw-surface", format=[1, 0], pixel=(1.5e-6, 4e-6), periodic=False)
    for name in ("a.npy", "h.h5"):
        found = read_map(tmp_path / name)
        assert found.heights == pytest.approx(1e-9 * BY_HAND, nan_ok=True, rel=1e-14), name
        assert found.pixel == pytest.approx((1.5e-6, 4e-6), rel=1e-14), name


def test_the_header_of_sdf_is_written_literally(topography, tmp_path):
    """Byte by byte as ISO 25178-71 has it."""
    write_map(topography, tmp_path / "m.sdf")
    raw = (tmp_path / "m.sdf").read_bytes()
    magic, maker, made, changed, *numbers = struct.unpack("<8s10s12s12sHHddddBBB", raw[:81])
    assert (magic, maker, changed) == (b"bISO-1.0", b"mcgw      ", made)
    assert numbers == [7, 5, 1e-6, 2.5e-6, 1.0, 0.0, 0, 7, 0]
    assert raw[81:] == topography.heights.tobytes()
    assert abs(datetime.strptime(made.decode() + "Z", "%d%m%Y%H%M%z") - datetime.now(UTC)) < timedelta(0, 180)


@pytest.mark.parametrize("name", ["map.npy", "map.h5"])
def test_a_file_cut_short_is_refused(name, topography, tmp_path):
    path = tmp_path / name
    write_map(topography, path)
    whole = path.read_bytes()
    for length in (0, 5, 60, len(whole) // 2, len(whole) - 40):
        path.write_bytes(whole[:length])
        with pytest.raises((ValueError, OSError)) as told:
            read_map(path)
        assert "\n" not in str(told.value)


def test_arrays_of_every_kind_are_read_as_numbers(tmp_path):
    """Of two dimensions a map, of one a profile."""
    numbers = np.array([[0, 1, 2], [3, 4, 200]])
    for kind in (">f8", "<u1", "<f2"):
        np.save(tmp_path / "map.npy", np.asarray(numbers.astype(kind), order="F"))
        found = read_map(tmp_path / "map.npy", pixel=(2e-8, 3e-8), unit="nm")
        assert found.heights == pytest.approx(1e-9 * numbers, rel=1e-15)
        assert found.heights.dtype == np.float64
    np.save(tmp_path / "p.npy", np.arange(100.0) % 7)
    assert read_heights(tmp_path / "p.npy", pixel=(1e-6, 1e-6), unit="um").heights[6] == 6e-6


SOUND = '{"pixel": [1e-6, 1e-6]}'


@pytest.mark.parametrize("sidecar", [None, "{", '{"pixel": [1, 1], "unit": "um"}', "3", SOUND + " " * 2**16])
def test_an_array_needs_a_sound_sidecar(sidecar, topography, tmp_path):
    write_map(topography, tmp_path / "map.npy")
    beside = tmp_path / "map.json"
    assert json.loads(beside.read_text())["unit"] == "m"
    beside.unlink() if sidecar is None else beside.write_text(sidecar)
    with pytest.raises(ValueError, match=r"map\.json"):
        read_map(tmp_path / "map.npy")
    beside.write_text(SOUND + " " * (2**16 - len(SOUND)))
    assert read_map(tmp_path / "map.npy").pixel == (1e-6, 1e-6)


def test_what_makes_no_map_is_refused(tmp_path):
    def saved(name, array):
        np.save(tmp_path / name, array)
        return tmp_path / name

    def other_h5():
        h5py.File(tmp_path / "o.h5", "w").close()
        return tmp_path / "o.h5"

    pixel, none = (1e-6, 1e-6), np.zeros(0)
    wave = Topography(np.sin(np.arange(400.0)).reshape(20, 20), pixel, periodic=True)
    for call, told in (
        (lambda: Topography(np.zeros(3), pixel), "not 1 dimension"),
        (lambda: read_map(saved("v.npy", np.zeros(9)), pixel=pixel), "a map has rows and columns"),
        (lambda: read_map(other_h5()), "not a mcgw-surface file|SurfaceTopography"),
        (lambda: read_map(saved("o.npy", np.array([[object()]])), pixel=pixel), "not a valid"),
        (lambda: read_map(tmp_path), "is not a regular file"),
        (lambda: read_map(tmp_path / "none.h5"), "no such file"),
        (lambda: write_map(wave, tmp_path / "map.tiff"), r"give one of \.npy"),
        (lambda: smooth(wave, 30e-6), "longer than the map"),
        (lambda: envelope(Asperities(*4 * [none], 1.0, (1.0, 1.0)), (4, 4)), "no asperity: nothing"),
        (lambda: Spectrum(0.0, 30e-6, 5e-6), "give a length > 0 m"),
        (lambda: Spectrum(1e-6, math.inf, 5e-6), "long = inf: give a length > 0 m"),
        (lambda: Spectrum(1e-6, 5e-6, 5e-6), "below long"),
        (lambda: Spectrum(1e-6, 30e-6, 5e-6, -1.01), "hurst = -1.01"),
        (lambda: gaussian_map(Spectrum(1e-6, 28e-6, 23e-6), (64, 64), pixel, None), "give more pixels"),
        (lambda: spectrum_from("rms=1um,long=30um,short=5um,hurst=x"), "hurst is no number"),
        (lambda: spectrum_from("rms=1um,long=30um,m0=1e-12"), "give rms, long and short, or m0, m2 and m4"),
    ):
        with pytest.raises(ValueError, match=told):
            call()


def test_the_largest_map_and_the_most_points_that_a_file_may_declare():
    """2^28; or of a file's bytes twenty each, but 2^22 in any case. Three columns of more rows are no map."""
    assert checked_shape(2**14, 2**14) == (2**14, 2**14)
    assert checked_shape(1, 1, held=0) == (1, 1)
    assert checked_shape(2**11, 2**11, held=0) == (2**11, 2**11)
    assert checked_shape(2**20, 20, held=2**20) == (2**20, 20)
    for rows, columns, held in ((2**14, 2**14 + 1, None), (2**22 + 1, 1, 0), (20 * 2**20 + 1, 1, 2**20)):
        with pytest.raises(ValueError, match="points: more than "):
            checked_shape(rows, columns, held=held)
    for rows, columns in ((0, 1), (1, 0)):
        with pytest.raises(ValueError, match="one or more along each axis"):
            checked_shape(rows, columns)


def test_the_largest_height_and_the_finest_pixel():
    z = np.array([[1.0, 0.0]])
    for pixel in (1.005e-30, 0.995e30):
        assert Topography(z, (pixel, pixel)).pixel == (pixel, pixel)
    for pixel in ((0.995e-30, 1.0), (1.0, 1.005e30)):
        with pytest.raises(ValueError, match="two numbers > 0"):
            Topography(z, pixel)
    assert Topography(0.995e150 * z, (1.0, 1.0)).highest == 0.995e150
    with pytest.raises(ValueError, match="too large to be squared"):
        Topography(-1.005e150 * z, (1.0, 1.0))


@pytest.mark.parametrize(
    ("slope", "doubted"), [(9.95, False), (10.05, True), (1.01e-6, False), (0.99e-6, True)]
)
def test_slopes_that_no_surface_has_are_refused(slope, doubted, tmp_path):
    """A unit that was assumed is named, one that was given or told is doubted too."""
    np.save(tmp_path / "m.npy", slope * 1e-6 * np.arange(8.0) + np.zeros((8, 1)))
    for unit, told in ((None, "would be 10[.]1; give --unit" if slope > 1 else "are in another unit"),
                       ("m", "the typical slope of this map is .*, which no surface has")):  # fmt: skip
        if doubted:
            with pytest.raises(ValueError, match=told):
                read_map(tmp_path / "m.npy", pixel=(1e-6, 1e-6), unit=unit)
        else:
            found = read_map(tmp_path / "m.npy", pixel=(1e-6, 1e-6), unit=unit)
            assert found.assumed_unit == ("" if unit else "m")


def test_what_an_array_and_an_hdf5_map_say_of_themselves(topography, tmp_path):
    """Each key and each attribute, as others read them."""
    topography.heights[2, 3] = np.nan
    periodic = Topography(topography.heights, topography.pixel, periodic=True)
    assert write_map(periodic, tmp_path / "m.npy") == [tmp_path / "m.npy", tmp_path / "m.json"]
    assert json.loads((tmp_path / "m.json").read_text()) == {
        "filetype": "mcgw-surface", "pixel": [1e-6, 2.5e-6], "unit": "m", "periodic": True,
        "axes": ["y", "x"],
    }  # fmt: skip
    one = np.ones(1)
    field = Asperities(1e-6 * one, 2e-6 * one, 3e-6 * one, 4e-6 * one, 5e-6, (7e-6, 12.5e-6))
    assert write_map(periodic, tmp_path / "m.h5", field, scene="of it") == [tmp_path / "m.h5"]
    with h5py.File(tmp_path / "m.h5") as file:
        assert (file.attrs["filetype"], *file.attrs["format"]) == ("mcgw-surface", 1, 0)
        assert (*file.attrs["pixel"], file.attrs["periodic"]) == (1e-6, 2.5e-6, True)
        assert file["height"].attrs["units"] == "m"
        assert list(file["height"].attrs["axes"]) == ["y", "x"]
        assert file["height"].compression == "gzip"
        group = file["asperities"]
        assert (group.attrs["radius"], *group.attrs["size"]) == (5e-6, 7e-6, 12.5e-6)
        for item, value in (("x", 1e-6), ("y", 2e-6), ("z", 3e-6)):
            assert (group[item][0], group[item].attrs["units"], group.attrs["units"]) == (value, "m", "m")
        assert file["scene"][()] == b"of it"
    for name in ("m.npy", "m.h5"):
        again = read_map(tmp_path / name)
        np.testing.assert_array_equal(again.heights, topography.heights)
        assert (again.pixel, again.periodic) == (topography.pixel, True)
        assert (again.missing, again.assumed_unit) == (1, "")
    with pytest.raises(ValueError, match="leave --pixel out"):
        read_map(tmp_path / "m.h5", pixel=(1e-6, 1e-6))
    with pytest.raises(ValueError, match="leave --unit out"):
        read_map(tmp_path / "m.h5", unit="um")


def test_nothing_half_written_is_left(tmp_path):
    (tmp_path / "map.sdf").write_text("mine")
    with pytest.raises(ValueError, match="65535"):
        write_map(Topography(np.zeros((1, 65536)), (1.0, 1.0)), tmp_path / "map.sdf")
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("map.sdf", "mine")]


@pytest.mark.parametrize(("name", "value"), [("m.txt", -9999.0), ("m.npy", -3.4028235e38), ("m.nc", 32767.0)])
@pytest.mark.filterwarnings("ignore")
def test_numbers_that_stand_for_missing_points_are_named(name, value, topography, tmp_path):
    path, z = tmp_path / name, 1e6 * topography.heights
    z[1, 2] = z[3, 0] = value
    given = {}
    if name == "m.nc":
        library = pytest.importorskip("SurfaceTopography")
        library.Topography(z.T, (7.0, 12.5), unit="um").to_netcdf(str(path))
    else:
        np.savetxt(path, z) if name == "m.txt" else np.save(path, z)
        given = {"pixel": topography.pixel, "unit": "um"}
    with pytest.raises(ValueError, match=rf"2 of 35 heights are {re.escape(f'{value:.8g}')}, .*--missing-va"):
        read_map(path, **given)
    found = read_map(path, missing=value, **given)
    assert np.isnan(found.heights[[1, 3], [2, 0]]).all()
    assert found.missing == 2
    with pytest.raises(ValueError, match="no height is -7777; leave --missing-value out"):
        read_map(path, missing=-7777.0, **given)


def test_heights_that_are_no_real_numbers_are_refused(topography, tmp_path):
    path = tmp_path / "c.h5"
    write_map(topography, path)
    for more, told in (
        ({"data": topography.heights * 1j}, "heights are complex128, not real numbers"),
        ({"dtype": "f8"}, "its heights were never written"),
    ):
        with h5py.File(path, "r+") as file:
            del file["height"]
            file.create_dataset("height", (5, 7), **more)
        with pytest.raises(ValueError, match=told):
            read_map(path)

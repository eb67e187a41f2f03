"""Files of maps: every digit back, other people's readers, and damaged ones refused in one line."""

import hashlib
import json
import math
import re
import shutil
import struct
import subprocess
import zipfile
from datetime import UTC, datetime, timedelta
from xml.etree import ElementTree

import h5py
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from mcgw.formats.numbers import METRES
from mcgw.maps.envelope import envelope
from mcgw.maps.form import smooth
from mcgw.maps.map_files import read_map, write_map
from mcgw.maps.profile_files import read_profile
from mcgw.maps.sdf import read_sdf
from mcgw.maps.synthetic import Asperities, Spectrum, gaussian_map, spectrum_from
from mcgw.maps.topography import Topography, checked_shape, single_points

NAMES = ["map.sdf", "map.ascii.sdf", "map.x3p", "map.npy", "map.h5"]
every_format = pytest.mark.parametrize("name", NAMES)


@pytest.fixture
def topography():
    """Neither square nor symmetric, so that a turned or mirrored map is another one."""
    return Topography(1e-6 * np.random.default_rng(1).normal(size=(5, 7)), (1e-6, 2.5e-6))


@every_format
def test_what_is_written_is_read_again(name, topography, tmp_path):
    """With every digit, and points that are missing."""
    topography.heights[2, 3] = np.nan
    written = write_map(topography, tmp_path / name)
    again = read_map(tmp_path / name)
    assert np.array_equal(again.heights, topography.heights, equal_nan=True)
    assert again.missing == 1
    assert again.pixel == topography.pixel
    assert sorted(tmp_path.iterdir()) == sorted(written)


def metres_of(library_topography):
    """Heights in m as rows of y, and the size in m, of another library's map."""
    unit = METRES[library_topography.unit]
    heights = np.ma.filled(library_topography.heights(), np.nan).T * unit
    return heights, tuple(float(x) * unit for x in library_topography.physical_sizes)


@pytest.mark.parametrize("name", NAMES[:3])
@pytest.mark.parametrize("program", ["SurfaceTopography", pytest.param("gwyddion", marks=pytest.mark.site)])
@pytest.mark.filterwarnings("ignore")
def test_other_programs_read_the_same(program, name, topography, tmp_path):
    """Gwyddion converts the file to its own format, which SurfaceTopography reads."""
    library = pytest.importorskip("SurfaceTopography")
    path = tmp_path / name
    write_map(topography, path)
    if program == "gwyddion":
        if shutil.which("gwyddion") is None:
            pytest.skip("gwyddion is not installed")
        out = tmp_path / "out.gwy"
        command = ["gwyddion", "--no-splash", f"--convert-to-gwy={out}", str(path)]
        subprocess.run(command, check=True, capture_output=True, timeout=60)
        path = out
    heights, size = metres_of(library.read_topography(str(path)))
    # it holds micrometres: one multiplication and back
    assert heights == pytest.approx(topography.heights, rel=1e-14)
    assert size == pytest.approx(topography.size, rel=1e-14)


@pytest.mark.filterwarnings("ignore")
def test_files_of_surface_topography_are_read(topography, tmp_path):
    """The other way round, with the integer matrix and the bit map of valid points it writes."""
    library = pytest.importorskip("SurfaceTopography")
    holes = np.ma.masked_array(topography.heights.T, mask=np.zeros((7, 5), dtype=bool))
    holes.mask[3, 2] = True
    theirs = library.Topography(holes, topography.size, unit="m")
    theirs.to_x3p(str(tmp_path / "theirs.x3p"), dtype="L")
    again = read_map(tmp_path / "theirs.x3p")
    expected = topography.heights.copy()
    expected[2, 3] = np.nan
    # 32 bits over the range of heights
    assert again.heights == pytest.approx(expected, abs=np.ptp(topography.heights) * 2**-32, nan_ok=True)
    assert again.pixel == pytest.approx(topography.pixel, rel=1e-14)
    theirs.to_netcdf(str(tmp_path / "theirs.nc"))
    other = read_map(tmp_path / "theirs.nc")
    assert other.size == pytest.approx(topography.size, rel=1e-14)


def sdf_head(columns, rows, code, *scales):
    """Of a binary SDF file; scales of x, y and z in m."""
    names = b"bISO-1.0", b"", b"", b""
    return struct.pack("<8s10s12s12sHHddddBBB", *names, columns, rows, *scales, 0, 0, code, 0)


BY_HAND = np.array([[1, 2, 3], [4, np.nan, 6]])  # what each of the files below holds, in nm


@pytest.mark.parametrize(("code", "dtype", "missing"), [
    (1, "<u2", 2**16 - 1), (5, "<i2", -(2**15)), (6, "<i4", -(2**31)), (3, "<f4", np.finfo("f4").min),
    (7, "<f8", np.finfo("f8").min),
])  # fmt: skip
def test_binary_sdf_made_by_hand(code, dtype, missing, tmp_path):
    """Three scales, and the mark of a missing point of each type of numbers."""
    raw = np.where(np.isnan(BY_HAND), missing, BY_HAND).astype(dtype)
    (tmp_path / "i.sdf").write_bytes(sdf_head(3, 2, code, 1.5e-6, 4e-6, 1e-9) + raw.tobytes())
    found = read_sdf(tmp_path / "i.sdf")
    assert found.heights == pytest.approx(1e-9 * BY_HAND, nan_ok=True, rel=1e-15)
    assert found.pixel == (1.5e-6, 4e-6)


def test_other_files_made_by_hand(tmp_path):
    """Sizes along x and y, units, and the lowest number as the mark of a missing point."""
    keys = "NumPoints = 3\nNumProfiles = 2\nXscale=1.5e-6\nYscale=4e-6\nZscale=1e-9\nDataType=7\n"
    (tmp_path / "t.ascii.sdf").write_text(f"aISO-1.0\n{keys}*\n1 2 3 4 -1.7976931348623e+308 6\n*\n")
    np.save(tmp_path / "a.npy", 1e-9 * BY_HAND)
    (tmp_path / "a.json").write_text('{"pixel": [1.5e-6, 4e-6], "unit": "m"}')
    with h5py.File(tmp_path / "h.h5", "w") as file:
        file["height"] = BY_HAND
        file["height"].attrs["units"] = "nm"
        file.attrs.update(filetype="mcgw-surface", format=[1, 0], pixel=(1.5e-6, 4e-6), periodic=False)
    text = "# Channel: Z\n# Width: 4.5 µm\n# Height: 8.0 µm\n# Value units: nm\n1;2\t3\n4 --- 6\n"
    (tmp_path / "w.txt").write_text(text, encoding="utf-8")
    german = "# Kanal: Z\n# Breite: 4,5 µm\n# Höhe: 8,0 µm\n# Werteinheit: nm\n1,0\t2,0\t3\n4\t\t6,0\n"
    (tmp_path / "g.txt").write_text(german, encoding="utf-8")
    others = [f"w{ending}" for ending in (".csv", ".asc", ".dat", ".tsv", ".TXT")]
    for name in others:
        (tmp_path / name).write_text(text, encoding="utf-8")
    for name in ("t.ascii.sdf", "a.npy", "h.h5", "w.txt", "g.txt", *others):
        found = read_map(tmp_path / name)
        assert found.heights == pytest.approx(1e-9 * BY_HAND, nan_ok=True, rel=1e-14), name
        assert found.pixel == pytest.approx((1.5e-6, 4e-6), rel=1e-14), name


def test_headers_that_are_written_literally(topography, tmp_path):
    """Byte by byte as ISO 25178-71 has it; and of X3P the sums of both members, and the axes."""
    for name in ("m.sdf", "m.ascii.sdf", "m.x3p"):
        write_map(topography, tmp_path / name)
    raw = (tmp_path / "m.sdf").read_bytes()
    magic, maker, made, changed, *numbers = struct.unpack("<8s10s12s12sHHddddBBB", raw[:81])
    assert (magic, maker, changed) == (b"bISO-1.0", b"mcgw      ", made)
    assert numbers == [7, 5, 1e-6, 2.5e-6, 1.0, 0.0, 0, 7, 0]
    assert raw[81:] == topography.heights.tobytes()
    lines = (tmp_path / "m.ascii.sdf").read_bytes().split(b"\r\n")
    date = lines[2].decode().removeprefix("CreateDate = ")
    assert made.decode()[:10] == date[:10]  # but for a minute between the two
    now = datetime.now(UTC).replace(tzinfo=None)
    assert abs(datetime.strptime(date, "%d%m%Y%H%M") - now) < timedelta(minutes=3)
    assert (
        lines[:14]
        == f"""aISO-1.0
ManufacID = mcgw
CreateDate = {date}
ModDate = {date}
NumPoints = 7
NumProfiles = 5
Xscale = 1e-06
Yscale = 2.5e-06
Zscale = 1.0
Zresolution = 0.0
Compression = 0
DataType = 7
CheckType = 0
*""".encode().split(b"\n")
    )
    assert lines[-2:] == [b"*", b""]
    with zipfile.ZipFile(tmp_path / "m.x3p") as archive:
        main, data = archive.read("main.xml"), archive.read("bindata/data.bin")
        assert archive.read("md5checksum.hex").decode() == f"{hashlib.md5(main).hexdigest()} *main.xml\n"
    assert data == topography.heights.tobytes()
    root = ElementTree.fromstring(main)
    assert root.find("Record3/DataLink/MD5ChecksumPointData").text == hashlib.md5(data).hexdigest().upper()
    axes = {axis.tag: [part.text for part in axis] for axis in root.find("Record1/Axes")}
    assert axes == {
        "CX": ["I", "D", "1e-06", "0.0"], "CY": ["I", "D", "2.5e-06", "0.0"], "CZ": ["A", "D", "1.0", "0.0"],
    }  # fmt: skip
    date = root.find("Record2/Date").text
    assert abs(datetime.strptime(date, "%Y-%m-%dT%H:%M:%S.0+00:00") - now) < timedelta(minutes=3)


@pytest.mark.parametrize("separator", [" ", "\t", "\n", ","])
def test_an_ascii_sdf_of_several_megabytes_is_read_piece_by_piece(separator, tmp_path):
    """Wherever a piece ends inside a number; what stands behind the second star is no height."""
    z = np.random.default_rng(1).integers(0, 10**12, 90_000)
    head = "NumPoints=300\nNumProfiles=300\nXscale=1e-6\nYscale=1e-6\nZscale=1e-18\nDataType=7\n*\n"
    text = separator.join(map(str, z)).replace(",", ", ")
    (tmp_path / "m.sdf").write_text(f"aISO-1.0\n{head}{text}\n*\n5 5\n")
    assert np.array_equal(read_map(tmp_path / "m.sdf").heights.ravel(), z * 1e-18)
    (tmp_path / "m.sdf").write_text(f"aISO-1.0\n{head}{text}")  # without an end
    assert read_map(tmp_path / "m.sdf").heights[-1, -1] == z[-1] * 1e-18


def test_the_shortest_ascii_sdf_there_is(tmp_path):
    """A digit and a space a point; keys without an equals sign, and none of compression."""
    head = "NumPoints 2\n NumProfiles 1\nXscale 1e-6\nYscale 2e-6\nZscale 1\nDataType 7\n"
    (tmp_path / "m.sdf").write_text(f"aISO-1.0\n{head}*\n1 2")
    found = read_map(tmp_path / "m.sdf")
    assert (found.heights.tolist(), found.pixel) == ([[1.0, 2.0]], (1e-6, 2e-6))
    for key in ("NumPoints", "NumProfiles", "Xscale", "Yscale", "Zscale", "DataType"):
        (tmp_path / "m.sdf").write_text(f"aISO-1.0\n{head.replace(key, 'Other')}*\n1 2")
        with pytest.raises(ValueError, match=f"the SDF header lacks {key}$"):
            read_map(tmp_path / "m.sdf")
        (tmp_path / "m.sdf").write_text(f"aISO-1.0\n{head.replace(key, key + ' x')}*\n1 2")
        with pytest.raises(ValueError, match="the SDF header is malformed"):
            read_map(tmp_path / "m.sdf")


@every_format
def test_a_file_cut_short_is_refused(name, topography, tmp_path):
    path = tmp_path / name
    write_map(topography, path)
    whole = path.read_bytes()
    for length in (0, 5, 60, len(whole) // 2, len(whole) - 40):
        path.write_bytes(whole[:length])
        with pytest.raises((ValueError, OSError)) as told:
            read_map(path)
        assert "\n" not in str(told.value)


@pytest.mark.parametrize("name", NAMES[:-1])  # the HDF5 library itself may crash on damaged files
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_a_damaged_file_gives_an_error_or_a_map(name, data, tmp_path_factory):
    """One byte changed anywhere: never another kind of error, never more memory than the file is worth."""
    path = tmp_path_factory.mktemp("damaged") / name
    write_map(Topography(np.arange(12.0).reshape(3, 4) * 1e-6, (1e-6, 1e-6)), path)
    content = bytearray(path.read_bytes())
    at = data.draw(st.integers(0, 2**16)) % len(content)  # dates make lengths differ
    content[at] = data.draw(st.integers(0, 255))
    path.write_bytes(content)
    try:
        size = read_map(path).heights.size
    except (ValueError, OSError):
        return
    assert size <= 2000


def test_gigantic_declarations_allocate_nothing(tmp_path):
    head = sdf_head(65535, 65535, 7, 1e-6, 1e-6, 1.0)
    (tmp_path / "huge.sdf").write_bytes(head + bytes(100))
    with pytest.raises(ValueError, match="65535 x 65535 points: more than"):
        read_map(tmp_path / "huge.sdf")
    head = "aISO-1.0\nNumPoints = 9999\nNumProfiles = 9999\nXscale=1e-6\nYscale=1e-6\nZscale=1\nDataType=7\n"
    text = head + "*\n1 2 3\n*\n"
    (tmp_path / "huge.ascii.sdf").write_text(text)
    with pytest.raises(ValueError, match="cannot hold them"):
        read_map(tmp_path / "huge.ascii.sdf")
    with open(tmp_path / "huge.npy", "wb") as file:
        np.lib.format.write_array_header_1_0(
            file, {"descr": "<f8", "fortran_order": False, "shape": (10**6, 10**6)}
        )
    with pytest.raises(ValueError, match=r"huge\.npy"):
        read_map(tmp_path / "huge.npy", pixel=(1e-6, 1e-6))


def x3p_with(path, topography, change):
    """An X3P file whose members were changed by a function of their dictionary."""
    write_map(topography, path)
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    change(members)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


def replaced(old, new):
    def change(members):
        assert old in members["main.xml"]
        members["main.xml"] = members["main.xml"].replace(old, new)

    return change


def blown_up(members):
    members["main.xml"] = members["main.xml"] + b" " * 2**22


def all_zero(members):
    members["bindata/data.bin"] = bytes(5 * 7 * 8)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda m: m.pop("main.xml"), r"main\.xml: is missing"),
        (lambda m: m.pop("bindata/data.bin"), r"data\.bin: is missing"),
        (replaced(b"<SizeX>7<", b"<SizeX>8<"), r"280 bytes, but the map needs 320"),
        (replaced(b"<SizeX>7<", b"<SizeX>99999999<"), "99999999 x 5 points: more than the"),
        (replaced(b"<SizeX>7<", b"<SizeX>seven<"), "is not a number"),
        (replaced(b"<SizeZ>1<", b"<SizeZ>2<"), "SizeZ is not 1"),
        (replaced(b"<DataType>D<", b"<DataType>X<"), "DataType 'X' of CZ"),
        (replaced(b"Record3>", b"Record5>"), "lacks Record3"),
        (replaced(b"SUR", b"PCL"), "only SUR is read"),
        (replaced(b"<Record1>", b"<!DOCTYPE a><Record1>"), "declares entities"),
        (replaced(b"</Record1>", b""), "mismatched tag"),
        *(
            (replaced(b"<Increment>%s<" % old, b"<Increment>%s<" % new), f"C{axis}/Increment = .*must be >")
            for axis, old in (("X", b"1e-06"), ("Y", b"2.5e-06"), ("Z", b"1.0"))
            for new in (b"0", b"-1e-6")
        ),
        (replaced(b"<SizeX>7<", b"<SizeX>7.5<"), "'?7.5'? is not a whole number"),
        *(
            (
                replaced(b"<C%s><AxisType>I<" % x, b"<C%s><AxisType>A<" % x),
                f"along C{x.decode()} are not equally",
            )
            for x in (b"X", b"Y")
        ),
        (blown_up, "more than 1048576"),
        (all_zero, "checksum"),
        (replaced(b"<Record1>", b"<!ENTITY a><Record1>"), "declares entities or is not UTF-8"),
        (replaced(b"<Record1>", b"\0<Record1>"), "declares entities or is not UTF-8"),
        *(
            (replaced(b"<Increment>1e-06<", b"<Increment>%s<" % x), "CX/Increment = .* is not a number")
            for x in (b"nan", b"inf", b"wide")
        ),
        (replaced(b"<Increment>1e-06<", b"<Increment> <"), "lacks Record1/Axes/CX/Increment"),
    ],
)
def test_damaged_x3p_files_are_refused_in_one_line(change, told, topography, tmp_path):
    path = x3p_with(tmp_path / "bad.x3p", topography, change)
    with pytest.raises(ValueError, match=told) as error:
        read_map(path)
    assert str(error.value).startswith(str(path))
    assert "\n" not in str(error.value)


def test_a_zip_bomb_is_refused_before_it_unpacks(tmp_path):
    """128 MiB of zeros in 130 kB, and a map that declares just that."""
    path, n = tmp_path / "bomb.x3p", 4096
    write_map(Topography(np.ones((2, 2)), (1e-6, 1e-6)), path)
    with zipfile.ZipFile(path) as archive:
        main = archive.read("main.xml")
    for axis in (b"X", b"Y"):
        main = main.replace(b"<Size%s>2<" % axis, b"<Size%s>%d<" % (axis, n))
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("main.xml", main)
        with archive.open("bindata/data.bin", "w") as member:
            for _ in range(n):
                member.write(bytes(8 * n))
    with pytest.raises(ValueError, match="that is refused"):
        read_map(path)


MAIN = """<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>
<CX><AxisType>I</AxisType><DataType>D</DataType><Increment>1.5e-6</Increment><Offset>0</Offset></CX>
<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>4e-6</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>I</DataType><Increment>2.5e-9</Increment><Offset>1e-6</Offset></CZ>
</Axes></Record1>
<Record3><MatrixDimension><SizeX>3</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ></MatrixDimension>
<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink></Record3>
<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4>
</p:ISO5436_2>"""


def test_an_integer_x3p_made_by_hand(tmp_path):
    """Three points along x and two along y, 16 bits: increment and offset of each axis are applied."""
    with zipfile.ZipFile(tmp_path / "hand.x3p", "w") as archive:
        archive.writestr("main.xml", MAIN)
        archive.writestr("bindata/data.bin", struct.pack("<6h", 0, 1, 2, -400, 400, 32767))
    found = read_map(tmp_path / "hand.x3p")
    assert found.pixel == (1.5e-6, 4e-6)
    assert found.heights == pytest.approx(
        np.array([[1e-6, 1.0025e-6, 1.005e-6], [0, 2e-6, 82.9175e-6]]), rel=1e-12, abs=1e-18
    )


def test_the_valid_points_of_an_x3p_made_by_hand(tmp_path):
    """Whole numbers know no nan: bit 0 of byte 0 is the first point, and every point has its own bit."""
    link = "<ValidPointsLink>bindata/valid.bin</ValidPointsLink></DataLink>"
    for valid in (0b111111, 0b000001, 0b100110, 0b011010):
        with zipfile.ZipFile(tmp_path / "hand.x3p", "w") as archive:
            archive.writestr("main.xml", MAIN.replace("</DataLink>", link))
            archive.writestr("bindata/data.bin", struct.pack("<6h", 0, 1, 2, -400, 400, 32767))
            archive.writestr("bindata/valid.bin", bytes([valid]))
        missing = np.isnan(read_map(tmp_path / "hand.x3p").heights).ravel()
        assert missing.tolist() == [not valid >> k & 1 for k in range(6)]


def test_an_x3p_with_more_points_and_without_a_scale_of_heights(tmp_path):
    """Nine points need two bytes of marks; increment 1 and offset 0 are what is meant. Packed or not."""
    link = "<ValidPointsLink>bindata/valid.bin</ValidPointsLink></DataLink>"
    main = MAIN.replace("</DataLink>", link).replace("<SizeY>2<", "<SizeY>3<")
    main = main.replace("<Increment>2.5e-9</Increment><Offset>1e-6</Offset>", "")
    for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2):
        with zipfile.ZipFile(tmp_path / "m.x3p", "w", method) as archive:
            archive.writestr("main.xml", main)
            archive.writestr("bindata/data.bin", struct.pack("<9h", *range(9)))
            archive.writestr("bindata/valid.bin", bytes([0b11111101, 0b1]))
        if method == zipfile.ZIP_BZIP2:
            with pytest.raises(ValueError, match=r"main\.xml: is packed by method 12; only deflate is read"):
                read_map(tmp_path / "m.x3p", unit="m")
        else:
            found = read_map(tmp_path / "m.x3p").heights.ravel()
            assert np.array_equal(found, [0, np.nan, *range(2, 9)], equal_nan=True)


@pytest.mark.parametrize("kind", ["<f4", ">f8", ">i2", "<u1", "<i8", "<f2"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_of_every_kind_are_read_as_numbers(kind, order, tmp_path):
    numbers = np.array([[0, 1, 2], [3, 4, 200]])
    np.save(tmp_path / "map.npy", np.asarray(numbers.astype(kind), order=order))
    found = read_map(tmp_path / "map.npy", pixel=(2.0, 3.0), unit="nm")
    assert found.heights == pytest.approx(1e-9 * numbers, rel=1e-15)
    assert found.heights.dtype == np.float64


@pytest.mark.parametrize("name", ["map.sdf", "map.x3p", "map.h5"])
def test_what_a_file_tells_is_not_told_again(name, topography, tmp_path):
    write_map(topography, tmp_path / name)
    with pytest.raises(ValueError, match="leave --pixel out"):
        read_map(tmp_path / name, pixel=(1e-6, 1e-6))
    with pytest.raises(ValueError, match="leave --unit out"):
        read_map(tmp_path / name, unit="um")
    assert np.array_equal(read_map(tmp_path / name, unit="m").heights, topography.heights)


@pytest.mark.parametrize(("content", "told"), [
    ("1 2\n3\n", "line 2 has 1 numbers, the first row 2"),
    ("1 2\n3 x\n", "line 2: could not convert"),
    ("1 inf\n", "infinite"),
    ("# nothing\n", "holds no numbers"),
    ("# Width: 1 furlong\n", "not a known unit of length"),
    ("1" * 2**24, r"map\.txt: line 1 has 16777216 characters or more; is it a map\?"),
], ids=["short row", "word", "infinite", "nothing", "unit", "one line"])  # fmt: skip
def test_damaged_text_is_refused(content, told, tmp_path):
    (tmp_path / "map.txt").write_text(content)
    with pytest.raises(ValueError, match=told):
        read_map(tmp_path / "map.txt", pixel=(1.0, 1.0))


SOUND = '{"pixel": [1, 1]}'


@pytest.mark.parametrize(
    "sidecar",
    [None, "{", '{"pixel": [1]}', '{"pixel": [1, 1], "unit": "um"}', "[]", "3", SOUND + " " * 2**16],
)
def test_an_array_needs_a_sound_sidecar(sidecar, topography, tmp_path):
    write_map(topography, tmp_path / "map.npy")
    beside = tmp_path / "map.json"
    assert json.loads(beside.read_text())["unit"] == "m"
    beside.unlink() if sidecar is None else beside.write_text(sidecar)
    with pytest.raises(ValueError, match=r"map\.json"):
        read_map(tmp_path / "map.npy")
    beside.write_text(SOUND + " " * (2**16 - len(SOUND)))
    assert read_map(tmp_path / "map.npy").pixel == (1.0, 1.0)


def test_what_makes_no_map_is_refused(tmp_path):
    def saved(name, array):
        np.save(tmp_path / name, array)
        return tmp_path / name

    def sdf(*scales, code=7, packed=0):
        head = bytearray(sdf_head(1, 1, code, *scales))
        head[-3] = packed
        (tmp_path / "s.sdf").write_bytes(head + bytes(8))
        return tmp_path / "s.sdf"

    def words(columns, body, more=""):
        head = f"NumPoints={columns}\nNumProfiles=1\nXscale=1e-6\nYscale=1e-6\nZscale=1\nDataType=7\n{more}"
        (tmp_path / "w.sdf").write_text(f"aISO-1.0\n{head}*\n{body}")
        return tmp_path / "w.sdf"

    def other_h5():
        h5py.File(tmp_path / "o.h5", "w").close()
        return tmp_path / "o.h5"

    narrow, rng = Spectrum(1e-6, 30e-6, 5e-6), np.random.default_rng(1)
    wave = Topography(np.sin(np.arange(400.0)).reshape(20, 20), (1e-6, 1e-6), periodic=True)
    for call, told in (
        (lambda: Topography(np.zeros(3), (1.0, 1.0)), "not 1 dimension"),
        (lambda: Topography(np.zeros((0, 3)), (1.0, 1.0)), "one or more along each axis"),
        (lambda: Topography(np.zeros((2, 3)), (1.0, 0.0)), "two numbers > 0"),
        (lambda: read_map(saved("v.npy", np.zeros(3)), pixel=(1.0, 1.0)), "a map has rows and columns"),
        (lambda: read_map(sdf(1e-6, 0.0, 1.0)), "all must be > 0"),
        (lambda: read_map(sdf(1e-6, 1e-6, 1.0, code=8)), "DataType = 8: SDF knows 0 to 7"),
        (lambda: read_map(sdf(1e-6, 1e-6, 1.0, packed=1)), r"s\.sdf: compressed SDF files are not read"),
        (lambda: read_map(words(2, "1 2\n*\n", "Compression=2\n")), r"w\.sdf: compressed SDF files are not"),
        (lambda: read_map(words(2, "1 2 3\n*\n")), "holds more than the 2 points it declares"),
        (lambda: read_map(words(3, "1 2   \n*\n")), "declares 3 points, but holds 2; it is cut short"),
        (lambda: read_map(words(2, "1" * 2**21 + "2")), "a megabyte without a space"),
        (lambda: read_map(other_h5()), "not a mcgw-surface file|SurfaceTopography"),
        (lambda: Spectrum(0.0, 30e-6, 5e-6), "give a length > 0 m"),
        (lambda: Spectrum(1e-6, 30e-6, 5e-6, 2.0), "hurst"),
        (lambda: gaussian_map(narrow, (64, 64), (3e-6, 1e-6), rng), "shows 2 pixels or more"),
        (lambda: gaussian_map(narrow, (64, 20), (1e-6, 1e-6), rng), "longer than the map"),
        (lambda: gaussian_map(Spectrum(1e-6, 28e-6, 23e-6), (64, 64), (1e-6, 1e-6), rng), "give more pixels"),
        (lambda: spectrum_from("rms=1um,long=30um,short=5um,hurst=x"), "hurst = 'x': give a number"),
        (lambda: smooth(wave, 30e-6), "longer than the map"),
        (lambda: Spectrum(1e-6, math.inf, 5e-6), "long = inf: give a length > 0 m"),
        (lambda: Spectrum(1e-6, 30e-6, -1.0), "short = -1.0: give a length > 0 m"),
        (lambda: Spectrum(1e-6, 5e-6, 5e-6), "below long"),
        (lambda: Spectrum(1e-6, 30e-6, 5e-6, -1.01), "hurst = -1.01"),
        (lambda: spectrum_from("rms=1um,long=30um,m0=1e-12"), "give rms, long and short, or m0, m2 and m4"),
        (lambda: spectrum_from("rms=1um,long=30,short=5um,size=1um"), "'size=1um': give rms, long"),
        (
            lambda: envelope(Asperities(*4 * [np.zeros(0)], 1.0, (1.0, 1.0)), (4, 4)),
            "no asperity: nothing to",
        ),
        (lambda: read_map(tmp_path), "is not a regular file"),
        (lambda: read_profile(tmp_path), "is not a regular file"),
        (
            lambda: read_profile(saved("m.npy", np.zeros((3, 9))), spacing=1.0),
            "2 dimensions; a profile has one",
        ),
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
    assert [bool(single_points(*shape)) for shape in ((4, 3), (3, 3), (4, 4), (4, 2))] == [True] + 3 * [False]


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


@pytest.mark.parametrize(("steep", "doubted"), [(9.95, False), (10.05, True)])
def test_heights_without_a_unit_are_doubted_from_a_slope_of_ten_on(steep, doubted, tmp_path):
    np.savetxt(tmp_path / "m.txt", steep * 1e-6 * np.arange(8.0) + np.zeros((8, 1)))
    if doubted:
        with pytest.raises(ValueError, match=r"would be 10[.]1; give --unit"):
            read_map(tmp_path / "m.txt", pixel=(1e-6, 1e-6))
    else:
        assert read_map(tmp_path / "m.txt", pixel=(1e-6, 1e-6)).assumed_unit == "m"
    assert read_map(tmp_path / "m.txt", pixel=(1e-6, 1e-6), unit="m").assumed_unit == ""


def test_the_longest_header_of_an_ascii_sdf_and_its_lowest_number(tmp_path):
    """Four kilobytes; and what is within a thousandth of the lowest number is a missing point."""
    head = "NumPoints=2\nNumProfiles=1\nXscale=1e-6\nYscale=1e-6\nZscale=1e-9\nDataType=7\n"
    for size, told in ((4096, None), (4097, "no line with \\*")):
        text = head + "Note = " + "x" * (size - len(head) - 9) + "\n*\n"
        (tmp_path / "m.sdf").write_text(f"aISO-1.0{text}-1.7960e308 3\n*\n")
        if told:
            with pytest.raises(ValueError, match=told):
                read_map(tmp_path / "m.sdf")
        else:
            found = read_map(tmp_path / "m.sdf").heights
            assert np.isnan(found[0, 0])
            assert found[0, 1] == pytest.approx(3e-9)
    (tmp_path / "m.sdf").write_text(f"aISO-1.0\n{head}*\n-1.7958e308 3\n*\n")
    with pytest.raises(ValueError, match="too large to be squared"):
        read_map(tmp_path / "m.sdf")
    write_map(Topography(np.zeros((1, 65535)), (1e-6, 1e-6)), tmp_path / "w.sdf")
    assert read_map(tmp_path / "w.sdf").heights.shape == (1, 65535)


@pytest.mark.parametrize("over", [0, 1])
def test_a_description_of_a_megabyte_is_the_longest(over, topography, tmp_path):
    def filled(members):
        members["main.xml"] += b" " * (2**20 + over - len(members["main.xml"]))

    path = x3p_with(tmp_path / "m.x3p", topography, filled)
    if over:
        with pytest.raises(ValueError, match="unpacks to 1048577 bytes, more than 1048576"):
            read_map(path)
    else:
        assert np.array_equal(read_map(path).heights, topography.heights)


def test_what_an_array_and_an_hdf5_map_say_of_themselves(topography, tmp_path):
    """Each key and each attribute, as others read them."""
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
        assert file.attrs["filetype"] == "mcgw-surface"
        assert list(file.attrs["format"]) == [1, 0]
        assert list(file.attrs["pixel"]) == [1e-6, 2.5e-6]
        assert file.attrs["periodic"]
        assert file["height"].attrs["units"] == "m"
        assert list(file["height"].attrs["axes"]) == ["y", "x"]
        assert file["height"].compression == "gzip"
        group = file["asperities"]
        assert (group.attrs["radius"], list(group.attrs["size"])) == (5e-6, [7e-6, 12.5e-6])
        assert group.attrs["units"] == "m"
        assert {name: (x[0], x.attrs["units"]) for name, x in group.items()} == {
            "x": (1e-6, "m"), "y": (2e-6, "m"), "z": (3e-6, "m"),
        }  # fmt: skip
        assert file["scene"][()] == b"of it"
    for name in ("m.npy", "m.h5"):
        assert read_map(tmp_path / name).periodic
        assert read_map(tmp_path / name).assumed_unit == ""
    write_map(topography, tmp_path / "n.h5")
    with h5py.File(tmp_path / "n.h5") as file:
        assert "asperities" not in file
        assert file["scene"][()] == b""
    assert not read_map(tmp_path / "n.h5").periodic


@pytest.mark.parametrize(("key", "value", "told"), [
    ("pixel", "12", "pixel = '12': must be"), ("pixel", [1, True], "two numbers in m"),
    ("pixel", [1e-6] * 3, "two numbers in m"), ("periodic", "no", "periodic = 'no': must be true or false"),
    ("unit", "um", "unit = 'um': must be 'm'"),
])  # fmt: skip
def test_words_in_place_of_numbers_are_refused(key, value, told, topography, tmp_path):
    write_map(topography, tmp_path / "m.npy")
    facts = json.loads((tmp_path / "m.json").read_text())
    (tmp_path / "m.json").write_text(json.dumps({**facts, key: value}))
    with pytest.raises(ValueError, match=rf"m\.json: {told}" if key == "periodic" else told):
        read_map(tmp_path / "m.npy")
    del facts["unit"], facts["periodic"]
    (tmp_path / "m.json").write_text(json.dumps({"pixel": [1, 2]}))
    found = read_map(tmp_path / "m.npy")
    assert (found.pixel, found.periodic, found.assumed_unit) == ((1.0, 2.0), False, "m")


def test_arrays_of_objects_are_never_unpickled(tmp_path):
    np.save(tmp_path / "map.npy", np.array([[object()]]), allow_pickle=True)
    with pytest.raises(ValueError, match="not a valid"):
        read_map(tmp_path / "map.npy", pixel=(1.0, 1.0))


@pytest.mark.filterwarnings("ignore::ImportWarning")  # of SurfaceTopography, where it is installed
def test_other_endings_name_what_would_do(tmp_path, topography):
    with pytest.raises(ValueError, match=r"give one of \.sdf"):
        write_map(topography, tmp_path / "map.tiff")
    (tmp_path / "map.zzz").write_text("?")
    with pytest.raises(ValueError, match="SurfaceTopography"):
        read_map(tmp_path / "map.zzz")
    with pytest.raises(ValueError, match="no such file"):
        read_map(tmp_path / "none.sdf")


def test_nothing_half_written_is_left(tmp_path):
    (tmp_path / "map.sdf").write_text("mine")
    with pytest.raises(ValueError, match="65535"):
        write_map(Topography(np.zeros((1, 65536)), (1.0, 1.0)), tmp_path / "map.sdf")
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("map.sdf", "mine")]
    with pytest.raises(OSError, match="nowhere"):
        write_map(Topography(np.zeros((1, 2)), (1.0, 1.0)), tmp_path / "nowhere" / "map.npy")


def gwyddions_numbers(text):
    """What Gwyddion's sdfile.c reads after the header: as C's strtod does, it ends at the first word."""
    rest, found = text.partition("*")[2], []
    while match := re.match(r"\s*([-+]?(?:nan|inf|\d+\.?\d*(?:[eE][-+]?\d+)?))", rest):
        found.append(float(match[1]))
        rest = rest[match.end() :]
    return found


def test_ascii_sdf_with_missing_points_is_read_by_gwyddions_rules(topography, tmp_path):
    """All points are numbers to strtod, and header lines stand in the order it asks for."""
    topography.heights[2, 3] = np.nan
    write_map(topography, tmp_path / "map.ascii.sdf")
    text = (tmp_path / "map.ascii.sdf").read_text()
    assert gwyddions_numbers(text) == pytest.approx(topography.heights.ravel(), nan_ok=True, rel=1e-15)
    assert len(gwyddions_numbers(text.replace("nan", "BAD"))) == 2 * 7 + 3
    keys = [line.split("=")[0].strip() for line in text.partition("*")[0].splitlines()[1:]]
    order = "ManufacID CreateDate ModDate NumPoints NumProfiles Xscale Yscale Zscale Zresolution"
    assert keys == [*order.split(), "Compression", "DataType", "CheckType"]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("mark", [".", ","])
def test_lists_of_points_are_read_by_surface_topography(mark, tmp_path):
    pytest.importorskip("SurfaceTopography")
    rows = ["0.0\t0.0\t1.5", "1.0\t0.0\t2.5", "0.0\t1.0\t3.5", "1.0\t1.0\t4.5"]
    (tmp_path / "map.xyz").write_text("\n".join(rows).replace(".", mark) + "\n")
    found = read_map(tmp_path / "map.xyz", unit="um")
    assert found.heights == pytest.approx(1e-6 * np.array([[1.5, 2.5], [3.5, 4.5]]))
    assert found.pixel == pytest.approx((1e-6, 1e-6))


@pytest.mark.filterwarnings("ignore")
def test_what_our_readers_refuse_surface_topography_is_asked(topography, tmp_path):
    """Under endings that are ours: its own netCDF as HDF5, and a text with a header of its own."""
    library = pytest.importorskip("SurfaceTopography")
    theirs = library.Topography(topography.heights.T, topography.size, unit="m")
    theirs.to_netcdf(str(tmp_path / "map.nc"))
    for name in ("map.h5", "map.dat", "map.sdf"):
        shutil.copy(tmp_path / "map.nc", tmp_path / name)
        found = read_map(tmp_path / name)
        assert found.heights == pytest.approx(topography.heights, rel=1e-12)
        assert found.pixel == pytest.approx(topography.pixel, rel=1e-12)
        with pytest.raises(ValueError, match="leave --pixel out"):
            read_map(tmp_path / name, pixel=(1e-6, 1e-6))
    (tmp_path / "own.txt").write_text("h=2 w=2\npixel size=1e-006 m\n1 2\n3 4\n")
    with pytest.raises(ValueError, match=r"^[^;]*line 1: could not convert"):
        read_map(tmp_path / "own.txt")


@pytest.mark.filterwarnings("ignore")
def test_a_foreign_map_without_a_pixel_takes_one(topography, tmp_path):
    pytest.importorskip("SurfaceTopography")
    with h5py.File(tmp_path / "bare.h5", "w") as file:
        file["surface"] = topography.heights.T
    with pytest.raises(ValueError, match="give --pixel"):
        read_map(tmp_path / "bare.h5")
    found = read_map(tmp_path / "bare.h5", pixel=(1e-6, 1e-6), unit="m")
    assert found.heights == pytest.approx(topography.heights)
    assert found.pixel == (1e-6, 1e-6)

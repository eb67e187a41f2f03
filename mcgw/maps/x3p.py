"""X3P, ISO 25178-72 (ISO 5436-2): a zip archive of an XML description and a binary matrix.

Lengths are in m. Points along X run fastest, little-endian. What is read is checked against what is
declared before it is unpacked, and nothing is unpacked beyond that.
"""

import hashlib
import math
import xml.etree.ElementTree as ElementTree
import zipfile
import zlib
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from analytic.arrays import Array
from mcgw.formats.files import whole_file
from mcgw.maps.topography import Topography, checked_shape

_NAMESPACE = "http://www.opengps.eu/2008/ISO5436_2"
_TYPES = {"I": "<i2", "L": "<i4", "F": "<f4", "D": "<f8"}
_MAIN, _DATA, _SUMS = "main.xml", "bindata/data.bin", "md5checksum.hex"
_MOST_XML = 2**20
_MOST_RATIO, _SMALL = 200, 2**26  # a bomb: unpacks to more than 64 MiB, 200 to 1


def write_x3p(topography: Topography, path: Path) -> None:
    """Write a map with every digit; missing points are nan, as the standard has it for real numbers."""
    data = np.ascontiguousarray(topography.heights, dtype="<f8")
    main = _description(topography, hashlib.md5(data.data, usedforsecurity=False).hexdigest())
    sums = f"{hashlib.md5(main, usedforsecurity=False).hexdigest()} *{_MAIN}\n"
    with whole_file(path) as unfinished, zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(_MAIN, main)
        with archive.open(zipfile.ZipInfo(_DATA), "w", force_zip64=data.nbytes > 2**31) as member:
            for row in data:
                member.write(row.tobytes())
        archive.writestr(_SUMS, sums)


def _description(topography: Topography, md5: str) -> bytes:
    """The file main.xml."""
    rows, columns = topography.heights.shape
    date = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%S.0+00:00")
    steps = zip(("CX", "CY", "CZ"), "IIA", (*topography.pixel, 1.0), strict=True)
    axes = "".join(
        f"<{name}><AxisType>{kind}</AxisType><DataType>D</DataType>"
        f"<Increment>{float(step)!r}</Increment><Offset>0.0</Offset></{name}>"
        for name, kind, step in steps
    )
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="{_NAMESPACE}">
<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>{axes}</Axes></Record1>
<Record2><Date>{date}</Date>
<Instrument><Manufacturer>mcgw</Manufacturer><Model>synthetic</Model><Serial>none</Serial>
<Version>1</Version></Instrument><CalibrationDate>{date}</CalibrationDate>
<ProbingSystem><Type>Software</Type><Identification>mcgw</Identification></ProbingSystem></Record2>
<Record3><MatrixDimension><SizeX>{columns}</SizeX><SizeY>{rows}</SizeY><SizeZ>1</SizeZ></MatrixDimension>
<DataLink><PointDataLink>{_DATA}</PointDataLink>
<MD5ChecksumPointData>{md5.upper()}</MD5ChecksumPointData></DataLink></Record3>
<Record4><ChecksumFile>{_SUMS}</ChecksumFile></Record4>
</p:ISO5436_2>
""".encode()


def read_x3p(path: Path) -> Topography:
    """Read a map: heights in m, missing points nan.

    Raises
    ------
    ValueError
        If the file is not X3P, is damaged, or declares what it does not hold.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            return _Reader(archive).topography()
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError, EOFError) as error:
        raise ValueError(f"{path}: is not a valid zip archive, as X3P files are: {error}") from None
    except (ElementTree.ParseError, KeyError, ValueError) as error:
        reason = error.args[0] if isinstance(error, KeyError) else error
        raise ValueError(f"{path}: {reason}") from None


class _Reader:
    """An open archive and its description."""

    def __init__(self, archive: zipfile.ZipFile) -> None:
        self.archive = archive
        xml = self._unpacked(_MAIN, None)
        if b"<!DOCTYPE" in xml or b"<!ENTITY" in xml or b"\0" in xml:
            raise ValueError(f"{_MAIN}: declares entities or is not UTF-8; that is refused")
        self.root = ElementTree.fromstring(xml)

    def _unpacked(self, name: str, wanted: int | None) -> bytes:
        """A member of exactly `wanted` bytes (default: of at most a megabyte)."""
        try:
            info = self.archive.getinfo(name)
        except KeyError:
            raise ValueError(f"{name}: is missing from the archive") from None
        if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise ValueError(f"{name}: is packed by method {info.compress_type}; only deflate is read")
        if wanted is None and info.file_size > _MOST_XML:
            raise ValueError(f"{name}: unpacks to {info.file_size} bytes, more than {_MOST_XML}")
        if wanted is not None and info.file_size != wanted:
            raise ValueError(f"{name}: unpacks to {info.file_size} bytes, but the map needs {wanted}")
        if info.file_size > max(_SMALL, _MOST_RATIO * info.compress_size):
            raise ValueError(
                f"{name}: unpacks {info.compress_size} bytes to {info.file_size}; that is refused"
            )
        with self.archive.open(info) as member:
            data = member.read(info.file_size + 1)
        if len(data) != info.file_size:
            raise ValueError(f"{name}: unpacks to another length than the {info.file_size} bytes declared")
        return data

    def _text(self, path: str, default: str | None = None) -> str:
        element = self.root.find(path)
        if element is None or not (element.text or "").strip():
            if default is None:
                raise ValueError(f"{_MAIN}: lacks {path}")
            return default
        return (element.text or "").strip()

    def _number(self, path: str, default: str | None = None) -> float:
        text = self._text(path, default)
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise ValueError(f"{_MAIN}: {path} = {text!r} is not a number")
        return value

    def _increment(self, path: str, default: str | None = None) -> float:
        value = self._number(path, default)
        if not value > 0:
            raise ValueError(f"{_MAIN}: {path} = {value!r}: an increment must be > 0 (m)")
        return value

    def _whole(self, path: str) -> int:
        value = self._number(path)
        if value != int(value):
            raise ValueError(f"{_MAIN}: {path} = {value!r} is not a whole number")
        return int(value)

    def topography(self) -> Topography:
        """The map."""
        if self._text("Record1/FeatureType") != "SUR":
            raise ValueError(
                f"{_MAIN}: FeatureType is {self._text('Record1/FeatureType')!r}; only SUR is read"
            )
        for axis in ("CX", "CY"):
            if self._text(f"Record1/Axes/{axis}/AxisType") != "I":
                raise ValueError(f"{_MAIN}: the points along {axis} are not equally spaced (AxisType I)")
        if self._whole("Record3/MatrixDimension/SizeZ") != 1:
            raise ValueError(f"{_MAIN}: SizeZ is not 1; a map has one layer")
        columns, rows = (self._whole(f"Record3/MatrixDimension/Size{axis}") for axis in "XY")
        checked_shape(rows, columns)
        pixel = tuple(self._increment(f"Record1/Axes/C{axis}/Increment") for axis in "XY")
        kind = self._text("Record1/Axes/CZ/DataType")
        if kind not in _TYPES:
            raise ValueError(f"{_MAIN}: DataType {kind!r} of CZ is not one of {', '.join(_TYPES)}")
        heights = self._heights(rows * columns, kind)
        heights *= self._increment("Record1/Axes/CZ/Increment", "1")
        heights += self._number("Record1/Axes/CZ/Offset", "0")
        self._mark_missing(heights)
        return Topography(heights.reshape(rows, columns), (pixel[0], pixel[1]))

    def _heights(self, number: int, kind: str) -> Array:
        name = self._text("Record3/DataLink/PointDataLink")
        data = self._unpacked(name, number * np.dtype(_TYPES[kind]).itemsize)
        told = self._text("Record3/DataLink/MD5ChecksumPointData", "")
        if told and hashlib.md5(data, usedforsecurity=False).hexdigest() != told.lower():
            raise ValueError(f"{name}: damaged (checksum mismatch with {_MAIN})")
        return np.frombuffer(data, dtype=_TYPES[kind]).astype(np.float64)

    def _mark_missing(self, heights: Array) -> None:
        name = self._text("Record3/DataLink/ValidPointsLink", "")
        if name:
            bits = np.frombuffer(self._unpacked(name, (heights.size + 7) // 8), dtype=np.uint8)
            heights[np.unpackbits(bits, count=heights.size, bitorder="little") == 0] = np.nan

"""The gate: what a file from elsewhere must be before a parser, or a library, sees it.

HDF5 (results, maps, what SurfaceTopography is given) is opened by `open_h5`: all of it must be inside the
file, and what it declares is bounded by the file's size and by memory. Archives are looked at by
`check_archive`. Nothing of the data is read, and nothing runs in another process. Text, JSON, TOML and
arrays pass `mcgw.formats.named_files`: regular files of bounded size, with bounded numbers and depth.
"""

import math
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py

from mcgw.errors import StoreError
from mcgw.formats.named_files import open_regular
from mcgw.machine.process import gibibytes, memory_available

EXPANSION = 1100  # bytes declared for each byte of the file: deflate reaches 1032
ENOUGH = 2**20  # bytes that any file may declare
MOST_CHUNK = 2**26  # bytes of a chunk that is larger than its data
MOST_OBJECTS, DEEPEST = 4096, 32  # groups, datasets and types of a file; groups within groups
MOST_MEMBERS = 1000  # of an archive
_UNPACKED, _RATIO = 2**26, 200  # bytes that any archive may unpack to; and for each byte of it
_DESCRIPTION = 2**26  # bytes of a member that describes the others
# Deflate, shuffle, fletcher32, szip, nbit and scale-offset; any other is code that HDF5 loads from a folder.
_FILTERS = {*range(1, 7), h5py.h5z.FILTER_LZF}


def open_h5(path: Path | str) -> h5py.File:
    """Open an HDF5 file for reading, if it may be read.

    What is no HDF5 file is an OSError. What is no regular file, damaged where its structure stands, leads out
    of itself, needs a filter that HDF5 would load, or declares more than it can hold, is a StoreError.
    """
    with open(open_regular(Path(path)), "rb") as found:
        size = found.seek(0, 2)
    file = opened(path)
    try:
        _check(file, size)
    except StoreError as error:
        file.close()
        raise StoreError(f"{path}: refused: {error}") from None
    except Exception as error:  # HDF5 reports damage as any of a dozen
        file.close()
        reason = " ".join(str(error).split())[:100]
        raise StoreError(f"{path}: is a damaged HDF5 file: {reason}") from None
    return file


def opened(path: Path | str) -> h5py.File:
    """Open an HDF5 file for reading without a look at it; for files that are checked otherwise."""
    try:
        return h5py.File(path, "r")
    except OSError as error:
        if "unable to lock" not in str(error):
            raise
        return h5py.File(path, "r", locking=False)  # files are whole when they get their names


def _check(file: h5py.File, size: int) -> None:
    """Refuse an open file of a size that leads out of itself, or declares what its bytes cannot hold."""
    left, seen, known = max(EXPANSION * size, ENOUGH), 0, {file["/"], None}
    groups = [("", file["/"])]
    for above, group in groups:  # those in it follow; soft links lead to what hard ones reach, in this file
        for name in group:
            path, seen = f"{above}{name}", seen + 1
            if seen > MOST_OBJECTS:
                raise StoreError(f"more than {MOST_OBJECTS} groups and datasets")
            if path.count("/") > DEEPEST:
                raise StoreError(f"groups are nested more than {DEEPEST} deep")
            link = group.get(name, getlink=True)
            if not isinstance(link, h5py.HardLink | h5py.SoftLink):
                raise StoreError(f"{path[:80]}: a link to another file")
            item = group[name] if isinstance(link, h5py.HardLink) else None
            if item in known:
                continue
            known.add(item)
            if isinstance(item, h5py.Group):
                groups.append((f"{path}/", item))
            elif isinstance(item, h5py.Dataset):
                left -= _declared(path[:80], item.id)
                if left < 0:
                    raise StoreError(f"{path[:80]}: more bytes declared than a file of {size} bytes holds")


def _declared(name: str, item: Any) -> int:
    """Return the bytes that a dataset declares; refuse data in another file, strange filters, huge chunks."""
    plist, layout = item.get_create_plist(), item.get_create_plist().get_layout()
    if plist.get_external_count() or layout not in (h5py.h5d.COMPACT, h5py.h5d.CONTIGUOUS, h5py.h5d.CHUNKED):
        raise StoreError(f"{name}: its data are in another file")
    filters = {plist.get_filter(i)[0] for i in range(plist.get_nfilters())}
    if not filters <= _FILTERS:
        raise StoreError(f"{name}: unknown filter {sorted(filters - _FILTERS)}")
    width = item.get_type().get_size()
    declared = math.prod(item.shape or ()) * width
    if layout == h5py.h5d.CHUNKED:
        chunk = math.prod(plist.get_chunk()) * width
        if chunk > max(MOST_CHUNK, declared):
            raise StoreError(f"{name}: chunks of {chunk} bytes for {declared}")
        if chunk > MOST_CHUNK and chunk > memory_available():
            raise StoreError(f"{name}: chunks of {gibibytes(chunk)}, more than the memory available")
    return int(declared)


def check_archive(path: Path) -> None:
    """Refuse a zip archive that unpacks to far more than it is, or describes itself by entities.

    Python's `zipfile` never unpacks more of a member than its directory declares, which is summed here. What
    is damaged, has too many members, or one that is encrypted or not packed by deflate, is refused, too.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            fault = next(_faults(archive, path.stat().st_size), "")
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, OSError) as error:
        fault = f"is a damaged zip archive: {str(error)[:80]}"
    if fault:
        raise ValueError(f"{path}: {fault}")


def _faults(archive: zipfile.ZipFile, size: int) -> Iterator[str]:
    """Why an archive is refused, if it is: entities make gigabytes of a line, and name other files."""
    members = archive.infolist()
    if len(members) > MOST_MEMBERS:
        yield f"an archive of {len(members)} members; at most {MOST_MEMBERS} are read"
    unpacked = sum(member.file_size for member in members)
    if unpacked > max(_UNPACKED, min(_RATIO * size, memory_available())):
        yield f"an archive of {size} bytes that unpacks to {unpacked}; that is refused"
    for member in members:
        name = repr(member.filename[:80])
        if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) or member.flag_bits & 1:
            yield f"{name} is encrypted, or not packed by deflate"
        if member.filename.lower().endswith(".xml"):
            if member.file_size > _DESCRIPTION:
                yield f"{name} is a description of {member.file_size} bytes"
            text = archive.read(member)
            if b"<!DOCTYPE" in text or b"<!ENTITY" in text or b"\0" in text:
                yield f"{name} declares entities, or is not UTF-8"

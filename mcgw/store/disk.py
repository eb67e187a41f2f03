"""How the store reads and writes: regular files that end with a trailer, and no error of the disk for HDF5.

The trailer, the last 512 bytes of a file, tells whether it is whole and unchanged. It stands at the end, so
that an HDF5 file with one begins as any other and every HDF5 reader opens it. Layout: 8 bytes magic, JSON
padded with spaces (472 bytes), SHA-256 of these 480 bytes (32 bytes). The JSON holds the length and the
SHA-256 of all that stands before the trailer, and what the writer wants known without opening the file.

A program that opens such a file for writing leaves the trailer out: what it left is compared with the digest
of its numbers (`mcgw.store.ensembles`). A shard without its trailer was never finished.

Of a file of results that is the digest of its head: attributes, types and shapes of its tables, and scales.
They are small and decide what the numbers mean, and the digest is computed again whenever the file is opened;
what is large has checksums of its own, chunk by chunk.
"""

import hashlib
import json
import math
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcgw.errors import StoreError
from mcgw.formats.named_files import open_regular

if TYPE_CHECKING:
    import h5py  # what looks at files of strangers starts without it, and may have little memory

GROUP = "drawn"  # the one group that a file may have
MOST_SCALE = 2**20  # longest scale that is checked on opening


def parts_of(path: Path) -> Path:
    """Folder of the run that makes a file."""
    return path.with_name(f"{path.name}.parts")


class SteadyFile:
    """A new file for the HDF5 library that never shows it an error, for it may crash on one.

    After the first error nothing more is written; `check` raises it.

    Parameters
    ----------
    path : Path
        Must not exist.
    """

    def __init__(self, path: Path) -> None:
        flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
        self._file = os.fdopen(os.open(path, flags, 0o644), "w+b", buffering=0)
        self._error: OSError | None = None

    def check(self) -> None:
        """Raise the first error, if there was one."""
        if self._error:
            raise self._error

    def write(self, data: Any) -> int:
        """Write all of it."""
        left = memoryview(data).cast("B")
        try:
            while left and not self._error:
                left = left[self._file.write(left) or 0 :]
        except OSError as error:
            self._error = error
        return memoryview(data).nbytes

    def truncate(self, size: int | None = None) -> int:
        """Set the length."""
        try:
            return self._file.truncate(size)
        except OSError as error:
            self._error = self._error or error
            return size or 0

    def readinto(self, buffer: Any) -> int:
        """Read; beyond the end there are zeros."""
        view = memoryview(buffer).cast("B")
        got = self._file.readinto(view) or 0
        view[got:] = bytes(len(view) - got)
        return len(view)

    def read(self, size: int) -> bytes:
        """Read as many bytes."""
        data = bytearray(size)
        self.readinto(data)
        return bytes(data)

    def seek(self, offset: int, whence: int = 0) -> int:
        """Go to a place."""
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        """Tell the place."""
        return self._file.tell()

    def flush(self) -> None:
        """Do nothing: there is no buffer."""

    def sync(self) -> None:
        """Flush to the disk."""
        os.fsync(self._file.fileno())

    def trailer(self, data: bytes) -> None:
        """Append the last bytes and flush to the disk.

        Raises
        ------
        OSError
            If this, or anything before, failed.
        """
        self._file.seek(0, os.SEEK_END)
        self.write(data)
        self.check()
        self.sync()

    def close(self) -> None:
        """Close the file, even after an error."""
        self._file.close()


TRAILER_BYTES = 512
TRAILER_MAGIC = b"MCGWSEAL"
_HEAD = TRAILER_BYTES - hashlib.sha256().digest_size
_PIECE = 2**22


@dataclass(frozen=True)
class Trailer:
    """Contents of a trailer.

    Parameters
    ----------
    length : int
        Bytes before the trailer.
    sha256 : str
        Digest of these bytes.
    notes : dict
        Further entries of its writer.
    """

    length: int
    sha256: str
    notes: dict[str, Any]

    def to_bytes(self) -> bytes:
        """The 512 bytes."""
        text = json.dumps({"length": self.length, "sha256": self.sha256, "notes": self.notes})
        head = (TRAILER_MAGIC + text.encode()).ljust(_HEAD)
        if len(head) > _HEAD:
            raise ValueError(f"trailer: {len(head)} bytes of notes, more than {_HEAD}")
        return head + hashlib.sha256(head).digest()

    @classmethod
    def from_bytes(cls, data: bytes) -> "Trailer":
        """Read it.

        Raises
        ------
        StoreError
            If it is not a trailer, or a damaged one.
        """
        head, digest = data[:_HEAD], data[_HEAD:]
        if (
            len(data) != TRAILER_BYTES
            or not head.startswith(TRAILER_MAGIC)
            or hashlib.sha256(head).digest() != digest
        ):
            raise StoreError("not a whole file of mcgw: no trailer at its end, so it was cut off or changed")
        try:
            said = json.loads(head[len(TRAILER_MAGIC) :])
            return cls(int(said["length"]), str(said["sha256"]), dict(said["notes"]))
        except (ValueError, KeyError, TypeError):
            raise StoreError("its trailer cannot be read") from None


def trailer_of(body: bytes, **notes: Any) -> bytes:
    """Trailer for a body in memory."""
    return Trailer(len(body), hashlib.sha256(body).hexdigest(), notes).to_bytes()


def read_checked(path: Path) -> tuple[Trailer, bytes]:
    """Trailer and body of a small file, checked bit by bit.

    Raises
    ------
    StoreError
        If it is not there, not whole, or damaged.
    """
    with os.fdopen(open_regular(path), "rb") as file:
        data = file.read()
    trailer = _trailer(path, data[-TRAILER_BYTES:], len(data))
    body = data[:-TRAILER_BYTES]
    if hashlib.sha256(body).hexdigest() != trailer.sha256:
        raise StoreError(f"{path}: damaged (checksum mismatch)")
    return trailer, body


def rewritten(path: Path) -> bool:
    """Whether a file has no trailer, not even a damaged one: another program that opened it left that out."""
    with os.fdopen(open_regular(path), "rb") as file:
        file.seek(max(file.seek(0, os.SEEK_END) - TRAILER_BYTES, 0))
        end = file.read()
    return not any(sign in end for sign in (TRAILER_MAGIC, b'"length": ', b'"sha256": ', b'"notes": '))


def read_trailer(path: Path) -> Trailer:
    """Trailer of a file whose length is right; the body is not looked at.

    Raises
    ------
    StoreError
        If it is not there or not whole.
    """
    with os.fdopen(open_regular(path), "rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(size - TRAILER_BYTES, 0))
        return _trailer(path, file.read(TRAILER_BYTES), size)


def check_trailer(path: Path) -> Trailer:
    """Trailer of a file of any size, checked bit by bit.

    Raises
    ------
    StoreError
        If it is not there, not whole, or damaged.
    """
    trailer = read_trailer(path)
    if sha256_of(path, trailer.length) != trailer.sha256:
        raise StoreError(f"{path}: damaged (checksum mismatch)")
    return trailer


def sha256_of(path: Path, length: int) -> str:
    """SHA-256 of the first `length` bytes of a file."""
    sha = hashlib.sha256()
    with os.fdopen(open_regular(path), "rb") as file:
        while length and (piece := file.read(min(_PIECE, length))):
            sha.update(piece)
            length -= len(piece)
    return sha.hexdigest()


def _trailer(path: Path, data: bytes, size: int) -> Trailer:
    try:
        trailer = Trailer.from_bytes(data)
    except StoreError as error:
        raise StoreError(f"{path}: {error}") from None
    if trailer.length != size - TRAILER_BYTES:
        raise StoreError(f"{path}: damaged ({size} bytes long, not {trailer.length + TRAILER_BYTES})")
    return trailer


def head_digest(file: "h5py.File") -> str:
    """SHA-256 of the head of a plain file; it does not depend on how HDF5 laid it out."""
    lines = [*_attributes("/", file.attrs)]
    names = {*file, *(f"{GROUP}/{name}" for name in file.get(GROUP, ()))}
    for name in sorted(names - {GROUP}):
        data = file[name]
        scales = [[scale.name for _, scale in axis.items()] for axis in data.dims]
        lines += [json.dumps([name, data.dtype.str, data.shape, scales]), *_attributes(name, data.attrs)]
        if data.ndim == 1 and math.prod(data.shape) <= MOST_SCALE:
            lines.append(hashlib.sha256(data[()].tobytes()).hexdigest())
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def _attributes(name: str, attributes: Any) -> Iterator[str]:
    """Attributes that are text or numbers; others only link scales to tables."""
    for key in sorted(attributes):
        value = attributes[key]
        if isinstance(value, str):
            yield json.dumps([name, key, value])
        elif hasattr(value, "tobytes") and value.dtype.kind in "iufbS":
            yield json.dumps([name, key, value.dtype.str, value.shape, value.tobytes().hex()])

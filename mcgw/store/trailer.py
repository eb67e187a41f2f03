"""A seal: the last 512 bytes of a file, which tell whether it is whole and unchanged.

It stands at the end, so that a sealed HDF5 file begins as any other and every HDF5 reader opens it; a
file without its seal was never finished. Layout: 8 bytes magic, JSON padded with spaces (472 bytes),
SHA-256 of these 480 bytes (32 bytes). The JSON holds the length and the SHA-256 of all that stands
before the seal, and what the writer wants known without opening the file.
"""

import hashlib
import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mcgw.errors import StoreError
from mcgw.formats.plain_file import open_regular

__all__ = [
    "SEAL_BYTES",
    "SEAL_MAGIC",
    "Seal",
    "check_seal",
    "read_seal",
    "read_sealed",
    "seal_of",
    "sha256_of",
]

SEAL_BYTES = 512
SEAL_MAGIC = b"MCGWSEAL"
_HEAD = SEAL_BYTES - hashlib.sha256().digest_size
_PIECE = 2**22


@dataclass(frozen=True)
class Seal:
    """What a seal says.

    Parameters
    ----------
    length : int
        Bytes before the seal.
    sha256 : str
        Digest of these bytes.
    notes : dict
        What else its writer put in.
    """

    length: int
    sha256: str
    notes: dict[str, Any]

    def to_bytes(self) -> bytes:
        """The 512 bytes."""
        text = json.dumps({"length": self.length, "sha256": self.sha256, "notes": self.notes})
        head = (SEAL_MAGIC + text.encode()).ljust(_HEAD)
        if len(head) > _HEAD:
            raise ValueError(f"seal: {len(head)} bytes of notes, more than {_HEAD}")
        return head + hashlib.sha256(head).digest()

    @classmethod
    def from_bytes(cls, data: bytes) -> "Seal":
        """Read it.

        Raises
        ------
        StoreError
            If it is no seal, or a damaged one.
        """
        head, digest = data[:_HEAD], data[_HEAD:]
        if (
            len(data) != SEAL_BYTES
            or not head.startswith(SEAL_MAGIC)
            or hashlib.sha256(head).digest() != digest
        ):
            raise StoreError("not a whole file of mcgw: no seal at its end, so it was cut off or changed")
        try:
            said = json.loads(head[len(SEAL_MAGIC) :])
            return cls(int(said["length"]), str(said["sha256"]), dict(said["notes"]))
        except (ValueError, KeyError, TypeError):
            raise StoreError("its seal cannot be read") from None


def seal_of(body: bytes, **notes: Any) -> bytes:
    """Seal for a body in memory."""
    return Seal(len(body), hashlib.sha256(body).hexdigest(), notes).to_bytes()


def read_sealed(path: Path) -> tuple[Seal, bytes]:
    """Seal and body of a small file, checked bit by bit.

    Raises
    ------
    StoreError
        If it is not there, not whole, or damaged.
    """
    with os.fdopen(open_regular(path), "rb") as file:
        data = file.read()
    seal = _seal(path, data[-SEAL_BYTES:], len(data))
    body = data[:-SEAL_BYTES]
    if hashlib.sha256(body).hexdigest() != seal.sha256:
        raise StoreError(f"{path}: damaged (checksum mismatch)")
    return seal, body


def read_seal(path: Path) -> Seal:
    """Seal of a file whose length is right; the body is not looked at.

    Raises
    ------
    StoreError
        If it is not there or not whole.
    """
    with os.fdopen(open_regular(path), "rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(size - SEAL_BYTES, 0))
        return _seal(path, file.read(SEAL_BYTES), size)


def check_seal(path: Path) -> Seal:
    """Seal of a file of any size, checked bit by bit.

    Raises
    ------
    StoreError
        If it is not there, not whole, or damaged.
    """
    seal = read_seal(path)
    if sha256_of(path, seal.length) != seal.sha256:
        raise StoreError(f"{path}: damaged (checksum mismatch)")
    return seal


def sha256_of(path: Path, length: int) -> str:
    """SHA-256 of the first `length` bytes of a file."""
    sha = hashlib.sha256()
    with os.fdopen(open_regular(path), "rb") as file:
        while length and (piece := file.read(min(_PIECE, length))):
            sha.update(piece)
            length -= len(piece)
    return sha.hexdigest()


def _seal(path: Path, data: bytes, size: int) -> Seal:
    try:
        seal = Seal.from_bytes(data)
    except StoreError as error:
        raise StoreError(f"{path}: {error}") from None
    if seal.length != size - SEAL_BYTES:
        raise StoreError(f"{path}: damaged ({size} bytes long, not {seal.length + SEAL_BYTES})")
    return seal

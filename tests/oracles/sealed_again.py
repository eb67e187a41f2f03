"""Checksums for a file that a test has changed: what a stranger could do as well."""

import hashlib

import h5py

from mcgw.store.h5_reading import checksum_of


def sealed_again(path):
    """Let all checksums be those of what stands there, if it is plain enough to have any."""
    with h5py.File(path, "r+") as file:
        for table in file.values():
            if isinstance(table, h5py.Dataset) and table.dtype.kind in "fi":
                values = table[()].astype(table.dtype.newbyteorder("<"))
                sha = hashlib.sha256(f"{values.dtype.str} {table.shape[1:]}".encode() + values.tobytes())
                table.attrs["sha256"] = sha.hexdigest()
        file.attrs["checksum"] = checksum_of(file)

"""Bytes against seconds for every way plain HDF5 has to pack the results of a run.

Surfaces of S1 with 1e4 asperities: their loads, which are noise but for the first digits (areas and
stiffnesses are alike), and their numbers of contacts. Chunks as in an ensemble file, each with a checksum;
one thread, all in memory, seconds of the processor, the least of some rounds. The two last lines are a file
of load, area, stiffness and contacts: all compressed, and as `mcgw.store.h5_writing` has it.

Run: ``python runs/bench/compression.py [SURFACES]``.
"""

import io
import sys
import time

import h5py
import numpy as np
from scenes import S1

import mcgw
from mcgw.store.h5_writing import CHUNK_ROWS, PACKED, empty_table

ROUNDS = 5
WAYS = {
    "as it is": {},
    "shuffle + LZF": {"shuffle": True, "compression": "lzf"},
    "gzip 1": {"compression": "gzip", "compression_opts": 1},
    **{
        f"shuffle + gzip {k}": {"shuffle": True, "compression": "gzip", "compression_opts": k}
        for k in (1, 2, 3, 4)
    },
}


def seconds(call):
    """Least seconds of the processor, and what the call gave."""
    times = []
    for _ in range(ROUNDS):
        begin = time.thread_time()
        result = call()
        times.append(time.thread_time() - begin)
    return min(times), result


def written(tables, store):
    """Bytes of an HDF5 file in memory."""
    body = io.BytesIO()
    with h5py.File(body, "w", libver=("v108", "v110")) as file:
        for name, values in tables.items():
            store(file, name, values)
    return body.getvalue()


def read(body):
    """All numbers of such a file."""
    with h5py.File(io.BytesIO(body), "r") as file:
        return [file[name][()] for name in file]


def told(what, tables, store):
    """Print a line: share of the bytes, and megabytes of numbers a second."""
    size = sum(values.nbytes for values in tables.values())
    writing, body = seconds(lambda: written(tables, store))
    reading, _ = seconds(lambda: read(body))
    rates = f"write {size / writing / 1e6:6.0f} MB/s   read {size / reading / 1e6:6.0f} MB/s"
    print(f"{what:32} {len(body) / size:6.3f} of the bytes   {rates}")


def as_files_are(file, name, values):
    """Store a table as the store does."""
    empty_table(file, name, len(values), values)[()] = values


def by(options):
    """A way to store a table in chunks with these filters."""

    def store(file, name, values):
        chunks = (min(CHUNK_ROWS, len(values)), *values.shape[1:])
        file.create_dataset(name, data=values, chunks=chunks, fletcher32=True, **options)

    return store


def main(surfaces):
    """Print the table."""
    scene = S1.replace(n_asperities=10**4, n_surfaces=surfaces)
    drawn = mcgw.simulate(scene)
    tables = {name: np.ascontiguousarray(getattr(drawn, name)) for name in scene.quantities}
    for name in ("load", "contacts"):
        for way, options in WAYS.items():
            told(f"{name}: {way}", {name: tables[name]}, by(options))
    packed = {name: PACKED[name] for name in ("compression", "compression_opts", "shuffle")}
    told("file: all shuffle + gzip 1", tables, by(packed))
    told("file: what shrinks by half", tables, as_files_are)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5632)

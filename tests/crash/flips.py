"""Single bits flipped where a file says what its numbers mean: ``python flips.py FOLDER FLIPS``.

Prints one JSON line: for each kind of place the flips tried, those seen when the ensemble is opened, those in
blocks that change nothing, and where the others were.
"""

import json
import os
import random
import sys
from pathlib import Path

import h5py
import numpy as np
from harness import RECORD, ROWS, Values, forked, made_up, parts_of, prepare, scene_of
from oracles.inside import Plan, Span

import mcgw
from mcgw.errors import StoreError

BLOCKS = 5


def made(folder):
    """A file of one block, one that was merged, and a run in progress."""
    scene, files = scene_of(BLOCKS), [folder / f"{name}.h5" for name in ("one-block", "merged", "begun")]
    in_blocks, Values.rows = Values.rows, BLOCKS * ROWS
    mcgw.run(scene, files[0])
    Values.rows = in_blocks
    mcgw.run(scene, files[1])
    mcgw.run(scene, files[2], shard="1/2")
    return files


def occurrences(data, piece, before=b""):
    """Offsets of all bytes of a piece, wherever it stands behind `before`."""
    start, found = data.find(before + piece), []
    while start >= 0:
        first = start + len(before)
        found += range(first, first + len(piece))
        start = data.find(before + piece, start + 1)
    return found


def attribute_bytes(data, attributes):
    """Offsets of attributes: texts, and numbers that are there once."""
    found = {}
    for name, value in attributes.items():
        if isinstance(value, bytes):
            found[name] = occurrences(data, value)
        elif isinstance(value, np.generic | np.ndarray) and value.nbytes >= 8 and value.dtype.kind in "iuf":
            places = occurrences(data, value.tobytes())
            found[name] = places if len(places) == value.nbytes else []
    return found


def places_of(file):
    """Offsets in a finished file, by kind."""
    data, places = file.read_bytes(), {"attributes": [], "scales": []}
    with h5py.File(file, "r") as opened:
        root = attribute_bytes(data, opened.attrs)
        places["scene"] = root.pop("scene")
        for item in (root, *(attribute_bytes(data, opened[name].attrs) for name in opened)):
            places["attributes"] += [offset for offsets in item.values() for offset in offsets]
        for name in ("surface", "separation"):
            table = opened[name].id
            chunks = [table.get_chunk_info(i) for i in range(table.get_num_chunks())]
            places["scales"] += [c.byte_offset + i for c in chunks for i in range(c.size)]
    return {f"{file.stem}: {kind}": (file, offsets) for kind, offsets in places.items()}


def found(file, whole):
    """What comes of a flip: "seen" as an error or a lost shard; "harmless" where HDF5 left room."""

    def look():
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115
        try:
            ensemble = mcgw.open_ensemble(file)
            if ensemble.n_surfaces < whole:
                return 1
            first = 0
            shards = [] if file.exists() else Plan.open(parts_of(file)).shards()
            for span in shards or [Span(0, whole)]:
                for name, right in made_up(None, span).items():
                    if not np.array_equal(ensemble.sums.read(name, first, first + span.n), right):
                        return 0
                first += span.n
            return 2
        except (StoreError, OSError, RuntimeError, ValueError, KeyError, TypeError):
            return 1

    return {0: "unseen", 2: "harmless"}.get(forked(look), "seen")


def main(folder, flips):
    prepare()
    folder.mkdir(parents=True)
    dice, (one, merged, begun) = random.Random(1), made(folder)
    places = places_of(one) | places_of(merged)
    shards = sorted(parts_of(begun).glob("shards/*.h5"))
    for path in (parts_of(begun) / RECORD, *shards):
        places[path.name] = (path, range(path.stat().st_size))
    held = {begun: mcgw.open_ensemble(begun).n_surfaces}
    counted = {kind: {"flips": 0, "seen": 0, "harmless": 0, "unseen": []} for kind in places}
    for i in range(flips):
        kind = list(places)[i % len(places)]
        path, offsets = places[kind]
        opened = path if path in (one, merged) else begun
        data = bytearray(good := path.read_bytes())
        at = dice.choice(offsets)
        data[at] ^= 1 << dice.randrange(8)
        path.write_bytes(data)
        counted[kind]["flips"] += 1
        what = found(opened, held.get(opened, 0))
        if what == "harmless" and opened == begun:  # elsewhere the places are of what counts
            counted[kind]["harmless"] += 1
        elif what == "seen":
            counted[kind]["seen"] += 1
        else:
            counted[kind]["unseen"].append(at)
        path.write_bytes(good)
    unseen = sum(len(found["unseen"]) for found in counted.values())
    sys.stdout.write(json.dumps({"flips": flips, "unseen": unseen, "where": counted}) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]))

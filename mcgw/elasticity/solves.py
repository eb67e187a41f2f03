"""Solves of levels on maps, each made once and kept: in memory, or as lines of a file that others resume."""

import hashlib
import json
import warnings
from collections.abc import Mapping, Sequence
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.elasticity.levels import Level, Pressed, Values
from mcgw.elasticity.sources import Maps
from mcgw.errors import StoreError
from mcgw.formats.files import write_whole
from mcgw.formats.named_files import loads_json, read_bytes

_MOST_BYTES = 2**28  # of a file: a million solves


class Solves:
    """Values of levels on maps, by their numbers, each solved once.

    At the pressure (Pa) or the separation (m) that is `held`. A solve is added to the file of the `path`, if
    there is one, to which no other process may add meanwhile, and those of the file are not made again. Lines
    that are damaged are named in one warning and left out. StoreError if the file holds something else than
    solves of these maps at this pressure, separation, modulus and seed.
    """

    def __init__(
        self, maps: Maps, held: Mapping[str, float], E_star: float, seed: int, quantities: Sequence[str],
        path: Path | None = None,
    ) -> None:  # fmt: skip
        self.maps, self.held, self.E_star, self.seed, self.quantities = maps, held, E_star, seed, quantities
        self._rows: dict[tuple[str, int], tuple[Values, float]] = {}
        self._path = path
        if path is not None:
            determined = hashlib.sha256()  # by all given maps, or the first one of those that are drawn
            for number in range(maps.number or 1):
                determined.update(maps.heights(number, seed).tobytes())
            question = {"maps": determined.hexdigest()[:16], **held, "E_star": E_star, "seed": seed}
            self._header = json.dumps(question)
            self._resume(path, _written(question, ""))

    def at(self, levels: Sequence[Level], number: int) -> tuple[Array, Array]:
        """Quantities of a map at levels, shape (levels, quantities), and the CPU seconds that each took."""
        pressed = None
        for level in levels:
            key = (level.name, number)
            if key in self._rows:
                continue
            if pressed is None:
                heights = self.maps.heights(number, self.seed)
                pressed = Pressed(heights, self.maps.size, self.E_star, **self.held)
            self._rows[key] = level.timed(pressed)
            if self._path is not None:
                with open(self._path, "a", encoding="utf-8") as file:
                    file.write(self._line(key))
        rows = [self._rows[level.name, number] for level in levels]
        values = [[values[name] for name in self.quantities] for values, _ in rows]
        return np.array(values), np.array([seconds for _, seconds in rows])

    @property
    def seconds(self) -> float:
        """CPU seconds of all."""
        return sum(seconds for _, seconds in self._rows.values())

    def _resume(self, path: Path, first: str) -> None:
        if not path.exists():
            write_whole(path, first.encode())
            return
        text = read_bytes(path, _MOST_BYTES).decode("utf-8", errors="replace")
        header, *lines = StringIO(text, newline="\n") if text else [""]
        if header != first:
            held = f"these maps at this {next(iter(self.held))}"
            raise StoreError(f"{path}: its first line does not name {held}; give another path")
        damaged = []
        for number, line in enumerate(lines, 2):
            row = _checked(line, self._header)
            if row is None or (row["level"], row["map"]) in self._rows:
                damaged.append(str(number))
            else:
                self._rows[row["level"], row["map"]] = row["values"], row["seconds"]
        if damaged:
            write_whole(path, "".join([first, *map(self._line, self._rows)]).encode())
            shown = ", ".join(damaged[:5]) + (f" and {len(damaged) - 5} more" if len(damaged) > 5 else "")
            warnings.warn(
                f"{path}: damaged or repeated lines are left out, and solved again where needed: {shown}",
                stacklevel=2,
            )

    def _line(self, key: tuple[str, int]) -> str:
        values, seconds = self._rows[key]
        row = {"level": key[0], "map": key[1], "values": values, "seconds": seconds}
        return _written(row, self._header)


def _written(row: Mapping[str, Any], header: str) -> str:
    """Return a line with a checksum at its end, which binds it to the question of its file."""
    checksum = hashlib.sha256(f"{header}\n{json.dumps(row)}".encode()).hexdigest()[:16]
    return json.dumps({**row, "check": checksum}) + "\n"


def _checked(line: str, header: str) -> dict[str, Any] | None:
    """Return what a line holds, if it is as it was written."""
    try:
        row: dict[str, Any] = loads_json(line.encode())
        del row["check"]
    except (KeyError, TypeError, ValueError):
        return None
    return row if _written(row, header) == line else None

"""Solves of levels on maps, each made once and kept: in memory, or as lines of a file that others resume."""

import hashlib
import json
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from filelock import FileLock, Timeout

from analytic.arrays import Array
from mcgw.elasticity.levels import Level, Pressed, Values
from mcgw.elasticity.sources import Maps
from mcgw.errors import StoreError
from mcgw.formats.files import write_whole

_PATIENCE = 1.0  # seconds: a process that was killed may need a moment to die
_MOST_BYTES = 2**28  # of a file: a million solves
_MOST_IN_LINE = 4096  # a solve takes 300
_CHECK = ', "check": "{}"}}'
_CHECK_LENGTH = len(_CHECK.format("0" * 16))


class Solves:
    """Values of levels on maps, each solved once.

    Parameters
    ----------
    maps : Maps
        The maps, by their numbers.
    held : mapping of str to float
        The pressure (Pa) or the separation (m).
    E_star : float
        Composite modulus, Pa.
    seed : int
        Of the maps.
    quantities : sequence of str
        Those that are asked for, in this order.
    """

    def __init__(
        self, maps: Maps, held: Mapping[str, float], E_star: float, seed: int, quantities: Sequence[str]
    ) -> None:
        self.maps, self.held, self.E_star, self.seed, self.quantities = maps, held, E_star, seed, quantities
        self._rows: dict[tuple[str, int], tuple[Values, float]] = {}
        self._path: Path | None = None
        self._plan: dict[str, Any] | None = None
        self._last: tuple[int, Pressed] | None = None

    @contextmanager
    def kept_in(self, path: Path) -> Iterator[None]:
        """Read what a file holds, and add each solve to it; no other process may do so meanwhile.

        Lines that are damaged are named in one warning and left out: their maps are solved again.

        Raises
        ------
        StoreError
            If another process holds the file, or it holds something else than solves of these maps at this
            pressure, separation, modulus and seed.
        """
        beside = path.with_name(path.name + ".lock")
        lock = FileLock(beside, timeout=_PATIENCE)
        try:
            lock.acquire()
            if not beside.exists():  # its holder has just removed it: somebody else may make it anew
                lock.release()
                raise Timeout(str(beside))
        except Timeout:
            raise StoreError(
                f"{path}: another process adds solves to it; wait, or give another path"
            ) from None
        except (OSError, NotImplementedError) as error:
            raise StoreError(f"{path}: cannot be locked ({error}); give another path") from None
        try:
            self._resume(path)
            yield
        finally:
            self._path = None
            beside.unlink(missing_ok=True)
            lock.release()

    def at(self, level: Level, number: int) -> tuple[Array, float]:
        """Quantities of a map at a level, and the CPU seconds they took."""
        key = (level.name, number)
        if key not in self._rows:
            if self._last is None or self._last[0] != number:
                heights = self.maps.heights(number, self.seed)
                self._last = number, Pressed(heights, self.maps.size, self.E_star, **self.held)
            self._rows[key] = level.timed(self._last[1])
            if self._path is not None:
                with open(self._path, "a", encoding="utf-8") as file:
                    file.write(self._line(key))
        values, seconds = self._rows[key]
        return np.array([values[name] for name in self.quantities]), seconds

    def record(self, plan: dict[str, Any]) -> None:
        """Write the plan into the first line of the file, if there is one."""
        if self._path is not None and plan != self._plan:
            self._plan = plan
            self._rewrite()

    @property
    def seconds(self) -> float:
        """CPU seconds of all."""
        return sum(seconds for _, seconds in self._rows.values())

    @property
    def _question(self) -> dict[str, Any]:
        """What determines a value: all maps that were given, or the first one of those that are drawn."""
        found = hashlib.sha256()
        for number in range(self.maps.number or 1):
            found.update(self.maps.heights(number, self.seed).tobytes())
        return {"maps": found.hexdigest()[:16], **self.held, "E_star": self.E_star, "seed": self.seed}

    def _resume(self, path: Path) -> None:
        self._path, self._asked = path, self._question
        if not path.exists():
            self._rewrite()
            return
        header, *rows = _lines_of(path)
        found = _checked(header, "")
        self._plan = found.pop("plan", None) if found else None
        if found != self._asked:
            what = next(iter(self.held))
            raise StoreError(
                f"{path}: its first line does not name these maps at this {what}; give another path"
            )
        damaged = []
        for number, line in enumerate(rows, 2):
            row = _checked(line, self._salt)
            if row is None or (row["level"], row["map"]) in self._rows:
                damaged.append(str(number))
            else:
                self._rows[row["level"], row["map"]] = row["values"], row["seconds"]
        if damaged:
            self._rewrite()
            shown = ", ".join(damaged[:5]) + (f" and {len(damaged) - 5} more" if len(damaged) > 5 else "")
            warnings.warn(
                f"{path}: damaged or repeated lines are left out, and solved again where needed: {shown}",
                stacklevel=2,
            )

    def _rewrite(self) -> None:
        assert self._path is not None
        header = self._asked if self._plan is None else {**self._asked, "plan": self._plan}
        lines = [_written(header, ""), *map(self._line, self._rows)]
        write_whole(self._path, ["".join(lines).encode()])

    @property
    def _salt(self) -> str:
        """What binds a line to its question, so that one of another file does not pass for one of this."""
        return json.dumps(self._asked)

    def _line(self, key: tuple[str, int]) -> str:
        values, seconds = self._rows[key]
        row = {"level": key[0], "map": key[1], "values": values, "seconds": seconds}
        return _written(row, self._salt)


def _lines_of(path: Path) -> list[str]:
    """Lines of a regular file of bounded size; the last one without its end, if it was cut, counts as one."""
    if not path.is_file():
        raise StoreError(f"{path}: is no regular file; give another path")
    if (size := path.stat().st_size) > _MOST_BYTES:
        raise StoreError(f"{path}: {size} bytes are no file of solves; give another path")
    try:
        text = path.read_bytes().decode("utf-8", errors="replace")
    except OSError as error:
        raise StoreError(f"{path}: cannot be read ({error.strerror})") from None
    *whole, cut = text.split("\n")
    return [*whole, *([f"{cut}\0"] if cut or not whole else [])]


def _checksum(body: str, salt: str) -> str:
    return hashlib.sha256(f"{salt}\n{body}".encode()).hexdigest()[:16]


def _written(row: Mapping[str, Any], salt: str) -> str:
    """A line with its checksum at the end."""
    body = json.dumps(row)
    return body[:-1] + _CHECK.format(_checksum(body, salt)) + "\n"


def _checked(line: str, salt: str) -> dict[str, Any] | None:
    """What a line holds, if it is as it was written; no parser sees any other."""
    body = line[:-_CHECK_LENGTH] + "}"
    if len(line) > _MOST_IN_LINE or line[:-_CHECK_LENGTH] + _CHECK.format(_checksum(body, salt)) != line:
        return None
    found: dict[str, Any] = json.loads(body)
    return found

"""Ensembles as HDF5 files.

A file appears whole or not at all: it is written under a temporary name and renamed. Its schema
(``filetype = "mcgw-ensemble"``, ``format = [1, 0]``)::

    /                     attributes: filetype, format, title, scene (TOML text of the resolved scene),
                          seed, sampler, complete, digest, versions, commit, date, cpu, wall_seconds
    /surface              int64 (surfaces,)               dimension scale: numbers of the surfaces
    /separation           float64 (separations,)          dimension scale: d/sigma
    /load                 float64 (surfaces, separations) N
    /area                 float64 (surfaces, separations) m^2
    /stiffness            float64 (surfaces, separations) N/m
    /contacts             int64   (surfaces, separations) 1   (float64 expectation if stratified)
    /conductance          float64 (surfaces, separations) m   (times 1/rho)

and, if the scene says ``keep = "moments"``, what `mcgw.regrade` starts from::

    /drawn/moments        float64 (surfaces, moments)     sums of Chebyshev polynomials, cell by cell
    /drawn/cells          float64 (surfaces, cells)       asperities in each cell
    /drawn/extras         float64 (extras, 3)             surface, height, weight of those outside

Every dataset at the root has the attributes `units` and `long_name`; only quantities that the scene
asks for are there. Chunked, shuffled, compressed with gzip.
"""

import hashlib
import os
import platform
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from time import monotonic
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from analytic import QUANTITIES
from mcgw.ensemble import Ensemble
from mcgw.samplers import sampler_of
from mcgw.scene import Scene
from mcgw.scene_file import scene_from, scene_text
from mcgw.simulation import blocks, kept, use_threads

__all__ = ["StoreError", "open_ensemble", "run", "save"]

FILETYPE, FORMAT = "mcgw-ensemble", (1, 0)
_CHUNK_ROWS = 256
_DRAWN = ("moments", "cells", "extras")


class StoreError(ValueError):
    """A file that cannot be read or written as an ensemble."""


@dataclass(frozen=True)
class FileSums:
    """The datasets of an ensemble file, opened for each reading."""

    path: Path

    def read(self, name: str, start: int, stop: int | None) -> NDArray[Any]:
        """Rows `start` to `stop` of a dataset."""
        with h5py.File(self.path, "r") as file:
            return np.asarray(file[_path(name)][start:stop])

    def rows(self) -> int:
        """Number of surfaces."""
        with h5py.File(self.path, "r") as file:
            return int(file["surface"].shape[0])


def _path(name: str) -> str:
    return f"drawn/{name}" if name in _DRAWN else name


def run(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = None,
    progress: Callable[[int], Any] | None = None,
) -> Ensemble:
    """Draw the ensemble of a scene into a file.

    Parameters
    ----------
    scene : Scene
        What is asked.
    path : str or Path
        The file; it appears when it is complete.
    threads : int, optional
        Left out: all there are. The data are the same for any number.
    progress : callable, optional
        Called with the number of surfaces after each block.

    Returns
    -------
    Ensemble
        That reads from the file.

    Raises
    ------
    StoreError
        If the file cannot be written there.
    """
    path = Path(path)
    sampler = sampler_of(scene)
    started = monotonic()
    with _whole_file(path) as file, use_threads(threads):
        _lay_out(file, scene, sampler.name)
        for first, block in blocks(scene, sampler):
            arrays = kept(scene, block)
            _append(file, first, arrays)
            if progress:
                progress(len(arrays[scene.quantities[0]]))
        file.attrs["digest"] = _digest(file, scene)
        file.attrs["wall_seconds"] = monotonic() - started
    return open_ensemble(path)


def save(ensemble: Ensemble, path: str | Path) -> Ensemble:
    """Write an ensemble that is in memory, such as a regraded one.

    Parameters
    ----------
    ensemble : Ensemble
        With all that its scene asks for.
    path : str or Path
        The file.

    Returns
    -------
    Ensemble
        That reads from the file.

    Raises
    ------
    StoreError
        If the file cannot be written there.
    """
    scene = ensemble.scene
    names = [*scene.quantities, *(_DRAWN if scene.keep == "moments" else ())]
    with _whole_file(Path(path)) as file:
        _lay_out(file, scene, ensemble.sampler)
        _append(file, 0, {name: ensemble.sums.read(name, 0, None) for name in names})
        file.attrs["digest"] = _digest(file, scene)
        file.attrs["wall_seconds"] = 0.0
    return open_ensemble(path)


def _append(file: h5py.File, first: int, arrays: dict[str, NDArray[Any]]) -> None:
    """Write a block: rows of surfaces, and the ragged table of extras behind those there are."""
    for name, values in arrays.items():
        if name in _DRAWN:
            if _path(name) not in file:
                shape = (0, values.shape[1])
                file.create_dataset(_path(name), shape, "<f8", maxshape=(None, shape[1]), chunks=True)
            data = file[_path(name)]
            start = len(data)
            data.resize(start + len(values), axis=0)
            data[start:] = values
        else:
            file[name][first : first + len(values)] = values


def open_ensemble(path: str | Path) -> Ensemble:
    """Open an ensemble file.

    Parameters
    ----------
    path : str or Path
        Written by `run`.

    Returns
    -------
    Ensemble
        Its arrays are read when they are asked for.

    Raises
    ------
    StoreError
        If it is no ensemble file, or of another format.
    """
    path = Path(path)
    attributes = read_attributes(path)
    return Ensemble(scene_from(str(attributes["scene"])), str(attributes["sampler"]), FileSums(path))


def read_attributes(path: Path) -> dict[str, Any]:
    """Root attributes of an ensemble file, checked for what it is."""
    try:
        with h5py.File(path, "r") as file:
            attributes = dict(file.attrs)
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else "not an HDF5 file, or a damaged one"
        raise StoreError(f"{path}: {reason}") from None
    if attributes.get("filetype") != FILETYPE:
        raise StoreError(f"{path}: not an ensemble file (filetype is not {FILETYPE!r})")
    major, minor = (int(part) for part in attributes["format"])
    if major != FORMAT[0]:
        raise StoreError(f"{path}: format {major}.{minor}; this version reads {FORMAT[0]}.x")
    return attributes


def file_digest(path: Path) -> str:
    """Digest of what a file holds now, from its data."""
    ensemble = open_ensemble(path)
    with h5py.File(path, "r") as file:
        return _digest(file, ensemble.scene)


@contextmanager
def _whole_file(path: Path) -> Iterator[h5py.File]:
    """Write an HDF5 file under a temporary name and give it its own when all went well."""
    if path.is_symlink() or (path.exists() and not path.is_file()):
        raise StoreError(f"{path}: is no regular file; choose another -o")
    temporary = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with h5py.File(temporary, "x") as file:
            yield file
        with open(temporary, "rb") as written:
            os.fsync(written.fileno())
        temporary.replace(path)
    except OSError as error:
        raise StoreError(f"{path}: cannot be written ({error.strerror or error})") from None
    finally:
        temporary.unlink(missing_ok=True)


def _lay_out(file: h5py.File, scene: Scene, sampler: str) -> None:
    """Empty datasets with their scales, units and names, and what is known beforehand."""
    file.attrs.update(
        filetype=FILETYPE,
        format=FORMAT,
        title=scene.title,
        scene=scene_text(scene),
        seed=np.uint64(scene.seed),
        sampler=sampler,
        complete=True,
        date=datetime.now(UTC).isoformat(timespec="seconds"),
        **_provenance(),
    )
    shape = (scene.n_surfaces, len(scene.separations))
    scales = {
        "surface": (np.arange(shape[0]), "number of the surface"),
        "separation": (np.array(scene.separations), "mean-plane separation d/sigma"),
    }
    for name, (values, long_name) in scales.items():
        scale = file.create_dataset(name, data=values)
        scale.attrs.update(units="1", long_name=long_name)
        scale.make_scale(name)
    for name in scene.quantities:
        q = QUANTITIES[name]
        integral = name == "contacts" and scene.sampler != "stratified"
        data = file.create_dataset(
            name,
            shape,
            "<i8" if integral else "<f8",
            chunks=(min(_CHUNK_ROWS, shape[0]), shape[1]),
            compression="gzip",
            compression_opts=1,
            shuffle=True,
        )
        data.attrs.update(units=q.unit, long_name=q.long_name)
        for axis, scale_name in enumerate(scales):
            data.dims[axis].attach_scale(file[scale_name])


def _digest(file: h5py.File, scene: Scene) -> str:
    """SHA-256 over the scene and the names, shapes and values: not over the bytes of the container."""
    sha = hashlib.sha256(scene_text(scene).encode())
    for name in ("separation", *scene.quantities):
        data = file[name]
        sha.update(f"{name} {data.shape} {data.dtype.str}\n".encode())
        for start in range(0, data.shape[0], 65536):
            sha.update(np.ascontiguousarray(data[start : start + 65536]).tobytes())
    return sha.hexdigest()


def _provenance() -> dict[str, str]:
    """Versions, commit and processor, as far as they are known."""
    packages = ("mcgw", "numpy", "scipy", "numba", "h5py")
    versions = [f"python {platform.python_version()}"]
    for name in packages:
        try:
            versions.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            versions.append(f"{name} unknown")
    return {"versions": ", ".join(versions), "commit": _commit(), "cpu": _processor()}


def _commit() -> str:
    """Commit of a source checkout, "unknown" for an installed package."""
    here = Path(__file__).resolve().parent.parent
    if not (here / ".git").exists():
        return "unknown"
    call = ["git", "-C", str(here), "rev-parse", "HEAD"]
    try:
        return subprocess.run(call, capture_output=True, text=True, timeout=5, check=True).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return "unknown"


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if sys.platform == "linux" and info.exists():
        names = [
            line.split(":", 1)[1].strip() for line in info.read_text().splitlines() if "model name" in line
        ]
        if names:
            return f"{names[0]} ({len(names)} cores)"
    return platform.processor() or platform.machine()

"""What processes that died left behind: temporary files, and folders of runs that hold nothing more."""

from contextlib import suppress
from pathlib import Path

from mcgw.errors import StoreError
from mcgw.formats.files import remove_stale
from mcgw.scene.scene_file import scene_from
from mcgw.store.ensembles import read_attributes
from mcgw.store.lock import locked
from mcgw.store.run_folder import RunFolder, parts_of, remove_run

__all__ = ["drop_leftovers", "tidy"]


def tidy(path: Path) -> None:
    """Remove what dead processes left of the making of a file; nothing that a command could go on from.

    Nothing is done, and nothing said, where another process works on that file or nothing may be removed.
    """
    remove_stale(path)
    folder = parts_of(path)
    if folder.is_dir() and not folder.is_symlink():
        with suppress(StoreError, OSError), locked(folder, patience=0):
            drop_leftovers(path)


def drop_leftovers(path: Path) -> None:
    """As `tidy`, for who has the lock."""
    folder = parts_of(path)
    for left in (*folder.glob(".*.tmp"), *(folder / "shards").glob(".*.tmp")):
        left.unlink(missing_ok=True)
    if not _of_use(path):
        remove_run(folder)


def _of_use(path: Path) -> bool:
    """Whether a run has a block that its file does not have."""
    folder = parts_of(path)
    begun = (folder / "run.toml").exists()  # without it nobody knows what the blocks are
    shards = list((folder / "shards").glob("block-*.h5")) if begun else []
    if not shards or not path.exists():
        return bool(shards)
    try:
        run, attributes = RunFolder.open(folder), read_attributes(path)
        same = attributes.get("run") == run.identity
        here = run.plan.total if run.axes else scene_from(attributes["scene"]).n_surfaces
        held = here if same else 0
    except StoreError:
        return True  # a person must look
    return any(int(shard.stem.removeprefix("block-")) >= held for shard in shards)

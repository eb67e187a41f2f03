"""From the blocks of a run to its file."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from mcgw.ensemble.ensemble import Ensemble
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import rename_over, state_of, sync, temporary_beside
from mcgw.jobs.driver import Signals, heed_signals
from mcgw.scene.scene import Scene
from mcgw.store.ensembles import finished, open_ensemble
from mcgw.store.leftovers import tidy
from mcgw.store.lock import locked
from mcgw.store.merged_file import merge_into
from mcgw.store.run_folder import RunFolder, parts_of

__all__ = ["merge", "merge_once"]


def merge(path: str | Path) -> Ensemble:
    """As `mcgw.merge`, of a run.

    Parameters
    ----------
    path : str or Path
        The file to be.

    Returns
    -------
    Ensemble
        That reads from it.

    Raises
    ------
    StoreError
        If there is no such run.
    RunError
        If blocks are missing, or the disk does not take the file.
    """
    path = Path(path)
    tidy(path)
    if not parts_of(path).exists():
        if path.exists():
            return open_ensemble(path)
        raise StoreError(f"{path}: neither this file nor blocks of it ({parts_of(path)}) are there")
    with heed_signals() as signals, locked(parts_of(path)):
        started = RunFolder.open(parts_of(path))
        gaps = started.missing(finished(path, started.scene, started.sampler), started.sweep())
        if gaps:
            raise RunError(
                f"{path}: {sum(span.n for span in gaps)} of {started.scene.n_surfaces} surfaces are missing, "
                f"from {gaps[0].first} on; run the jobs that make them again"
            )
        if not merge_once(started, path, signals):
            raise RunError(f"{started.folder}: a shard is damaged; run the jobs again, which draw it anew")
    return open_ensemble(path)


def merge_once(started: RunFolder, path: Path, signals: Signals) -> bool:
    """Make the file and remove the shards; False if a shard turned out damaged. Only with the lock."""
    temporary, before = temporary_beside(started.folder / path.name), state_of(path)
    finished(path, started.scene, started.sampler)

    def check() -> None:
        signals.check(f"all blocks are kept in {started.folder}; the same command merges them")

    try:
        _merge_of(started.scene)(started.folder, path, temporary, check)
        rename_over(temporary, path, before)
        sync(path.parent)
    except StoreError:
        return False
    except RunError:
        raise
    except FileExistsError as error:
        raise RunError(
            f"{path}: {error.strerror}; it is left as it is. All blocks are kept in {started.folder}: move "
            "that file away, the same command goes on"
        ) from None
    except (OSError, RuntimeError) as error:
        raise RunError(
            f"{path}: cannot be merged ({_why(error)}); is the disk full? All blocks are kept in "
            f"{started.folder}, the same command goes on"
        ) from None
    finally:
        with suppress(OSError):
            temporary.unlink()
    started.remove()
    return True


def _merge_of(scene: Scene) -> Callable[[Path, Path, Path, Callable[[], None]], None]:
    """How the shards of a scene become a file."""
    if scene.keep != "statistics":
        return merge_into
    from mcgw.store.merged_statistics import merge_statistics  # for those scenes alone

    return merge_statistics


def _why(error: OSError | RuntimeError) -> str:
    said = error.strerror if isinstance(error, OSError) else None
    return said or next(iter(str(error).splitlines()), type(error).__name__)

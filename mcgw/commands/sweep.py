"""``mcgw sweep``: many scenes on the same surfaces."""

from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any

from mcgw.commands.kinds import Call, Cautioned, Kind, as_value, file_out, pair, ranged
from mcgw.commands.options import Dask, Jobs, Share, Threads, drawing, share_done
from mcgw.commands.outputs import HDF5
from mcgw.commands.voice import details, news

_VALUES = "KEY=VALUES, such as grading.gamma=0.2:2:10 or =0.5,1,2"


def _value(text: str) -> Any:
    """Return what a text is as TOML, a number such as .5, or the text."""
    value = as_value(text)
    with suppress(ValueError):
        return float(value) if isinstance(value, str) else value
    return value


def _axes(given: list[str], option: str, call: Call) -> dict[str, list[Any]]:  # noqa: ARG001
    """Return lists of values by key."""
    axes: dict[str, list[Any]] = {}
    for text in given:
        key, words = pair(text, option, _VALUES)
        parts = [_value(part) for part in words.split(":")]
        if len(parts) == 3 and not any(isinstance(part, str) for part in parts):
            axes[key] = ranged(words, f"{option} {key}")
        else:
            axes[key] = [_value(word) for word in words.split(",")]
    return axes


def sweep(
    scene: Cautioned,
    *,
    over: Annotated[dict[str, list[Any]], Kind(action="append", read=_axes)],
    zip: bool = False,  # noqa: A002
    plan: bool = False,
    output: Annotated[Path, file_out(HDF5, "out/{}.sweep.h5", grows=True, dry="plan")],
    threads: Threads = None,
    jobs: Jobs = None,
    dask: Dask = None,
    shard: Share = None,
) -> None:
    """Draw many scenes at once on the same surfaces: means, deviations, paired ratios; resumes.

    Parameters
    ----------
    scene : SCENE
        TOML file with what all points have in common
    over : KEY=VALUES
        a key of the scene and its values, such as ensemble.n_asperities=1e4,1e5 or grading.gamma=0.2:2:10
        (A:B:N for N of them from A to B, at equal steps); repeat for more axes
    zip
        combine the first values of all keys into one point, and so on
    plan
        print what would be drawn and how long it takes, without drawing
    output : FILE.h5
        the sweep

    Examples
    --------
    mcgw sweep runs/demo.toml --over grading.gamma=0.2:2:10 -o gamma.h5
    """
    from mcgw.jobs.running import sweep as drawn
    from mcgw.reports.text import ratios_in_words
    from mcgw.sweeps.axes import axes_of

    if plan:
        from mcgw.reports.plan import sweep_plan_text
        from mcgw.sweeps.points import Points

        return print(sweep_plan_text(Points.of(scene, axes_of(over, zipped=zip))))
    with drawing(threads, jobs, dask, shard) as how:
        found = drawn(scene, over, zipped=zip, path=output, **how)
    if shard is not None:
        return news(share_done(shard, output, found))
    ratios = ratios_in_words(found)
    news(f"{output}: {found.axes.size} scenes, seed {scene.seed}", *ratios[:1])
    details(*ratios[1:])
    news(f"next: mcgw compare {output}")
    return details(found)

"""``mcgw show``: the contents of a file."""

from pathlib import Path
from typing import Annotated

from mcgw.commands.kinds import AT_MOST_ONE, SceneOrResults, Table
from mcgw.commands.voice import ALL, news, says, tell_cautions


def show(
    file: SceneOrResults,
    *,
    scene: Annotated[bool, AT_MOST_ONE] = False,
    digest: Annotated[bool, AT_MOST_ONE] = False,
    plan: Annotated[bool, AT_MOST_ONE] = False,
    verify: Annotated[bool, AT_MOST_ONE] = False,
    csv: Table = None,
) -> bool | None:
    """Show the contents of an ensemble file, the progress of its run, or the plan of a scene.

    Parameters
    ----------
    file : FILE
        file of an ensemble or of a sweep (HDF5); or a scene (TOML), for its plan
    scene
        print the scene as TOML, ready to run again
    digest
        print the digest of scene and data
    plan
        FILE is a scene: print what would be drawn and how long it takes
    verify
        verify every number by its checksum

    Examples
    --------
    mcgw show demo.h5
    """
    from mcgw.store.ensembles import open_results, read_attributes, unfinished, verify as verified
    from mcgw.store.place import tidy

    if csv and (scene or digest or verify or plan):
        raise ValueError(f"--csv {csv}: belongs to the summary; leave out the other option")
    if not isinstance(file, Path):
        from mcgw.reports.plan import plan_text

        return print(plan_text(file))
    if plan:
        raise ValueError(
            f"{file}: --plan is of a scene (.toml); print its scene with mcgw show --scene {file}"
        )
    tidy(file)
    if (begun := unfinished(file)) is not None and begun.axes:
        from mcgw.errors import StoreError
        from mcgw.reports.text import progress_of

        if verify or digest or csv:
            raise StoreError(f"{file}: is an unfinished sweep; finish it with mcgw sweep")
        return print(begun.text if scene else progress_of(begun), end="" if scene else "\n")
    if verify:
        problem, found = verified(file)
        print(f"{file}: {f'DAMAGED, {problem}' if problem else 'intact'} ({found})")
        return not problem
    attributes = read_attributes(file)
    if scene or digest:
        return print(attributes["scene" if scene else "digest"], end="" if scene else "\n")
    from mcgw.reports.text import summary_of, table_of

    result = open_results(file)
    print(summary_of(result, attributes, says(ALL)))
    if csv:
        table_of(result).write(csv)
        news(f"{csv}: the table")
    tell_cautions(result)
    return None

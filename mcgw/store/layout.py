"""What the file of an ensemble holds; the schema is written out in `mcgw.store`."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from mcgw.ensemble.labelled import AXES, Labelled, Variable
from mcgw.ensemble.results import Tables
from mcgw.errors import StoreError
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.store.h5_file import FILETYPE, FORMAT, Contents
from mcgw.store.identity import commit, now, processor, versions
from mcgw.store.structure import GROUP, MOST_TEXT


def contents_of_values(scene: Scene, sampler: str, values: Callable[[str], Any], **about: Any) -> Contents:
    """Those of a scene of which the values of every surface are kept: arrays, or `Rows`."""
    variables = {
        "surface": Variable(("surface",), np.arange(scene.n_surfaces), *AXES["surface"]),
        "separation": Variable(("separation",), np.array(scene.separations), *AXES["separation"]),
    }
    for name, shape in sorted(scene.shapes.items()):
        q = scene.quantity(name)
        dims = ("surface", "separation")[: 1 + len(shape)]
        variables[name] = Variable(dims, values(name), q.unit, q.long_name)
    text = scene_text(scene, left_out=False)
    return Contents(variables, attributes_of(scene, sampler, stored_text(scene), **about), text)


def contents_of_kept(
    labelled: Labelled, drawn: Tables, attributes: Mapping[str, Any], *texts: str
) -> Contents:
    """Those of a file without surfaces: what others read, and in one group what that follows from."""
    scales = {name: one for name, one in labelled.coordinates.items() if one.dims == (name,)}
    drawn_from = {f"{GROUP}/{name}": Variable((), values, "", "") for name, values in drawn.items()}
    variables = {**scales, **labelled.coordinates, **labelled.variables, **drawn_from}
    return Contents(variables, attributes, "\0".join(texts))


def attributes_of(scene: Scene, sampler: str, text: str, /, **about: Any) -> dict[str, Any]:
    """Root attributes of a file, where a text describes the scene, and more of them."""
    usual = {
        "filetype": FILETYPE,
        "format": FORMAT,
        "title": scene.title,
        "scene": text,
        "seed": np.uint64(scene.seed),
        "sampler": sampler,
        "date": now(),
        "versions": versions(),
        "commit": commit(),
        "cpu": processor(),
    }
    if scene.accuracy:
        from mcgw.sampling.samplers import distance_of  # for those scenes alone

        usual["accuracy_spent"] = distance_of(scene)  # how far from the exact laws it went
    return {**usual, **about}


def stored_text(scene: Scene) -> str:
    """The scene as its file holds it.

    Raises
    ------
    StoreError
        If it is longer than the file may be told: a list of very many heights, or radii.
    """
    text = scene_text(scene)
    if len(text.encode()) > MOST_TEXT:
        raise StoreError(
            f"scene: its lists need {len(text)} characters, but a file of results holds at most {MOST_TEXT}; "
            "list fewer summits, or simulate in memory"
        )
    return text

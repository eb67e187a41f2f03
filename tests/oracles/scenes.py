"""Scenes by the names of their values, whichever part has them."""

import mcgw
from mcgw.scene.reading import of_arguments


def scene_by(surface, **values):
    """A scene whose parts are made of values, as `mcgw.Scene.replace` takes them."""
    return mcgw.Scene.of(of_arguments({"surface": surface, **values}))

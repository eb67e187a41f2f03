"""Scenes by the names of their values, whichever part has them."""

import mcgw
from mcgw.scene import scene as parts


def scene_by(surface, **values):
    """A scene whose parts are made of values, as `mcgw.Scene.replace` takes them."""
    return mcgw.Scene(**parts.with_values({}, {"surface": surface, **values}))

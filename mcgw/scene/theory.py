"""The exact model of a scene."""

from analytic import Model
from mcgw.scene.fields import Fields

__all__ = ["model_of"]


def model_of(scene: Fields) -> Model:
    """Its modulus, height law, contact law, history, number of asperities, and interaction."""
    model = Model(
        scene.surface,
        grading=scene.modulus,
        heights=scene.heights,
        curvature=scene.curvature,
        law=scene.law,
        unload_from=scene.unload_from,
        film=scene.film,
        n_asperities=float(scene.n_asperities),
        count=scene.count,
    )
    if scene.interaction is None:
        return model
    from analytic import InteractingModel  # for those scenes alone

    return InteractingModel.of(model, scene.interaction)

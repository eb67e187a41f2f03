"""What a command says beside its answer, on standard error."""

import sys

from mcgw.scene.cautions import cautions
from mcgw.scene.scene import Scene

__all__ = ["tell_notes"]


def tell_notes(scene: Scene, *more: str) -> None:
    """Say where the model is strained, which units look wrong, and what else there is to say."""
    for line in (*cautions(scene), *more):
        print(f"mcgw: note: {line}", file=sys.stderr)

"""Contact laws of one asperity; all but Hertz's are imported on first use."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from analytic.laws.branch import Branch
from analytic.laws.film import Film, Layer, SpotConductance, crowding_factor
from analytic.laws.law import ContactLaw, Hertz, piece_of
from analytic.laws.regimes import Regimes
from analytic.laws.unloading import Unloading

if TYPE_CHECKING:
    from analytic.laws.adhesion import DerjaguinMullerToporov, JohnsonKendallRoberts
    from analytic.laws.custom import CustomLaw
    from analytic.laws.elastic import Coated, PowerLawGraded
    from analytic.laws.elastic_plastic_laws import (
        ChangEtsionBogy,
        JacksonGreen,
        KogutEtsion,
        ZhaoMaiettaChang,
    )

    by_name: dict[str, type[ContactLaw]]

__all__ = [
    "Branch", "ChangEtsionBogy", "Coated", "ContactLaw", "CustomLaw", "DerjaguinMullerToporov", "Film",
    "Hertz", "JacksonGreen", "JohnsonKendallRoberts", "KogutEtsion", "Layer",
    "PowerLawGraded",
    "Regimes", "SpotConductance", "Unloading",
    "ZhaoMaiettaChang", "by_name", "crowding_factor",
    "piece_of",
]  # fmt: skip

_HOMES = {
    "ChangEtsionBogy": "elastic_plastic_laws",
    "ZhaoMaiettaChang": "elastic_plastic_laws",
    "KogutEtsion": "elastic_plastic_laws",
    "JacksonGreen": "elastic_plastic_laws",
    "PowerLawGraded": "elastic",
    "Coated": "elastic",
    "DerjaguinMullerToporov": "adhesion",
    "JohnsonKendallRoberts": "adhesion",
    "CustomLaw": "custom",
}


def __getattr__(name: str) -> Any:
    """Return a law from its file; `by_name` has those of scene files."""
    if name == "by_name":
        return {law.name: law for law in (Hertz, *map(__getattr__, _HOMES)) if law.name != "custom"}
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)

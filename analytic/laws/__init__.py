"""Contact laws of one asperity; all but Hertz's are imported on first use."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from analytic.laws.branch import Branch
from analytic.laws.film import Film, Layer, SpotConductance, crowding_factor
from analytic.laws.law import ContactLaw, Hertz, piece_of
from analytic.laws.regimes import Regimes

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
    "Regimes", "SpotConductance",
    "ZhaoMaiettaChang", "by_name", "crowding_factor",
    "piece_of",
]  # fmt: skip

_FILES = ("law", "elastic_plastic_laws", "elastic", "adhesion", "custom")  # in which laws stand


def __getattr__(name: str) -> Any:
    """Return a law from its file; `by_name` has those of scene files."""
    found = {}
    for file in () if name.startswith("_") else _FILES:  # no more of them than it takes
        for law in vars(import_module(f"{__name__}.{file}")).values():
            own = isinstance(law, type) and issubclass(law, ContactLaw) and "name" in vars(law)
            if own and law is not ContactLaw:
                if name == law.__name__:
                    return law
                found[law.name] = law
    if name == "by_name":
        return {word: law for word, law in found.items() if word != "custom"}
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

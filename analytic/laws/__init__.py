"""Laws of contact of one asperity, one file each; they are loaded when they are asked for."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from analytic.laws.adhesion import DerjaguinMullerToporov, JohnsonKendallRoberts
    from analytic.laws.branch import Branch, LoadingBranch, UnloadingBranch, term_of
    from analytic.laws.chang_etsion_bogy import ChangEtsionBogy
    from analytic.laws.coated import Coated
    from analytic.laws.custom import CustomLaw
    from analytic.laws.film import Film, SpotConductance, crowding_factor, film_conductance, film_parameter
    from analytic.laws.hertz import Hertz
    from analytic.laws.jackson_green import JacksonGreen
    from analytic.laws.kogut_etsion import KogutEtsion
    from analytic.laws.law import ContactLaw
    from analytic.laws.power_law_graded import PowerLawGraded
    from analytic.laws.regimes import Regimes, merged_heights, regimes_of
    from analytic.laws.spot import of_spot, piece_of
    from analytic.laws.tangential import Tangential, half_spaces, masing
    from analytic.laws.unloading import Unloading
    from analytic.laws.ways import Ways
    from analytic.laws.zhao_maietta_chang import ZhaoMaiettaChang

    by_name: dict[str, type[ContactLaw]]

__all__ = [
    "Branch", "ChangEtsionBogy", "Coated", "ContactLaw", "CustomLaw", "DerjaguinMullerToporov", "Film",
    "Hertz", "JacksonGreen", "JohnsonKendallRoberts", "KogutEtsion", "LoadingBranch", "PowerLawGraded",
    "Regimes", "SpotConductance", "Tangential", "Unloading", "UnloadingBranch", "Ways",
    "ZhaoMaiettaChang", "by_name", "crowding_factor", "film_conductance", "film_parameter",
    "half_spaces", "masing", "merged_heights", "of_spot", "piece_of", "regimes_of", "term_of",
]  # fmt: skip

_FILES = {
    "adhesion": ("DerjaguinMullerToporov", "JohnsonKendallRoberts"),
    "branch": ("Branch", "LoadingBranch", "UnloadingBranch", "term_of"),
    "chang_etsion_bogy": ("ChangEtsionBogy",),
    "coated": ("Coated",),
    "custom": ("CustomLaw",),
    "film": ("Film", "SpotConductance", "crowding_factor", "film_conductance", "film_parameter"),
    "hertz": ("Hertz",),
    "jackson_green": ("JacksonGreen",),
    "kogut_etsion": ("KogutEtsion",),
    "law": ("ContactLaw",),
    "power_law_graded": ("PowerLawGraded",),
    "regimes": ("Regimes", "merged_heights", "regimes_of"),
    "spot": ("of_spot", "piece_of"),
    "tangential": ("Tangential", "half_spaces", "masing"),
    "unloading": ("Unloading",),
    "ways": ("Ways",),
    "zhao_maietta_chang": ("ZhaoMaiettaChang",),
}
_HOMES = {name: file for file, names in _FILES.items() for name in names}
_LAWS = (
    "Hertz",
    "ChangEtsionBogy",
    "ZhaoMaiettaChang",
    "KogutEtsion",
    "JacksonGreen",
    "PowerLawGraded",
    "Coated",
    "DerjaguinMullerToporov",
    "JohnsonKendallRoberts",
)


def __getattr__(name: str) -> Any:
    """A law, or what goes with laws, from its file; `by_name` has those of scene files."""
    if name == "by_name":
        return {law.name: law for law in map(__getattr__, _LAWS)}
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)

"""Contact laws of one asperity, and those of scene files by their names there."""

from analytic.laws import adhesion, elastic, elastic_plastic_laws, law
from analytic.laws.adhesion import DerjaguinMullerToporov, JohnsonKendallRoberts
from analytic.laws.branch import Branch, Regimes
from analytic.laws.custom import CustomLaw
from analytic.laws.elastic import Coated, PowerLawGraded
from analytic.laws.elastic_plastic_laws import ChangEtsionBogy, JacksonGreen, KogutEtsion, ZhaoMaiettaChang
from analytic.laws.film import Film, Layer, crowding_factor
from analytic.laws.law import ContactLaw, Hertz, piece_of

__all__ = [
    "Branch", "ChangEtsionBogy", "Coated", "ContactLaw", "CustomLaw", "DerjaguinMullerToporov", "Film",
    "Hertz", "JacksonGreen", "JohnsonKendallRoberts", "KogutEtsion", "Layer", "PowerLawGraded", "Regimes",
    "ZhaoMaiettaChang", "by_name", "crowding_factor", "piece_of",
]  # fmt: skip

_FILES = law, elastic_plastic_laws, elastic, adhesion  # in which each class with its own name is a law
by_name: dict[str, type[ContactLaw]] = {
    each.name: each
    for file in _FILES
    for each in vars(file).values()
    if getattr(each, "__module__", "") == file.__name__ and "name" in vars(each)
}

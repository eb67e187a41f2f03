"""Contact laws of one asperity, and those of scene files by their names there."""

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

_LAWS: tuple[type[ContactLaw], ...] = (
    Hertz, ChangEtsionBogy, ZhaoMaiettaChang, KogutEtsion, JacksonGreen, PowerLawGraded, Coated,
    DerjaguinMullerToporov, JohnsonKendallRoberts,
)  # fmt: skip
by_name = {law.name: law for law in _LAWS}

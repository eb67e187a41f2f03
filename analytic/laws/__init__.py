"""Laws of contact of one asperity, one file each."""

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

__all__ = [
    "Branch", "ChangEtsionBogy", "Coated", "ContactLaw", "CustomLaw", "DerjaguinMullerToporov", "Film",
    "Hertz", "JacksonGreen", "JohnsonKendallRoberts", "KogutEtsion", "LoadingBranch", "PowerLawGraded",
    "Regimes", "SpotConductance", "Tangential", "Unloading", "UnloadingBranch", "Ways",
    "ZhaoMaiettaChang", "by_name", "crowding_factor", "film_conductance", "film_parameter",
    "half_spaces", "masing", "merged_heights", "of_spot", "piece_of", "regimes_of", "term_of",
]  # fmt: skip

_LAWS: tuple[type[ContactLaw], ...] = (
    Hertz,
    ChangEtsionBogy,
    ZhaoMaiettaChang,
    KogutEtsion,
    JacksonGreen,
    PowerLawGraded,
    Coated,
    DerjaguinMullerToporov,
    JohnsonKendallRoberts,
)

by_name = {law.name: law for law in _LAWS}

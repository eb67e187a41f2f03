"""Laws of contact of one asperity, one file each."""

from analytic.laws.chang_etsion_bogy import ChangEtsionBogy
from analytic.laws.coated import Coated
from analytic.laws.film import crowding_factor, film_conductance, film_parameter
from analytic.laws.hertz import Hertz
from analytic.laws.jackson_green import JacksonGreen
from analytic.laws.kogut_etsion import KogutEtsion
from analytic.laws.law import ContactLaw
from analytic.laws.power_law_graded import PowerLawGraded
from analytic.laws.spot import of_spot, piece_of, term
from analytic.laws.unloading import Unloading
from analytic.laws.zhao_maietta_chang import ZhaoMaiettaChang

__all__ = [
    "ChangEtsionBogy", "Coated", "ContactLaw", "Hertz", "JacksonGreen", "KogutEtsion", "PowerLawGraded",
    "Unloading", "ZhaoMaiettaChang", "by_name", "crowding_factor", "film_conductance", "film_parameter",
    "of_spot", "piece_of", "term",
]  # fmt: skip

_LAWS: tuple[type[ContactLaw], ...] = (
    Hertz,
    ChangEtsionBogy,
    ZhaoMaiettaChang,
    KogutEtsion,
    JacksonGreen,
    PowerLawGraded,
    Coated,
)

by_name = {law.name: law for law in _LAWS}

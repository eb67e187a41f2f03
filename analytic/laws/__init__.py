"""Laws of contact of one asperity, one file each."""

from analytic.laws.chang_etsion_bogy import ChangEtsionBogy
from analytic.laws.hertz import Hertz
from analytic.laws.jackson_green import JacksonGreen
from analytic.laws.kogut_etsion import KogutEtsion
from analytic.laws.law import ContactLaw
from analytic.laws.spot import of_spot, piece_of, term
from analytic.laws.unloading import Unloading
from analytic.laws.zhao_maietta_chang import ZhaoMaiettaChang

__all__ = [
    "ChangEtsionBogy", "ContactLaw", "Hertz", "JacksonGreen", "KogutEtsion", "Unloading",
    "ZhaoMaiettaChang", "by_name", "of_spot", "piece_of", "term",
]  # fmt: skip

by_name: dict[str, type[ContactLaw]] = {
    law.name: law for law in (Hertz, ChangEtsionBogy, ZhaoMaiettaChang, KogutEtsion, JacksonGreen)
}

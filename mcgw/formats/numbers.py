"""Numbers as people write them: 1.234×10⁻⁵."""

import re

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_POWER, _MINUS = re.compile(r"(?<=\d)e([+-]\d+)\b"), re.compile(r"(?<![\w⁻])-(?=[\d.])")
_PRINTED = {"d/sigma": "d/σ", "gap/sigma": "gap/σ", "^2": "²", "+-": "±", " ... ": " … "}


def typeset(text: str) -> str:
    """Typeset plain text of a terminal: 1e-05, d/sigma, m^2, +-, ... and minus signs.

    Examples
    --------
    >>> typeset("d/sigma = -1.5 +- 2e-05 m^2")
    'd/σ = −1.5 ± 2×10⁻⁵ m²'
    """
    text = _POWER.sub(lambda found: f"×10{str(int(found[1])).translate(RAISED)}", text)
    for plain, printed in _PRINTED.items():
        text = text.replace(plain, printed)
    return _MINUS.sub("−", text)

"""Laws of moduli, heights, radii and contacts by name, with the numbers given for them."""

from dataclasses import MISSING, fields, is_dataclass
from typing import Any

from analytic import Custom, MeasuredHeights, MeasuredRadii, PiecewiseSeries, ScipyHeights
from analytic.laws import ContactLaw

_MOST = 4  # longest list that is printed whole


def law_text(law: Any) -> str:
    """Name of a law with the numbers given for it.

    >>> from analytic import Exponential
    >>> law_text(Exponential(2.0))
    'Exponential(gamma=2.0)'
    """
    name = type(law).__name__
    match law:
        case MeasuredHeights():
            return f"{len(law.heights)} measured ones, {'resampled' if law.resampled else 'as they are'}"
        case MeasuredRadii():
            return f"{len(law.ratios)} measured ones, each with its height"
        case Custom():
            return f"Custom({getattr(law.function, '__name__', type(law.function).__name__)})"
        case ScipyHeights():
            name, given = f"scipy.stats.{law.distribution.dist.name}", law.distribution.kwds
        case ContactLaw():
            given = law.given()
        case _ if is_dataclass(law) and not isinstance(law, PiecewiseSeries):
            given = {each.name: getattr(law, each.name) for each in fields(law) if each.default is MISSING}
        case _:
            return repr(law)
    return f"{name}({', '.join(f'{key}={_short(value)}' for key, value in given.items())})"


def _short(value: Any) -> str:
    """Return a long list by its ends, so that no number is cut."""
    if isinstance(value, tuple) and all(isinstance(x, float) for x in value):
        if len(value) > _MOST:
            return f"{len(value)} from {value[0]:.4g} to {value[-1]:.4g}"
        return f"({', '.join(f'{x:.6g}' for x in value)})"
    return repr(value)

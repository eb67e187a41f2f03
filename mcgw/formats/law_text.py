"""Laws of moduli, heights, radii and contacts by name, with the numbers given for them."""

from collections.abc import Mapping
from dataclasses import MISSING, fields, is_dataclass
from typing import Any

from analytic import Custom, MeasuredHeights, MeasuredRadii, PiecewiseSeries, ScipyHeights
from analytic.laws import ContactLaw

_MOST = 4  # longest list that is printed whole


def law_text(law: Any) -> str:
    """Name of a law with the numbers given for it.

    Examples
    --------
    >>> from analytic import Exponential
    >>> law_text(Exponential(2.0))
    'Exponential(gamma=2.0)'
    """
    match law:
        case ScipyHeights():
            return f"scipy.stats.{law.distribution.dist.name}({_listed(law.distribution.kwds)})"
        case PiecewiseSeries():
            return repr(law)
        case Custom():
            return f"Custom({getattr(law.function, '__name__', type(law.function).__name__)})"
        case MeasuredHeights():
            return f"{len(law.heights)} measured ones, {'resampled' if law.resampled else 'as they are'}"
        case MeasuredRadii():
            return f"{len(law.ratios)} measured ones, each with its height"
        case ContactLaw():
            return f"{type(law).__name__}({_listed(law.given())})"
    if not is_dataclass(law):
        return repr(law)
    given = {field.name: getattr(law, field.name) for field in fields(law) if field.default is MISSING}
    return f"{type(law).__name__}({_listed(given)})"


def _listed(given: Mapping[str, Any]) -> str:
    return ", ".join(f"{key}={_short(value)}" for key, value in given.items())


def _short(value: Any) -> str:
    """Return a long list by its ends, so that no number is cut."""
    if isinstance(value, tuple) and all(isinstance(x, float) for x in value):
        if len(value) > _MOST:
            return f"{len(value)} from {value[0]:.4g} to {value[-1]:.4g}"
        return f"({', '.join(f'{x:.6g}' for x in value)})"
    return repr(value)

"""Whether a law of contact is Hertz's, for which there are closed forms."""

from analytic.laws.law import ContactLaw

__all__ = ["is_hertz"]

_FORMULAS = ("limits", "load", "radius", "stiffness", "slope", "unloading")


def is_hertz(law: ContactLaw) -> bool:
    """Whether it has none of its own formulas."""
    return all(getattr(type(law), name, None) is getattr(ContactLaw, name, None) for name in _FORMULAS)

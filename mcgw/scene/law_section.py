"""The contact law of a scene: its name and its constants, keys of the table [contact]."""

from dataclasses import MISSING, fields
from typing import Any

from analytic.laws import ContactLaw, Hertz
from mcgw.scene.section import SceneError, Section, nearest

__all__ = ["contact_law", "law_table", "read_law"]

_UNITS = {"hardness": "Pa", "yield_strength": "Pa", "c0": "m", "thickness": "m", "work": "J/m^2"}
_CUSTOM = "custom"
_WORDS = {"bridge": ("hermite",)}


def contact_law(section: Section) -> ContactLaw:
    """Read the law and its constants; mistakes are noted in the section, and give Hertz's."""
    given = section.take("law")
    if isinstance(given, ContactLaw):
        return given
    if isinstance(given, dict):  # of Python
        return _of_table(given, section.problems)
    if given is None or given == Hertz.name:
        return Hertz()
    if given == _CUSTOM:
        from mcgw.scene.custom_law_section import custom_law

        return custom_law(section) or Hertz()
    from analytic.laws import by_name

    if callable(given):
        section.fail("law", given, "a law of your own is mcgw.CustomLaw(load=..., area=..., ...)")
        return Hertz()
    if not isinstance(given, str) or given not in by_name:
        section.fail("law", given, f"{nearest(given, tuple(by_name))}choose one of {', '.join(by_name)}")
        section.known(*section.table)  # whose constants they are is not known
        return Hertz()
    known, before = fields(by_name[given]), len(section.problems)  # type: ignore[arg-type]
    section.known(*(field.name for field in known))
    constants = {field.name: _constant(section, field.name) for field in known if field.name in section}
    for field in known:
        if field.default is MISSING and field.name not in section:
            section.problems.append(f'contact.{field.name}: missing; law = "{given}" needs it')
    if len(section.problems) > before:
        return Hertz()
    try:
        return by_name[given](**constants)
    except ValueError as error:
        section.problems.append(f"contact.{error}")
        return Hertz()


def _of_table(given: dict[str, Any], problems: list[str]) -> ContactLaw:
    """A law by the keys that it has in a file."""
    inner = Section("contact", given, problems)
    if not isinstance(given.get("law"), str):
        from analytic.laws import by_name

        inner.fail("law", given.get("law"), f"choose one of {', '.join(by_name)}")
        return Hertz()
    law = contact_law(inner)
    inner.finish()
    return law


def read_law(given: ContactLaw | dict[str, Any]) -> ContactLaw:
    """A law, or one by the keys that it has in a file.

    Raises
    ------
    SceneError
        With one line for each mistake.
    """
    section = Section("contact", {"law": given}, [])
    law = contact_law(section)
    if section.problems:
        raise SceneError(section.problems)
    return law


def _constant(section: Section, key: str) -> float | str:
    if key in _WORDS:
        return section.choice(key, "", _WORDS[key])
    return section.number(key, unit=_UNITS.get(key, ""), positive=key != "poisson")


def law_table(law: ContactLaw) -> dict[str, Any]:
    """The keys that give the law back."""
    if law.name == _CUSTOM:
        from mcgw.scene.custom_law_section import custom_table

        return custom_table(law)
    return {"law": law.name, **law.given()}

"""What can be tabulated: one thing against another."""

from dataclasses import dataclass

__all__ = ["KINDS", "Kind"]


@dataclass(frozen=True)
class Kind:
    """A table.

    Parameters
    ----------
    name : str
        As it is asked for: what is tabulated, against what.
    quantity : {"pressure", "conductance", "stiffness"}
        What is tabulated.
    against : {"gap", "pressure"}
        Its argument.
    """

    name: str
    quantity: str
    against: str

    @property
    def needs(self) -> tuple[str, ...]:
        """Quantities of an ensemble that it is made of."""
        return ("load",) if self.quantity == "pressure" else ("load", self.dataset)

    @property
    def dataset(self) -> str:
        """The name of its quantity in an ensemble."""
        return {"conductance": "conductance_si"}.get(self.quantity, self.quantity)


_ALL = (("pressure", "gap"), ("conductance", "pressure"), ("conductance", "gap"), ("stiffness", "pressure"))
KINDS = {f"{what}-{against}": Kind(f"{what}-{against}", what, against) for what, against in _ALL}

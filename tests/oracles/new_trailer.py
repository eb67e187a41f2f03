"""A trailer for a file that a test has changed: what a stranger could do as well."""

from mcgw.store import structure
from mcgw.store.disk import trailer_of


def trailer_again(path):
    """Append a trailer that fits what stands there; HDF5 has taken the old one away."""
    try:
        head = structure.describe(str(path))["head"]
    except (structure.RefusedError, OSError, RuntimeError, ValueError, KeyError, TypeError):
        head = ""
    body = path.read_bytes()
    path.write_bytes(body + trailer_of(body, head=head))

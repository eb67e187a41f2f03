"""Tables of contact for finite-element programs: what is tabulated, and in which form."""

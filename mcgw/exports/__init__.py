"""Contact tables for finite-element programs."""

"""Sweeps: many scenes on the same surfaces."""

"""Sweeps: many scenes as one question."""

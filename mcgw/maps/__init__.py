"""Surfaces as maps: synthetic ones out, measured ones in."""

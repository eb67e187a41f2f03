"""Summits at their places, each pressed down by all others."""

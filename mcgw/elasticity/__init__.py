"""Surfaces that are elastic as a whole: summits at their places, boundary elements, means by levels."""

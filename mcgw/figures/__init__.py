"""Figures: numbers first, then drawn alike, each meaning in one colour."""

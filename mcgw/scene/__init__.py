"""Scenes, their TOML files, and their cautions."""

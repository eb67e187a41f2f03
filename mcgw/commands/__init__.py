"""The commands, one per file: help, arguments, action."""

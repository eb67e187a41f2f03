"""``python -m mcgw``."""

from mcgw.cli import process

process()

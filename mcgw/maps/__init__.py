"""Height maps: synthetic ones are written, measured ones are fitted."""

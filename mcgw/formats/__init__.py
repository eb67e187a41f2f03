"""Files as such: written whole or not at all. Nothing here knows of contacts."""

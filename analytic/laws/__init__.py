"""Laws of contact of one asperity, one file each."""

"""`tt_pixels`: pixels of all types in a Tiny Tapeout analog project, read out through its pins."""

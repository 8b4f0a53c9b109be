"""The sensor's die: the analog blocks and the laid-out chip as macros, placed, routed and checked."""

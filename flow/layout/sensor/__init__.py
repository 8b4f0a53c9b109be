"""The whole sensor: analog blocks and the laid-out chip as hard macros on one die, placed, joined and checked."""

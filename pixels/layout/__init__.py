"""The pixel drawn: cells, tile and array in a process's masks, and the circuit that they are."""

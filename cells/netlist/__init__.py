"""SPICE netlists of cells: read, checked, and understood as functions, storage and timing arcs."""

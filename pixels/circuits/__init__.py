"""Circuits of the analog half: specifications, sizes and netlists in transistors of a process."""

"""Cells sized and buffered for the wires that a placement implies, in the empty places of its rows."""

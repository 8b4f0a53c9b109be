"""The name of a cell's twin with high-threshold transistors: of the cell's size, with its pins."""

TWIN = "_hvt"  # after the cell's name

"""The characterizer: one cell at one corner, measured."""

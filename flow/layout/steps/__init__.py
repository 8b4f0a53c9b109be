"""The steps of a layout, each a class in a file of its own."""

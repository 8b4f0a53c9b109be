"""The optics of a pixel: gratings of metal, solved rigorously."""

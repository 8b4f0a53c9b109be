"""Golden models: parameters, scenes, optics and the bit-true digital chip. Imports nothing of rtl or flow."""

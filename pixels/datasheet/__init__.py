"""The analog circuits measured in ngspice: corners, mismatch, noise, linearity; their datasheet."""

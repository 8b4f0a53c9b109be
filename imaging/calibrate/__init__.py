"""Calibration of the simulated chip on a simulated bench: `talbot calibrate`."""

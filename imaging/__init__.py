"""From a scene to pictures: frames, sequences, light fields, polarization, depth, calibration, trade-offs."""

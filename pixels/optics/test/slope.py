import numpy as np


def phase_slope(response):
    """Angular frequency: slope of the phase of the two differences, weighted by their power."""
    curves = response.unpolarized.mean(0)
    signal = (curves[0] - curves[2]) + 1j * (curves[1] - curves[3])
    order = np.argsort(response.angles)
    phase = np.unwrap(np.angle(signal[order]))
    return abs(float(np.polyfit(response.angles[order], phase, 1, w=np.abs(signal[order]))[0]))

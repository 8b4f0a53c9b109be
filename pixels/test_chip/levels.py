"""Levels of the drawn test chip at tt and 25 degrees, as `read.py` simulates them; its test compares them."""

import numpy as np

# V at the pads under reset, for these reset levels; a diode is 5 mV below
DIODE_V = np.linspace(1.0, 2.2, 13)
PAD_V = np.array(
    [1.3984, 1.4418, 1.4966, 1.5597, 1.6264, 1.6945, 1.7633, 1.8324, 1.9018, 1.9714, 2.0411, 2.1108, 2.1804]
)
# A diode at 2.0 V: its capacitance, and the rise of that as it falls, 1/V, so that it collects FARAD (x + BEND x**2) C
FARAD, BEND = 11.0e-15, 0.073
FEEDTHROUGH = 0.107  # V that a diode falls as its reset ends

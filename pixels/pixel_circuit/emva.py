"""A table in the manner of EMVA 1288 (release 4, linear) from simulated exposures through the sensor's own models.

The photon transfer of flat pictures: two at each level for the temporal noise, sixteen in the dark and at half the full
well for what pixels differ by. Values are those before the converter.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.capture.expose import Exposure, expose
from talbot.models.parameters import ELEMENTARY_CHARGE, AmpTiming, ElectricalParameters

SIDE = 128  # pixels of a picture's side
LEVELS = 40
BRIGHTEST = 1.2  # of the full well
LINEAR = 0.7  # of the saturation: up to it noise gives the gain
STACK = 16
Floats = npt.NDArray[np.floating]


@dataclass(frozen=True)
class Emva:
    """The table. gain: of the model, values an electron. In electrons: dark_noise, saturation, threshold, dsnu.

    responsivity: see `emva`. prnu: relative.
    photon_transfer: (mean, temporal variance, photons' electrons) of every level. linearity: greatest deviation from
    the line between 5 and 95 % of the saturation, of it.
    """

    gain: float
    responsivity: float
    dark_noise: float
    saturation: float
    threshold: float
    snr_max_db: float
    dynamic_range_db: float
    dsnu: float
    prnu: float
    linearity: float
    photon_transfer: list[list[float]]


def emva(electrical: ElectricalParameters, seed: int = 1) -> Emva:
    """Measure flat pictures of a sensor of these pixels. responsivity: electrons for one that the light makes."""
    mean_of = np.linspace(0, BRIGHTEST, LEVELS) * electrical.full_well
    rows = []
    for k, electrons in enumerate(mean_of):
        first, second = (_picture(electrical, float(electrons), seed, 2 * k + n) for n in (0, 1))
        difference = first - second
        rows.append([np.mean((first + second) / 2), (np.mean(difference**2) - np.mean(difference) ** 2) / 2, electrons])
    value, variance, electrons = np.array(rows, float).T
    value, noise = value - value[0], variance - variance[0]
    full = int(np.argmax(variance))
    part = value <= LINEAR * value[full]
    gain = float(value[part] @ noise[part] / (value[part] @ value[part]))
    part[0] = False
    slope = float(value[part] @ electrons[part] / (electrons[part] @ electrons[part]))
    dark = float(np.sqrt(variance[0])) / gain
    saturation = float(value[full] / gain)
    inside = (electrons >= 0.05 * electrons[full]) & (electrons <= 0.95 * electrons[full])
    line = np.polyval(np.polyfit(electrons[inside], value[inside], 1), electrons[inside])
    threshold = (dark + 0.5) * gain / slope  # of the light's electrons
    offset, middle = (
        _spatial(electrical, share * electrical.full_well, seed, 1000 + 100 * k) for k, share in enumerate((0.0, 0.5))
    )
    return Emva(
        gain,
        slope / gain,
        dark,
        saturation,
        threshold,
        10 * float(np.log10(saturation)),
        20 * float(np.log10(saturation / threshold * slope / gain)),
        float(np.sqrt(offset[1])) / gain,
        float(np.sqrt(max(middle[1] - offset[1], 0.0)) / (middle[0] - offset[0])),
        float(np.abs(value[inside] - line).max() / value[full]),
        [[float(a), float(b), float(c)] for a, b, c in zip(value, variance, electrons, strict=True)],
    )


def _picture(electrical: ElectricalParameters, electrons: float, seed: int, number: int) -> Floats:
    """Return the diodes' values of a flat picture with a mean of ``electrons`` photoelectrons in each."""
    timing = AmpTiming()
    exposure = Exposure(electrical, timing, seed=seed, number=number)
    unit = electrical.white_current * sum(exposure.intervals) / ELEMENTARY_CHARGE
    return expose(np.full((2, SIDE, SIDE), electrons / unit), exposure)


def _spatial(electrical: ElectricalParameters, electrons: float, seed: int, number: int) -> tuple[float, float]:
    """Mean of a stack of pictures, and the variance of its pixels without what is left of their temporal noise."""
    stack = np.array([_picture(electrical, electrons, seed, number + k) for k in range(STACK)])
    left = float(stack.var(axis=0, ddof=1).mean()) / STACK
    return float(stack.mean()), float(stack.mean(axis=0).var(ddof=1)) - left

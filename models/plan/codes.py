"""Conversion of photocurrents to codes."""

from talbot.models.digital.exposure import integration_cycles
from talbot.models.parameters import ELEMENTARY_CHARGE, AmpTiming, SensorParameters


def codes_per_unit(sensor: SensorParameters, timing: AmpTiming) -> float:
    """Codes of the difference per relative photocurrent, before gain mismatch and full wells.

    sensor: the sensor. timing: integration times, common-mode resets, lead of the reset pointer. Returns codes per
    unit.
    """
    e = sensor.electrical
    seconds = sum(integration_cycles(timing)) / sensor.chip.f_clk
    return e.white_current * seconds / ELEMENTARY_CHARGE / e.lsb_electrons * e.difference_gain

"""From photocurrents to codes."""

from talbot.models.parameters import ELEMENTARY_CHARGE, AmpTiming, SensorParameters


def codes_per_unit(sensor: SensorParameters, timing: AmpTiming) -> float:
    """Codes of the difference per relative photocurrent, before gain mismatch and full wells.

    Parameters
    ----------
    sensor : SensorParameters
        The sensor.
    timing : AmpTiming
        Integration time and common-mode resets.

    Returns
    -------
    float
        Codes per unit.
    """
    e = sensor.electrical
    seconds = timing.t_int / sensor.chip.f_clk * (timing.n_cm + 1)
    return e.white_current * seconds / ELEMENTARY_CHARGE / e.lsb_electrons * e.difference_gain

"""The integration time of a row in cycles; this formula is nowhere else.

A slot is one run of AmpCtrl. A row is reset in a slot and read `exposure` slots later; it integrates from the first
cycle of the slot's first integration to the end of that in the slot of its read. Common-mode resets are of the slot of
its read: the column's amplifier serves the row that is read, no other.
"""

from talbot.models.digital.amp_ctrl import row_cycles
from talbot.models.parameters import AmpTiming


def slot_cycles(timing: AmpTiming, four_tap: bool = False) -> int:
    """Cycles from one `amp_start` to the next, with overlap, where no row waits for the converters.

    timing: durations of the phases. four_tap: four sub-frames instead of one. Returns cycles of a slot.
    """
    return row_cycles(timing, four_tap) + 2


def windows(timing: AmpTiming, rows: int) -> tuple[list[int], int]:
    """When the rows that are read integrate.

    timing: of the frame as it exposes. rows: rows that are read. Returns cycle in which each row's first integration
    begins, after the first row's. Returns cycles from there to the end of its last one, common-mode resets included.
    """
    slot = slot_cycles(timing)
    pauses = timing.n_cm * (timing.t_cm + 2 * timing.t_guard)
    return [row * slot for row in range(rows)], sum(integration_cycles(timing)) + pauses


def integration_cycles(timing: AmpTiming) -> tuple[int, ...]:
    """Cycles of each integration of a row: a common-mode reset is between any two.

    timing: of the frame as it exposes (`FrameParameters.exposing`). Returns n_cm + 1 integrations: exposure slots and
    t_int, then t_int each.
    """
    return (timing.exposure * slot_cycles(timing) + timing.t_int, *(timing.t_int,) * timing.n_cm)

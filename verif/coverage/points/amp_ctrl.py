"""Cover points of AmpCtrl."""

import numpy as np

from talbot.verif.coverage.ports import Mask, Points, Recorded, Values

DURATIONS = "t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard"


def _start_in_idle(p: Recorded) -> Mask:
    return (p.start == 1) & (p.busy == 0) & (p.reset == 0)


def _zeros(p: Recorded) -> Values:
    return np.sum([getattr(p, name) == 0 for name in DURATIONS], axis=0)


def _row_started(p: Recorded) -> Mask:
    return _start_in_idle(p) & (_zeros(p) == 0)


def _read_waits_for_the_hold(p: Recorded) -> Mask:
    """Return the cycles in which the guard before `read` is longer than t_guard."""
    last = (p.integrate == 1) | (p.start == 1)
    return (p.busy == 1) & (p.hold_free == 0) & (p.shutter == 0) & (p.read == 0) & (p.since(last) > 12)


def _reset_in_a_guard(p: Recorded) -> Mask:
    phases = p.integrate + p.read + p.cm_reset + p.pixel_reset
    return (p.reset == 1) & (p.busy == 1) & (phases == 0) & ~p.fresh


POINTS: Points = {
    "row_started": _row_started,
    "start_while_busy": lambda p: (p.start == 1) & (p.busy == 1) & (p.reset == 0),
    "start_in_the_cycle_of_done": lambda p: (p.start == 1) & (p.done == 1) & (p.reset == 0),
    "configuration_changes_while_busy": lambda p: (
        (p.busy == 1) & (p.t_int != p.was(p.t_int)) & (p.n_cm != p.was(p.n_cm))
    ),
    "four_taps_done": lambda p: (p.done == 1) & (p.was(p.tap) == 3),
    "one_tap_done": lambda p: (p.done == 1) & (p.was(p.tap) == 0),
    "no_common_mode_reset": lambda p: _row_started(p) & (p.n_cm == 0),
    "one_common_mode_reset": lambda p: _row_started(p) & (p.n_cm == 1),
    "several_common_mode_resets": lambda p: _row_started(p) & (p.n_cm > 1),
    "shortest_durations": lambda p: _row_started(p) & (sum(getattr(p, name) for name in DURATIONS) == 6),
    "a_duration_of_16_bits": lambda p: _row_started(p) & (p.t_int >= 1 << 15),
    "refused_without_reset_time": lambda p: _start_in_idle(p) & (_zeros(p) == 1) & (p.t_reset == 0),
    "refused_without_integration": lambda p: _start_in_idle(p) & (_zeros(p) == 1) & (p.t_int == 0),
    "refused_without_common_mode_time": lambda p: _start_in_idle(p) & (_zeros(p) == 1) & (p.t_cm == 0),
    "refused_without_settling": lambda p: _start_in_idle(p) & (_zeros(p) == 1) & (p.t_settle == 0),
    "refused_without_reading": lambda p: _start_in_idle(p) & (_zeros(p) == 1) & (p.t_read == 0),
    "refused_without_guard": lambda p: _start_in_idle(p) & (_zeros(p) == 1) & (p.t_guard == 0),
    "error_cleared_by_the_next_start": lambda p: (p.cfg_err == 0) & (p.was(p.cfg_err) == 1) & (p.busy == 1),
    "read_waits_for_the_hold": _read_waits_for_the_hold,
    "hold_not_free_elsewhere": lambda p: (p.hold_free == 0) & (p.integrate == 1),
    "slot_without_reset": lambda p: (p.done == 1) & (p.slot_resets == 0) & (p.was(p.busy) == 1),
    "reset_without_read": lambda p: (p.done == 1) & (p.since(p.pixel_reset == 1) < p.since(p.read == 1)),
    "exposes_while_another_row_integrates": lambda p: (p.expose == 1) & (p.integrate == 1),
    "exposes_in_a_slot_without_read": lambda p: (p.expose == 1) & (p.integrate == 0),
    "both_samples": lambda p: (p.sample == 1) & (p.ref_ctl == 0) & (p.read == 1),
    "reset_in_integration": lambda p: (p.reset == 1) & (p.integrate == 1) & ~p.fresh,
    "reset_in_read": lambda p: (p.reset == 1) & (p.read == 1) & ~p.fresh,
    "reset_in_a_guard": _reset_in_a_guard,
}

"""Cover points of AmpCtrl."""

DURATIONS = "t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard"


def _start_in_idle(p):
    return (p.start == 1) & (p.busy == 0) & (p.reset == 0)


def _zeros(p):
    return sum((getattr(p, name) == 0).astype(int) for name in DURATIONS)


def row_started(p):
    return _start_in_idle(p) & (_zeros(p) == 0)


def start_while_busy(p):
    return (p.start == 1) & (p.busy == 1) & (p.reset == 0)


def start_in_the_cycle_of_done(p):
    return (p.start == 1) & (p.done == 1) & (p.reset == 0)


def configuration_changes_while_busy(p):
    return (p.busy == 1) & (p.t_int != p.was(p.t_int)) & (p.n_cm != p.was(p.n_cm))


def four_taps_done(p):
    return (p.done == 1) & (p.was(p.tap) == 3)


def one_tap_done(p):
    return (p.done == 1) & (p.was(p.tap) == 0)


def no_common_mode_reset(p):
    return row_started(p) & (p.n_cm == 0)


def one_common_mode_reset(p):
    return row_started(p) & (p.n_cm == 1)


def several_common_mode_resets(p):
    return row_started(p) & (p.n_cm > 1)


def shortest_durations(p):
    return row_started(p) & (sum(getattr(p, name) for name in DURATIONS) == 6)


def a_duration_of_16_bits(p):
    return row_started(p) & (p.t_int == 0xFFFF)


def refused_without_reset_time(p):
    return _start_in_idle(p) & (_zeros(p) == 1) & (p.t_reset == 0)


def refused_without_integration(p):
    return _start_in_idle(p) & (_zeros(p) == 1) & (p.t_int == 0)


def refused_without_common_mode_time(p):
    return _start_in_idle(p) & (_zeros(p) == 1) & (p.t_cm == 0)


def refused_without_settling(p):
    return _start_in_idle(p) & (_zeros(p) == 1) & (p.t_settle == 0)


def refused_without_reading(p):
    return _start_in_idle(p) & (_zeros(p) == 1) & (p.t_read == 0)


def refused_without_guard(p):
    return _start_in_idle(p) & (_zeros(p) == 1) & (p.t_guard == 0)


def error_forgotten_by_the_next_start(p):
    return (p.cfg_err == 0) & (p.was(p.cfg_err) == 1) & (p.busy == 1)


def read_waits_for_the_hold(p):
    """The guard before `read` is longer than t_guard."""
    last = (p.integrate == 1) | (p.start == 1)
    return (p.busy == 1) & (p.hold_free == 0) & (p.shutter == 0) & (p.read == 0) & (p.since(last) > 12)


def hold_not_free_elsewhere(p):
    return (p.hold_free == 0) & (p.integrate == 1)


def both_samples(p):
    return (p.sample == 1) & (p.ref_ctl == 0) & (p.read == 1)


def reset_in_integration(p):
    return (p.reset == 1) & (p.integrate == 1) & ~p.fresh


def reset_in_read(p):
    return (p.reset == 1) & (p.read == 1) & ~p.fresh


def reset_in_a_guard(p):
    phases = p.integrate + p.read + p.cm_reset + p.pixel_reset
    return (p.reset == 1) & (p.busy == 1) & (phases == 0) & ~p.fresh

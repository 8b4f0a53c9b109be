"""Cover points of ReadoutSeq."""

from talbot.rtl.messages import END, FRAME, ROW, SAMPLE
from talbot.verif.coverage.ports import Mask, Points, Recorded


def _started(p: Recorded) -> Mask:
    return (p.amp_start == 1) & (p.was(p.start) == 1) & (p.was(p.busy) == 0)


def _refused(p: Recorded) -> Mask:
    return (p.was(p.start) == 1) & (p.was(p.busy) == 0) & (p.was(p.reset) == 0) & (p.busy == 0) & (p.cfg_err == 1)


def _last_tile(p: Recorded) -> tuple[int, int]:
    """Return (row, column) of the array's last tile."""
    rows, cols, _, _, tile_rows, tile_cols = p.arguments
    return (rows - 1) // tile_rows, (cols - 1) // tile_cols


def _taken(p: Recorded) -> Mask:
    return (p.step__val == 1) & (p.step__rdy == 1) & (p.reset == 0)


def _whole_array(p: Recorded) -> Mask:
    row, col = _last_tile(p)
    return _started(p) & (p.row0 == 0) & (p.row1 == row) & (p.col0 == 0) & (p.col1 == col)


def _selected_types_absent_in_window(p: Recorded) -> Mask:
    row, col = _last_tile(p)
    return _refused(p) & (p.mask != 0) & (p.row0 <= p.row1) & (p.row1 <= row) & (p.col0 <= p.col1) & (p.col1 <= col)


def _steps_back_to_back(p: Recorded) -> Mask:
    step = _taken(p) & (p.step__kind == SAMPLE)
    return step & (p.was(step) == 1)


POINTS: Points = {
    "edge_frame": lambda p: _started(p) & (p.mode == 0),
    "image_frame": lambda p: _started(p) & (p.mode == 1),
    "raw_frame": lambda p: _started(p) & (p.mode == 2),
    "tof_frame": lambda p: _started(p) & (p.mode == 3) & (p.four_tap == 1),
    "every_tile": lambda p: _started(p) & (p.decimation == 0),
    "every_second_tile": lambda p: _started(p) & (p.decimation == 1) & (p.row1 > p.row0) & (p.col1 > p.col0),
    "every_fourth_tile": lambda p: _started(p) & (p.decimation == 2) & (p.col1 > p.col0),
    "every_eighth_tile": lambda p: _started(p) & (p.decimation == 3) & (p.col1 > p.col0),
    "overlap_on": lambda p: _started(p) & (p.overlap == 1),
    "overlap_off": lambda p: _started(p) & (p.overlap == 0),
    "whole_array": _whole_array,
    "inner_window": lambda p: _started(p) & (p.row0 > 0) & (p.col0 > 0),
    "one_tile": lambda p: _started(p) & (p.row0 == p.row1) & (p.col0 == p.col1),
    "all_types": lambda p: _started(p) & (p.mask == 0xFFFFFF),
    "one_type": lambda p: _started(p) & (p.mask & (p.mask - 1) == 0),
    "some_types": lambda p: _started(p) & (p.mask & (p.mask - 1) != 0) & (p.mask != 0xFFFFFF),
    # The next row that is read is not the next one that exists.
    "rows_left_out": lambda p: (p.amp_start == 1) & (p.was(p.busy) == 1) & (p.amp_row > p.was(p.amp_row) + 1),
    "last_row_reached": lambda p: (p.amp_start == 1) & (p.amp_row == p.arguments[0] - 1),
    "no_lead": lambda p: _started(p) & (p.exposure == 0),
    "lead_of_one_row": lambda p: _started(p) & (p.exposure == 1) & (p.mode != 3),
    "lead_ignored_in_tof": lambda p: _started(p) & (p.exposure > 0) & (p.mode == 3),
    "slot_resets_only": lambda p: (p.amp_start == 1) & (p.slot_resets == 1) & (p.slot_reads == 0),
    "slot_resets_one_row_and_reads_another": lambda p: (
        (p.amp_start == 1) & (p.slot_resets == 1) & (p.slot_reads == 1) & (p.slot_opens == 1)
    ),
    "slot_reads_only": lambda p: (p.amp_start == 1) & (p.slot_resets == 0) & (p.slot_reads == 1),
    "slot_does_nothing": lambda p: (p.amp_start == 1) & (p.slot_resets == 0) & (p.slot_reads == 0),
    "lead_over_masked_rows": lambda p: (
        (p.amp_start == 1) & (p.slot_opens == 1) & (p.was(p.busy) == 1) & (p.reset_row > p.was(p.reset_row) + 1)
    ),
    "lead_without_overlap": lambda p: _started(p) & (p.exposure > 0) & (p.overlap == 0) & (p.mode != 3),
    "window_upside_down": lambda p: _refused(p) & (p.row0 > p.row1),
    "window_right_to_left": lambda p: _refused(p) & (p.col0 > p.col1),
    "rows_outside": lambda p: _refused(p) & (p.row0 <= p.row1) & (p.row1 > _last_tile(p)[0]),
    "columns_outside": lambda p: _refused(p) & (p.col0 <= p.col1) & (p.col1 > _last_tile(p)[1]),
    "nothing_selected": lambda p: _refused(p) & (p.mask == 0),
    "selected_types_absent_in_window": _selected_types_absent_in_window,
    "good_start_after_a_refused_one": lambda p: _started(p) & (p.was(p.cfg_err) == 1),
    "start_while_busy": lambda p: (p.start == 1) & (p.busy == 1) & (p.reset == 0),
    "start_in_the_cycle_of_done": lambda p: (p.start == 1) & (p.done == 1),
    "frame_message_waits": lambda p: (p.step__val == 1) & (p.step__rdy == 0) & (p.step__kind == FRAME),
    "row_message_waits": lambda p: (p.step__val == 1) & (p.step__rdy == 0) & (p.step__kind == ROW),
    "step_waits": lambda p: (p.step__val == 1) & (p.step__rdy == 0) & (p.step__kind == SAMPLE),
    "end_waits": lambda p: (p.step__val == 1) & (p.step__rdy == 0) & (p.step__kind == END),
    "steps_back_to_back": _steps_back_to_back,
    "bank_busy_after_the_last_step": lambda p: (
        (p.hold_free == 0) & (p.bank_idle == 0) & (p.step__val == 0) & (p.busy == 1)
    ),
    # The next row is in the amplifiers while this one converts, and is done before the row is converted.
    "amplifiers_ready_first": lambda p: (p.amp_done == 1) & (p.was(p.hold_free) == 1),
    "row_converts_while_next_integrates": lambda p: (p.amp_start == 1) & (p.hold_free == 0),
    "amplifiers_refuse_immediately": lambda p: (p.amp_err == 1) & (p.was(p.amp_start) == 1) & (p.busy == 1),
    "amplifiers_refuse_later": lambda p: (
        (p.amp_err == 1) & (p.busy == 1) & (p.since(p.amp_start == 1) > 1) & (p.cycles > 3) & (p.step__val == 0)
    ),
    "amplifiers_refuse_while_a_step_waits": lambda p: (
        (p.amp_err == 1) & (p.busy == 1) & (p.step__val == 1) & (p.step__rdy == 0) & (p.since(p.amp_start == 1) > 0)
    ),
    # In the cycle of amp_start it may be of the start before.
    "old_error_of_the_amplifiers": lambda p: (p.amp_err == 1) & (p.amp_start == 1),
    "error_and_done_at_once": lambda p: (p.amp_err == 1) & (p.amp_done == 1) & (p.busy == 1),
    "reset_in_a_frame": lambda p: (p.reset == 1) & (p.busy == 1) & ~p.fresh,
    "reset_while_a_step_waits": lambda p: (p.reset == 1) & (p.step__val == 1) & ~p.fresh,
}

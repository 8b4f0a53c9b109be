"""Cover points of ReadoutSeq."""

from rtl.messages import END, FRAME, ROW, SAMPLE


def _started(p):
    return (p.amp_start == 1) & (p.was(p.start) == 1) & (p.was(p.busy) == 0)


def _refused(p):
    return (p.was(p.start) == 1) & (p.was(p.busy) == 0) & (p.was(p.reset) == 0) & (p.busy == 0) & (p.cfg_err == 1)


def _last_tile(p):
    """(row, column) of the array's last tile."""
    rows, cols, _, _, tile_rows, tile_cols = p.arguments
    return (rows - 1) // tile_rows, (cols - 1) // tile_cols


def _taken(p):
    return (p.step__val == 1) & (p.step__rdy == 1) & (p.reset == 0)


def edge_frame(p):
    return _started(p) & (p.mode == 0)


def image_frame(p):
    return _started(p) & (p.mode == 1)


def raw_frame(p):
    return _started(p) & (p.mode == 2)


def tof_frame(p):
    return _started(p) & (p.mode == 3) & (p.four_tap == 1)


def every_tile(p):
    return _started(p) & (p.decimation == 0)


def every_second_tile(p):
    return _started(p) & (p.decimation == 1) & (p.row1 > p.row0) & (p.col1 > p.col0)


def every_fourth_tile(p):
    return _started(p) & (p.decimation == 2) & (p.col1 > p.col0)


def every_eighth_tile(p):
    return _started(p) & (p.decimation == 3) & (p.col1 > p.col0)


def overlap_on(p):
    return _started(p) & (p.overlap == 1)


def overlap_off(p):
    return _started(p) & (p.overlap == 0)


def whole_array(p):
    row, col = _last_tile(p)
    return _started(p) & (p.row0 == 0) & (p.row1 == row) & (p.col0 == 0) & (p.col1 == col)


def inner_window(p):
    return _started(p) & (p.row0 > 0) & (p.col0 > 0)


def one_tile(p):
    return _started(p) & (p.row0 == p.row1) & (p.col0 == p.col1)


def all_types(p):
    return _started(p) & (p.mask == 0xFFFFFF)


def one_type(p):
    return _started(p) & (p.mask & (p.mask - 1) == 0)


def some_types(p):
    return _started(p) & (p.mask & (p.mask - 1) != 0) & (p.mask != 0xFFFFFF)


def rows_left_out(p):
    """The next row that is read is not the next one that exists."""
    return (p.amp_start == 1) & (p.was(p.busy) == 1) & (p.amp_row > p.was(p.amp_row) + 1)


def last_row_reached(p):
    return (p.amp_start == 1) & (p.amp_row == p.arguments[0] - 1)


def window_upside_down(p):
    return _refused(p) & (p.row0 > p.row1)


def window_right_to_left(p):
    return _refused(p) & (p.col0 > p.col1)


def rows_outside(p):
    return _refused(p) & (p.row0 <= p.row1) & (p.row1 > _last_tile(p)[0])


def columns_outside(p):
    return _refused(p) & (p.col0 <= p.col1) & (p.col1 > _last_tile(p)[1])


def nothing_selected(p):
    return _refused(p) & (p.mask == 0)


def selected_types_do_not_exist_there(p):
    row, col = _last_tile(p)
    return _refused(p) & (p.mask != 0) & (p.row0 <= p.row1) & (p.row1 <= row) & (p.col0 <= p.col1) & (p.col1 <= col)


def good_start_behind_a_refused_one(p):
    return _started(p) & (p.was(p.cfg_err) == 1)


def start_while_busy(p):
    return (p.start == 1) & (p.busy == 1) & (p.reset == 0)


def start_in_the_cycle_of_done(p):
    return (p.start == 1) & (p.done == 1)


def frame_message_waits(p):
    return (p.step__val == 1) & (p.step__rdy == 0) & (p.step__kind == FRAME)


def row_message_waits(p):
    return (p.step__val == 1) & (p.step__rdy == 0) & (p.step__kind == ROW)


def step_waits(p):
    return (p.step__val == 1) & (p.step__rdy == 0) & (p.step__kind == SAMPLE)


def end_waits(p):
    return (p.step__val == 1) & (p.step__rdy == 0) & (p.step__kind == END)


def steps_back_to_back(p):
    step = _taken(p) & (p.step__kind == SAMPLE)
    return step & (p.was(step) == 1)


def bank_busy_behind_the_last_step(p):
    return (p.hold_free == 0) & (p.bank_idle == 0) & (p.step__val == 0) & (p.busy == 1)


def amplifiers_ready_first(p):
    """The next row is in the amplifiers while this one converts, and is done before the row is converted."""
    return (p.amp_done == 1) & (p.was(p.hold_free) == 1)


def row_converts_while_next_integrates(p):
    return (p.amp_start == 1) & (p.hold_free == 0)


def amplifiers_refuse_at_once(p):
    return (p.amp_err == 1) & (p.was(p.amp_start) == 1) & (p.busy == 1)


def amplifiers_refuse_later(p):
    return (p.amp_err == 1) & (p.busy == 1) & (p.since(p.amp_start == 1) > 1) & (p.cycles > 3) & (p.step__val == 0)


def amplifiers_refuse_while_a_step_waits(p):
    return (p.amp_err == 1) & (p.busy == 1) & (p.step__val == 1) & (p.step__rdy == 0) & (p.since(p.amp_start == 1) > 0)


def old_error_of_the_amplifiers(p):
    """In the cycle of amp_start it may be of the start before."""
    return (p.amp_err == 1) & (p.amp_start == 1)


def error_and_done_at_once(p):
    return (p.amp_err == 1) & (p.amp_done == 1) & (p.busy == 1)


def reset_in_a_frame(p):
    return (p.reset == 1) & (p.busy == 1) & ~p.fresh


def reset_while_a_step_waits(p):
    return (p.reset == 1) & (p.step__val == 1) & ~p.fresh

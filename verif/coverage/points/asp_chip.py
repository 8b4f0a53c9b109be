"""Cover points of AspChip."""

from models.parameters.registers import register_map

from ..spi import transfers, where

CHIP = register_map()


def _configuration(p, field):
    """Cycles in which a frame starts while ``field`` holds something other than 0, as the host wrote it."""
    place = CHIP[field]
    mask = (1 << place.width) - 1 << place.shift
    value, chosen = 0, []
    for transfer in transfers(p):
        for address, byte in transfer.bytes_at() if transfer.writes else ():
            if address == place.byte:
                value = byte & mask
            if address == CHIP["start"].byte and byte & 1 and value:
                chosen.append(transfer)
    return where(p, chosen)


def _sent(p):
    return (p.link_val == 1) & (p.link_rdy == 1) & (p.reset == 0)


def _frame_ends(p):
    return (p.busy == 0) & (p.was(p.frame_sync, 2) == 1) & (p.reset == 0)


def edge_frame(p):
    return _frame_ends(p) & (p.mode == 0)


def image_frame(p):
    return _frame_ends(p) & (p.mode == 1)


def raw_frame(p):
    return _frame_ends(p) & (p.mode == 2)


def tof_frame(p):
    return _frame_ends(p) & (p.mode == 3)


def phase_asked_for(p):
    return _configuration(p, "phase") & (p.mode == 3)


def phase_asked_for_in_another_mode(p):
    return _configuration(p, "phase") & (p.mode != 3)


def pattern_on(p):
    return _configuration(p, "test_pattern")


def analog_comparators(p):
    """An answer of the front end, with something to sample."""
    return (p.comparator != 0) & (p.busy == 1)


def overlap_asked_for(p):
    return _configuration(p, "overlap")


def decimation_asked_for(p):
    return _configuration(p, "decimation")


def bytes_of_loop_back(p):
    return _sent(p) & (p.frame_sync == 0)


def byte_waits(p):
    return (p.link_val == 1) & (p.link_rdy == 0) & (p.frame_sync == 1)


def byte_waits_while_busy_ends(p):
    """Only the link is left."""
    return byte_waits(p) & (p.since(p.hold == 1) > 200)


def a_byte_a_cycle(p):
    return _sent(p) & (p.was(_sent(p)) == 1)


def all_four_taps(p):
    return (p.sample == 1) & (p.tap == 3)


def negative_balance(p):
    return (p.hold == 1) & (p.balance >> 9 == 1)


def positive_balance(p):
    return (p.hold == 1) & (p.balance >> 9 == 0) & (p.balance > 0)


def hold_of_all_lanes(p):
    return (p.hold == 1) & (p.en == (1 << p.arguments[2]) - 1)


def hold_of_some_lanes(p):
    return (p.hold == 1) & (p.en != (1 << p.arguments[2]) - 1)


def last_pixel(p):
    """The array's last row and column."""
    rows, cols, lanes = p.arguments[:3]
    col = (cols - 1) // 6
    return (p.hold == 1) & (p.row == rows - 1) & (p.k == (cols - 1) % 6) & (p.group == col // lanes)


def second_diode(p):
    return (p.hold == 1) & (p.mode == 2) & (p.sub == 1)


def start_refused(p):
    """A start that the chip does not become busy from."""
    starts = where(p, [t for t in transfers(p) if t.writes and (CHIP["start"].byte, 1) in t.bytes_at()])
    return starts & (p.busy == 0) & (p.since(p.busy == 1) != 0)


def status_read_back(p):
    first = CHIP["busy"].byte
    return where(p, [t for t in transfers(p) if t.data and not t.writes and first in dict(t.bytes_at())]) & (
        p.since(p.miso == 1) < 200
    )


def frame_behind_a_frame(p):
    ends = _frame_ends(p)
    return (p.frame_sync == 1) & (p.was(p.frame_sync) == 0) & (p.since(ends) > 0)


def reset_between_frames(p):
    return (p.reset == 1) & (p.busy == 0) & (p.since(p.frame_sync == 1) > 0) & ~p.fresh

"""Cover points of AspChip."""

from talbot.models.parameters.registers import register_map
from talbot.verif.coverage.ports import Mask, Points, Recorded
from talbot.verif.coverage.spi import transfers, where

CHIP = register_map()


def _configuration(p: Recorded, field: str) -> Mask:
    """Return the cycles in which a frame starts while ``field`` is not 0, as the host wrote it."""
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


def _sent(p: Recorded) -> Mask:
    return (p.link_val == 1) & (p.link_rdy == 1) & (p.reset == 0)


def _frame_ends(p: Recorded) -> Mask:
    return (p.busy == 0) & (p.was(p.frame_sync, 2) == 1) & (p.reset == 0)


def _byte_waits(p: Recorded) -> Mask:
    return (p.link_val == 1) & (p.link_rdy == 0) & (p.frame_sync == 1)


def _last_pixel(p: Recorded) -> Mask:
    """Return the array's last row and column."""
    rows, cols, lanes = p.arguments[:3]
    col = (cols - 1) // 6
    return (p.hold == 1) & (p.row == rows - 1) & (p.k == (cols - 1) % 6) & (p.group == col // lanes)


def _start_refused(p: Recorded) -> Mask:
    """Return the cycles of a start after which the chip is not busy."""
    starts = where(p, [t for t in transfers(p) if t.writes and (CHIP["start"].byte, 1) in t.bytes_at()])
    return starts & (p.busy == 0) & (p.since(p.busy == 1) != 0)


def _status_read_back(p: Recorded) -> Mask:
    first = CHIP["busy"].byte
    return where(p, [t for t in transfers(p) if t.data and not t.writes and first in dict(t.bytes_at())]) & (
        p.since(p.miso == 1) < 200
    )


def _frame_after_a_frame(p: Recorded) -> Mask:
    ends = _frame_ends(p)
    return (p.frame_sync == 1) & (p.was(p.frame_sync) == 0) & (p.since(ends) > 0)


POINTS: Points = {
    "edge_frame": lambda p: _frame_ends(p) & (p.mode == 0),
    "ternary_frame": lambda p: _configuration(p, "mode") & (p.mode == 0),
    "image_frame": lambda p: _frame_ends(p) & (p.mode == 1),
    "raw_frame": lambda p: _frame_ends(p) & (p.mode == 2),
    "tof_frame": lambda p: _frame_ends(p) & (p.mode == 3),
    "phase_requested": lambda p: _configuration(p, "phase") & (p.mode == 3),
    "phase_requested_in_another_mode": lambda p: _configuration(p, "phase") & (p.mode != 3),
    "pattern_on": lambda p: _configuration(p, "test_pattern"),
    # An answer of the front end, with something to sample.
    "analog_comparators": lambda p: (p.comparator != 0) & (p.busy == 1),
    "overlap_requested": lambda p: _configuration(p, "overlap"),
    "decimation_requested": lambda p: _configuration(p, "decimation"),
    "bytes_of_loop_back": lambda p: _sent(p) & (p.frame_sync == 0),
    "byte_waits": _byte_waits,
    # Only the link is left.
    "byte_waits_while_busy_ends": lambda p: _byte_waits(p) & (p.since(p.hold == 1) > 200),
    "a_byte_a_cycle": lambda p: _sent(p) & (p.was(_sent(p)) == 1),
    "all_four_taps": lambda p: (p.sample == 1) & (p.tap == 3),
    "negative_balance": lambda p: (p.hold == 1) & (p.balance >> 9 == 1),
    "positive_balance": lambda p: (p.hold == 1) & (p.balance >> 9 == 0) & (p.balance > 0),
    "hold_of_all_lanes": lambda p: (p.hold == 1) & (p.en == (1 << p.arguments[2]) - 1),
    "hold_of_some_lanes": lambda p: (p.hold == 1) & (p.en != (1 << p.arguments[2]) - 1),
    "last_pixel": _last_pixel,
    "second_diode": lambda p: (p.hold == 1) & (p.mode == 2) & (p.sub == 1),
    "start_refused": _start_refused,
    "status_read_back": _status_read_back,
    "frame_after_a_frame": _frame_after_a_frame,
    "reset_between_frames": lambda p: (p.reset == 1) & (p.busy == 0) & (p.since(p.frame_sync == 1) > 0) & ~p.fresh,
}

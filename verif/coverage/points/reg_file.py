"""Cover points of RegFile."""

from collections.abc import Callable

from talbot.models.parameters.registers import register_map
from talbot.verif.coverage.ports import Mask, Points, Recorded
from talbot.verif.coverage.spi import transfers, where

CHIP = register_map()


WRITABLE = CHIP.writable()


LOOP, START, STATUS = (CHIP[name].byte for name in ("loop_back", "start", "busy"))


def _writes_to(p: Recorded, selects: Callable[[int, int], int]) -> Mask:
    """Transfers that write a byte to an address for which ``wanted(address, byte)``."""
    return where(p, [t for t in transfers(p) if t.writes and any(selects(*pair) for pair in t.bytes_at())])


def _reads_from(p: Recorded, selects: Callable[[int], int]) -> Mask:
    return where(p, [t for t in transfers(p) if t.data and not t.writes and any(selects(a) for a, _ in t.bytes_at())])


def _every_configuration_byte_written(p: Recorded) -> Mask:
    """In one recording."""
    written = {address for t in transfers(p) if t.writes for address, _ in t.bytes_at()}
    return where(p, transfers(p)[-1:]) & (written >= set(WRITABLE))


def _every_configuration_byte_read(p: Recorded) -> Mask:
    read = {address for t in transfers(p) if t.data and not t.writes for address, _ in t.bytes_at()}
    return where(p, transfers(p)[-1:]) & (read >= set(WRITABLE))


def _counter_written(p: Recorded) -> Mask:
    first = CHIP.counters[0].byte
    return _writes_to(p, lambda address, _: first <= address < first + 24)


def _sticky_bit_cleared(p: Recorded) -> Mask:
    return _writes_to(p, lambda address, byte: address == STATUS and byte)


def _counter_changes_within_a_read(p: Recorded) -> Mask:
    """... but the bytes that were taken are read."""
    counter = CHIP.counters[0].byte
    ends = [t for t in transfers(p) if t.data and not t.writes and t.data[0] & 0x7F == counter]
    return where(p, ends) & (p.cycles > 0)


POINTS: Points = {
    "every_configuration_byte_written": _every_configuration_byte_written,
    "every_configuration_byte_read": _every_configuration_byte_read,
    "id_read": lambda p: _reads_from(p, lambda address: address == CHIP["id"].byte),
    "unmapped_written": lambda p: _writes_to(
        p, lambda address, _: address not in WRITABLE and address > CHIP.counters[-1].byte + 7 and address != LOOP
    ),
    "unmapped_read": lambda p: _reads_from(p, lambda address: address > CHIP.counters[-1].byte + 7 and address != LOOP),
    "counter_written": _counter_written,
    "several_bytes_in_a_transfer": lambda p: where(p, [t for t in transfers(p) if t.writes and len(t.data) > 3]),
    "address_stays_at_the_last": lambda p: where(
        p, [t for t in transfers(p) if t.writes and (t.data[0] & 0x7F) + len(t.data) - 2 > 127]
    ),
    "cut_in_the_command": lambda p: where(p, [t for t in transfers(p) if not t.data and t.bits and not t.cut]),
    "cut_in_a_byte": lambda p: where(p, [t for t in transfers(p) if t.writes and t.bits and not t.cut]),
    "cut_by_a_reset": lambda p: where(p, [t for t in transfers(p) if t.cut and t.bits]),
    # sclk moves with csn low since the reset.
    "clock_goes_on_after_a_reset": lambda p: (
        (p.sclk != p.was(p.sclk))
        & (p.csn == 0)
        & (p.since((p.reset == 1) & (p.csn == 0)) > 0)
        & (p.since((p.reset == 1) & (p.csn == 0)) < p.since(p.csn == 1))
    ),
    "fastest_clock": lambda p: where(p, [t for t in transfers(p) if t.half == 4 and t.data]),
    "odd_clock": lambda p: where(p, [t for t in transfers(p) if t.half > 5 and t.half % 2 and t.data]),
    "start_strobe": lambda p: (p.start == 1) & (p.was(p.start) == 0),
    "abort_strobe": lambda p: (p.abort_ == 1) & (p.was(p.abort_) == 0),
    "start_refused": lambda p: (
        _writes_to(p, lambda address, byte: address == START and byte & 1) & (p.status__busy == 1)
    ),
    "start_without_its_bit": lambda p: _writes_to(p, lambda address, byte: address == START and not byte & 1),
    "write_refused": lambda p: _writes_to(p, lambda address, _: address in WRITABLE) & (p.status__busy == 1),
    "read_while_busy": lambda p: _reads_from(p, lambda address: address == STATUS) & (p.status__busy == 1),
    "sticky_bit_cleared": _sticky_bit_cleared,
    "sticky_bit_cleared_while_busy": lambda p: _sticky_bit_cleared(p) & (p.status__busy == 1),
    "done_reported": lambda p: (p.status__done == 1) & (p.reset == 0),
    "errors_reported": lambda p: (p.status__cfg_err == 1) & (p.reset == 0) | (p.status__amp_err == 1) & (p.reset == 0),
    # The start strobe comes a cycle after the one that clears the sticky bits.
    "event_in_the_cycle_of_a_start": lambda p: (p.start == 1) & (p.was(p.status__done) == 1),
    "counter_changes_within_a_read": _counter_changes_within_a_read,
    "counter_with_its_highest_bit": lambda p: (p.conversions_made >> 62 != 0).astype(bool) & (p.reset == 0),
    "loop_byte_leaves": lambda p: (p.loop__val == 1) & (p.loop__rdy == 1),
    "loop_byte_waits": lambda p: (p.loop__val == 1) & (p.loop__rdy == 0),
    "loop_byte_refused": lambda p: (
        _writes_to(p, lambda address, _: address == LOOP) & (p.loop__val == 1) & (p.since(p.loop__rdy == 1) > 100)
    ),
    "reset_of_a_written_configuration": lambda p: (
        (p.reset == 1) & (p.cfg__threshold != p.was(p.cfg__threshold, 2)) & ~p.fresh
        | ((p.reset == 0) & (p.was(p.reset) == 1) & (p.cfg != p.was(p.cfg)).astype(bool) & (p.was(p.fresh) == 0))
    ),
}

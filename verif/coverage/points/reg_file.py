"""Cover points of RegFile."""

from models.parameters.registers import register_map

from ..spi import transfers, where

CHIP = register_map()
WRITABLE = CHIP.writable()
LOOP, START, STATUS = (CHIP[name].byte for name in ("loop_back", "start", "busy"))


def _writes_to(p, wanted):
    """Transfers that write a byte to an address for which ``wanted(address, byte)``."""
    return where(p, [t for t in transfers(p) if t.writes and any(wanted(*pair) for pair in t.bytes_at())])


def _reads_from(p, wanted):
    return where(p, [t for t in transfers(p) if t.data and not t.writes and any(wanted(a) for a, _ in t.bytes_at())])


def every_configuration_byte_written(p):
    """In one recording."""
    written = {address for t in transfers(p) if t.writes for address, _ in t.bytes_at()}
    return where(p, transfers(p)[-1:]) & (written >= set(WRITABLE))


def every_configuration_byte_read(p):
    read = {address for t in transfers(p) if t.data and not t.writes for address, _ in t.bytes_at()}
    return where(p, transfers(p)[-1:]) & (read >= set(WRITABLE))


def id_read(p):
    return _reads_from(p, lambda address: address == CHIP["id"].byte)


def unmapped_written(p):
    return _writes_to(
        p, lambda address, _: address not in WRITABLE and address > CHIP.counters[-1].byte + 7 and address != LOOP
    )


def unmapped_read(p):
    return _reads_from(p, lambda address: address > CHIP.counters[-1].byte + 7 and address != LOOP)


def counter_written(p):
    first = CHIP.counters[0].byte
    return _writes_to(p, lambda address, _: first <= address < first + 24)


def several_bytes_in_a_transfer(p):
    return where(p, [t for t in transfers(p) if t.writes and len(t.data) > 3])


def address_stays_at_the_last(p):
    return where(p, [t for t in transfers(p) if t.writes and (t.data[0] & 0x7F) + len(t.data) - 2 > 127])


def cut_in_the_command(p):
    return where(p, [t for t in transfers(p) if not t.data and t.bits and not t.cut])


def cut_in_a_byte(p):
    return where(p, [t for t in transfers(p) if t.writes and t.bits and not t.cut])


def cut_by_a_reset(p):
    return where(p, [t for t in transfers(p) if t.cut and t.bits])


def clock_goes_on_behind_a_reset(p):
    """sclk moves with csn low since the reset."""
    return (
        (p.sclk != p.was(p.sclk))
        & (p.csn == 0)
        & (p.since((p.reset == 1) & (p.csn == 0)) > 0)
        & (p.since((p.reset == 1) & (p.csn == 0)) < p.since(p.csn == 1))
    )


def fastest_clock(p):
    return where(p, [t for t in transfers(p) if t.half == 4 and t.data])


def odd_clock(p):
    return where(p, [t for t in transfers(p) if t.half > 5 and t.half % 2 and t.data])


def start_strobe(p):
    return (p.start == 1) & (p.was(p.start) == 0)


def start_refused(p):
    return _writes_to(p, lambda address, byte: address == START and byte & 1) & (p.status__busy == 1)


def start_without_its_bit(p):
    return _writes_to(p, lambda address, byte: address == START and not byte & 1)


def write_refused(p):
    return _writes_to(p, lambda address, _: address in WRITABLE) & (p.status__busy == 1)


def read_while_busy(p):
    return _reads_from(p, lambda address: address == STATUS) & (p.status__busy == 1)


def sticky_bit_cleared(p):
    return _writes_to(p, lambda address, byte: address == STATUS and byte)


def sticky_bit_cleared_while_busy(p):
    return sticky_bit_cleared(p) & (p.status__busy == 1)


def done_told(p):
    return (p.status__done == 1) & (p.reset == 0)


def errors_told(p):
    return (p.status__cfg_err == 1) & (p.reset == 0) | (p.status__amp_err == 1) & (p.reset == 0)


def event_in_the_cycle_of_a_start(p):
    """The start strobe is a cycle behind the one that clears the sticky bits."""
    return (p.start == 1) & (p.was(p.status__done) == 1)


def counter_changes_within_a_read(p):
    """... but the bytes that were taken are read."""
    counter = CHIP.counters[0].byte
    ends = [t for t in transfers(p) if t.data and not t.writes and t.data[0] & 0x7F == counter]
    return where(p, ends) & (p.cycles > 0)


def counter_with_its_highest_bit(p):
    return (p.conversions_made >> 62 != 0).astype(bool) & (p.reset == 0)


def loop_byte_leaves(p):
    return (p.loop__val == 1) & (p.loop__rdy == 1)


def loop_byte_waits(p):
    return (p.loop__val == 1) & (p.loop__rdy == 0)


def loop_byte_refused(p):
    return _writes_to(p, lambda address, _: address == LOOP) & (p.loop__val == 1) & (p.since(p.loop__rdy == 1) > 100)


def reset_of_a_written_configuration(p):
    return (p.reset == 1) & (p.cfg__threshold != p.was(p.cfg__threshold, 2)) & ~p.fresh | (
        (p.reset == 0) & (p.was(p.reset) == 1) & (p.cfg != p.was(p.cfg)).astype(bool) & (p.was(p.fresh) == 0)
    )

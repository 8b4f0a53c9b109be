"""Random inputs for the host functions and the golden model of the register file.

Each target raises Broken, or what the tried function raises, where a result is wrong.
"""

import numpy as np

from talbot.models.digital.host import decode_status, frame_writes, read_transfer, status_transfers, write_transfers
from talbot.models.digital.registers import ADDRESS_MAX, RegisterBank
from talbot.models.parameters import MODES, AmpTiming, FrameParameters, ParameterError, Window
from talbot.models.parameters.registers import register_map, trim_range
from talbot.verif.fuzz.checks import demand

WRITE = 0x80


def integer(rng: np.random.Generator) -> int:
    """Return a small integer, an edge of a field, or one outside of all fields."""
    edges = (-1, 0, 1, 127, 128, 254, 255, 256, 1023, 65535, 65536, 2**24 - 1, 2**24, 2**64)
    return edges[rng.integers(len(edges))] if rng.random() < 0.5 else int(rng.integers(0, 256))


def status_replies(rng: np.random.Generator) -> None:
    """Decode replies of any lengths: a status, or a ParameterError exactly where a length is wrong."""
    lengths = [len(t) for t in status_transfers()]
    if rng.random() < 0.5:
        lengths = rng.integers(0, 40, rng.integers(0, 4)).tolist()
    right = lengths == [len(t) for t in status_transfers()]
    replies = [rng.bytes(n) for n in lengths]
    try:
        status = decode_status(replies)
    except ParameterError:
        demand(not right, "replies of the right lengths are refused")
        return
    demand(right, f"replies of {lengths} bytes are read")
    counter = register_map().counters[0]
    demand(status[counter.name] == int.from_bytes(replies[1][1:9], "little"), "another counter")


def transfers_of_writes(rng: np.random.Generator) -> None:
    """Build transfers of pairs (address, byte): exactly these, or a ParameterError where one is no byte."""
    start, count = int(rng.integers(0, 120)), int(rng.integers(0, 40))
    writes = [((start + i) % 128, int(rng.integers(256))) for i in range(count)]
    if rng.random() < 0.3:
        writes.append((integer(rng), integer(rng)))
    right = all(0 <= a <= ADDRESS_MAX and 0 <= b <= 255 for a, b in writes)
    try:
        transfers = write_transfers(writes)
    except ParameterError:
        demand(not right, "bytes at addresses are refused")
        return
    demand(right, f"writes = {writes}: transfers with no byte or address")
    sent = [((t[0] & 0x7F) + i, byte) for t in transfers for i, byte in enumerate(t[1:])]
    demand(all(t[0] & WRITE for t in transfers) and sent == writes, f"writes = {writes}: {transfers}")


def a_read(rng: np.random.Generator) -> None:
    """Build a read of any address and count: the transfer, or a ParameterError."""
    address, count = integer(rng), integer(rng)
    right = 0 <= address <= 127 and 1 <= count <= 254
    try:
        transfer = read_transfer(address, count)
    except ParameterError:
        demand(not right, f"a read of {count} bytes at {address} is refused")
        return
    demand(right and len(transfer) == count + 1 and transfer[0] == address, f"read of {count} at {address}")


def a_frame(rng: np.random.Generator) -> None:
    """Write any configuration: a ParameterError, or registers that hold it."""
    low, high = trim_range()
    try:
        frame = FrameParameters(
            Window(*(integer(rng) for _ in range(4))) if rng.random() < 0.3 else Window(0, 5, 1, 7),
            MODES[rng.integers(len(MODES))],
            integer(rng),
            integer(rng) % 128,
            int(rng.integers(4)),
            rng.random() < 0.2,
            integer(rng) % 256,
            rng.random() < 0.5,
            rng.random() < 0.5,
            integer(rng) % 65536,
            AmpTiming(*(1 + integer(rng) % 65536 for _ in range(6)), n_cm=integer(rng) % 256),
        )
        trims = rng.integers(low - 1, high + 2, rng.integers(0, 26)).tolist()
        writes = frame_writes(frame, trims)
    except ParameterError as error:
        demand("\n" not in str(error), f"the error is no line: {error!r}")
        return
    bank = RegisterBank()
    for transfer in write_transfers(writes):
        for i, byte in enumerate(transfer[1:]):
            bank.write((transfer[0] & 0x7F) + i, byte, False, False)
    held = {
        **vars(frame.window),
        **vars(frame.timing),
        "mode": MODES.index(frame.mode),
        **{
            name: int(getattr(frame, name))
            for name in (
                "mask",
                "threshold",
                "decimation",
                "phase",
                "noise_floor",
                "overlap",
                "test_pattern",
                "frame_number",
            )
        },
        **{f.key: trim % (1 << f.width) for f, trim in zip(register_map().trims, trims, strict=False)},
    }
    for name, value in held.items():
        demand(bank.value(name) == value, f"{name} = {bank.value(name)} in the registers, not {value}")


def a_bank(rng: np.random.Generator) -> None:
    """Write any bytes to any address: only writable bits of the configuration change, none while a frame runs."""
    bank, chip = RegisterBank(), register_map()
    fixed = {a: byte for a, byte in bank.bytes.items() if a not in bank.writable}
    for address, byte, busy, full in zip(
        rng.integers(0, 128, 12).tolist(),
        rng.integers(0, 256, 12).tolist(),
        *(rng.random((2, 12)) < 0.3).tolist(),
        strict=True,
    ):
        before = dict(bank.bytes)
        bank.write(address, byte, busy, full)
        start, _, loop = bank.take()
        demand(not (start and busy), "a start while busy")
        demand(loop is None or not full and loop == byte, "a loop-back byte without room")
        moved = {a for a in before if bank.bytes[a] != before[a]}
        demand(moved <= {address} & set(bank.writable) and not (busy and moved), f"address {address}: {moved} moved")
        demand(all(bank.bytes[a] & ~mask & 0xFF == 0 for a, mask in bank.writable.items()), "bits of no field")
        read = bank.read(address, busy, [1, 2, 3])
        demand(0 <= read <= 255, f"read {read}")
        if moved:
            demand(read == byte & bank.writable[address], f"address {address}: {byte} written, {read} read")
    demand(all(bank.bytes[a] == byte for a, byte in fixed.items()), "a read-only byte moved")
    demand(bank.read(chip["id"].byte, False, [0, 0, 0]) == chip["id"].reset, "another id")


TARGETS = {
    "status replies": status_replies,
    "writes": transfers_of_writes,
    "reads": a_read,
    "frames": a_frame,
    "register bank": a_bank,
}

"""What a host sends and gets over SPI: command bytes, a frame's configuration, the status."""

from models.parameters.checks import ParameterError, check_int
from models.parameters.frame import MODES
from models.parameters.registers import register_map, trim_range

WRITE = 0x80  # bit 7 of the command byte; the rest is the address
TRANSFER_MAX = 255  # bytes of one transfer


def frame_writes(frame, trims=None):
    """Configuration writes of one frame: list of (address, byte), ascending, every configuration byte once.

    frame: FrameParameters. trims: 24 integers by pixel type (fewer leave the rest 0), or None for zeros.
    Raises ParameterError.
    """
    trims = [] if trims is None else [int(t) for t in trims]
    chip = register_map()
    if len(trims) > len(chip.trims):
        raise ParameterError(f"trims = {len(trims)} values: must be at most {len(chip.trims)}")
    low, high = trim_range()
    for i, trim in enumerate(trims):
        check_int(f"trim {i}", trim, low, high)
    window, timing = frame.window, frame.timing
    values = {
        "mode": MODES.index(frame.mode),
        **{
            name: int(getattr(frame, name))
            for name in (
                "overlap",
                "phase",
                "test_pattern",
                "decimation",
                "threshold",
                "noise_floor",
                "mask",
                "frame_number",
            )
        },
        **{name: getattr(window, name) for name in ("row0", "row1", "col0", "col1")},
        **{
            name: getattr(timing, name)
            for name in ("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard", "n_cm")
        },
        **{f"trim[{i}].trim": trim for i, trim in enumerate(trims)},
    }
    return sorted(chip.image(chip.configuration, values).items())


def write_transfers(writes):
    """SPI transfers for (address, byte) pairs: list of bytes, each a command and data at ascending addresses.

    Raises ParameterError for an address beyond 127 or a byte beyond 255.
    """
    out, last = [], None
    for address, byte in writes:
        check_int("address", address, 0, 127)
        check_int(f"byte for address {address}", byte, 0, 255)
        if last is not None and address == last + 1 and len(out[-1]) < TRANSFER_MAX:
            out[-1].append(byte)
        else:
            out.append(bytearray((WRITE | address, byte)))
        last = address
    return [bytes(t) for t in out]


def command(name):
    """SPI transfer that writes 1 to one single-bit field, such as 'start' or a sticky status bit."""
    field = register_map()[name]
    return bytes((WRITE | field.byte, 1 << field.shift))


def read_transfer(address, count):
    """SPI transfer that reads ``count`` bytes, 1..254, from ``address`` on; they come back from the second byte on."""
    check_int("address", address, 0, 127)
    check_int("count", count, 1, TRANSFER_MAX - 1)
    return bytes((address, *(0 for _ in range(count))))


def status_transfers():
    """Transfers that read the status and the counters; their replies go to `decode_status`."""
    chip = register_map()
    first, last = chip.counters[0], chip.counters[-1]
    return [read_transfer(chip["busy"].address, 1), read_transfer(first.byte, last.byte + last.bytes - first.byte)]


def decode_status(replies):
    """The replies of `status_transfers`, command bytes' echoes included: dict of name -> int or bool.

    Raises ParameterError when a reply has the wrong length.
    """
    chip, transfers = register_map(), status_transfers()
    lengths, wanted = [len(r) for r in replies], [len(t) for t in transfers]
    if lengths != wanted:
        raise ParameterError(f"status replies = {lengths} bytes: must be {wanted}")
    status, counters = (bytes(r[1:]) for r in replies)
    base = chip.counters[0].byte
    return {
        **{f.name: bool(status[0] >> f.shift & 1) for f in chip.fields if f.register == "status"},
        **{f.name: int.from_bytes(counters[f.byte - base : f.byte - base + 8], "little") for f in chip.counters},
    }

"""The host's side of the SPI port: command bytes, a frame's configuration, the status."""

from collections.abc import Iterable, Sequence

from talbot.models.digital.amp_ctrl import TAPS
from talbot.models.digital.scan import Scan
from talbot.models.parameters import MODES, FrameParameters, ParameterError, SensorParameters, check_int
from talbot.models.parameters.registers import register_map, trim_range

WRITE = 0x80  # bit 7 of the command byte; the rest is the address
TRANSFER_MAX = 255  # bytes of one transfer


def frame_values(frame: FrameParameters, trims: Iterable[int] | None = None) -> dict[str, int]:
    """Configuration of one frame, field by field.

    frame: configuration. trims: up to 24 register values by pixel type; 0 for the rest. Returns dict of str to int: key
    of the field to value. Raises ParameterError for too many trims or a trim out of range.
    """
    trims = [] if trims is None else [int(t) for t in trims]
    chip = register_map()
    if len(trims) > len(chip.trims):
        raise ParameterError(f"trims = {len(trims)} values: must be at most {len(chip.trims)}")
    low, high = trim_range()
    for i, trim in enumerate(trims):
        check_int(f"trim {i}", trim, low, high)
    named = vars(frame) | vars(frame.window) | vars(frame.timing) | {"mode": MODES.index(frame.mode)}
    return {f.key: int(named[f.name]) for f in chip.configuration if f.name in named} | {
        f"trim[{i}].trim": trim for i, trim in enumerate(trims)
    }


def frame_writes(frame: FrameParameters, trims: Iterable[int] | None = None) -> list[tuple[int, int]]:
    """Configuration writes of one frame.

    frame: configuration. trims: as in `frame_values`. Returns (address, byte), ascending, every configuration byte
    once. Raises ParameterError as in `frame_values`.
    """
    chip = register_map()
    return sorted(chip.image(chip.configuration, frame_values(frame, trims)).items())


def write_transfers(writes: Iterable[tuple[int, int]]) -> list[bytes]:
    """SPI transfers of some writes.

    writes: (address, byte), 0..127 and 0..255. Returns list of bytes: each a command byte and data at ascending
    addresses. Raises ParameterError for an address or a byte out of range.
    """
    out: list[bytearray] = []
    last = None
    for address, byte in writes:
        check_int("address", address, 0, 127)
        check_int(f"byte for address {address}", byte, 0, 255)
        if last is not None and address == last + 1 and len(out[-1]) < TRANSFER_MAX:
            out[-1].append(byte)
        else:
            out.append(bytearray((WRITE | address, byte)))
        last = address
    return [bytes(t) for t in out]


def command(name: str) -> bytes:
    """SPI transfer that writes 1 to a single-bit field.

    name: key of the field: 'start' or a sticky status bit. Returns command byte and data.
    """
    field = register_map()[name]
    return bytes((WRITE | field.byte, 1 << field.shift))


def read_transfer(address: int, count: int) -> bytes:
    """SPI transfer that reads consecutive bytes; the reply holds them from its second byte on.

    address: first address, 0..127. count: bytes, 1..254. Returns command byte and zeros. Raises ParameterError for an
    argument out of range.
    """
    check_int("address", address, 0, 127)
    check_int("count", count, 1, TRANSFER_MAX - 1)
    return bytes((address, *(0 for _ in range(count))))


def status_transfers() -> list[bytes]:
    """SPI transfers that read the status and the counters; `decode_status` decodes their replies."""
    chip = register_map()
    first, last = chip.counters[0], chip.counters[-1]
    return [read_transfer(chip["busy"].address, 1), read_transfer(first.byte, last.byte + last.bytes - first.byte)]


def decode_status(replies: Sequence[bytes]) -> dict[str, int | bool]:
    """Decode the status and the counters.

    replies: replies to `status_transfers`, with the byte during the command. Returns field to value. Raises
    ParameterError for a reply of the wrong length.
    """
    chip, transfers = register_map(), status_transfers()
    lengths, expected = [len(r) for r in replies], [len(t) for t in transfers]
    if lengths != expected:
        raise ParameterError(f"status replies = {lengths} bytes: must be {expected}")
    status, counters = (bytes(r[1:]) for r in replies)
    base = chip.counters[0].byte
    return {
        **{f.name: bool(status[0] >> f.shift & 1) for f in chip.fields if f.register == "status"},
        **{f.name: int.from_bytes(counters[f.byte - base : f.byte - base + 8], "little") for f in chip.counters},
    }


def cycles_at_most(frame: FrameParameters, sensor: SensorParameters) -> int:
    """Limit of docs/host.md for the cycles of a frame, with a link that never stalls.

    frame: configuration. sensor: the sensor. Raises ParameterError if the window is outside the array or selects no
    pixel.
    """
    t, lanes = frame.timing, sensor.chip.lanes
    scan = Scan(*sensor.shape, lanes, frame, sensor.tile)
    taps = TAPS if frame.mode == "tof" else 1
    exposure = t.t_guard + taps * (
        t.t_reset + (t.n_cm + 1) * (t.t_int + t.t_guard) + t.n_cm * (t.t_cm + t.t_guard) + 2 * t.t_guard
        + t.t_settle + t.t_read
    )  # fmt: skip
    types = max(len(scan.columns_of(row)) for row in range(sensor.tile.rows))
    steps = types * (frame.window.col1 // lanes - frame.window.col0 // lanes + 1) * scan.subs
    step = max(10, 4 * lanes if frame.phase else lanes + 2)
    return 200 + (scan.row_list.size + t.exposure) * (exposure + steps * step + 40)

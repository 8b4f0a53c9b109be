"""The register file at its SPI port: effects of every byte written or read (models/parameters/registers)."""

from collections.abc import Mapping, Sequence

from talbot.models.parameters.registers import register_map

ADDRESS_MAX = 127  # the address stops counting up here


class RegisterBank:
    """State of the register file, byte by byte.

    A write to `start`, `abort` or `loop_back` is kept in ``start``, ``abort`` and ``loop`` (a byte) until `take`
    collects it.

    resets: values after reset that differ from the map's, by field (those that follow the array).
    """

    def __init__(self, resets: Mapping[str, int] | None = None) -> None:
        chip = register_map()
        self.chip = chip
        self.bytes = chip.image(chip.fields, resets)
        self.writable = chip.writable()
        self.sticky = {f.name: f.shift for f in chip.fields if f.access == "w1c"}
        self.held = 0  # sticky bits at their positions in the status byte
        self.snapshot = 0  # value of the counter whose first byte was read last
        self.start = self.abort = False
        self.loop: int | None = None

    def value(self, key: str) -> int:
        """Current value of a configuration field.

        key: key of the field in the map. Returns unsigned.
        """
        f = self.chip[key]
        raw = sum(self.bytes.get(f.byte + i, 0) << 8 * i for i in range(f.bytes))
        return raw >> f.shift & (1 << f.width) - 1

    def set(self, name: str) -> None:
        """Set a sticky status bit.

        name: name of the bit.
        """
        self.held |= 1 << self.sticky[name]

    def take(self) -> tuple[bool, bool, int | None]:
        """Start strobe, abort strobe, and loop-back byte or None, since the last call."""
        out = self.start, self.abort, self.loop
        self.start, self.abort, self.loop = False, False, None
        return out

    def write(self, address: int, byte: int, busy: bool, loop_full: bool) -> None:
        """Write one byte from the host.

        address: 0..127. byte: 0..255. busy: a frame runs. loop_full: a loop-back byte waits for the link.
        """
        chip = self.chip
        locked, loop_enable = busy or loop_full, bool(self.value("loop_enable"))
        if address == chip["start"].byte:
            abort = bool(byte >> chip["abort"].shift & 1)
            if abort:
                self.abort = True
                self.set("aborted")
            if byte >> chip["start"].shift & 1:
                if locked or loop_enable or abort:
                    self.set("refused")
                else:
                    self.start = True
                    self.held &= 1 << self.sticky["refused"]
        elif address == chip["busy"].byte:
            self.held &= ~byte
        elif address == chip["loop_back"].byte:
            if loop_full or not loop_enable:
                self.set("refused")
            else:
                self.loop = byte
        elif address in self.writable:
            if locked:
                self.set("refused")
            else:
                self.bytes[address] = byte & self.writable[address]

    def read(self, address: int, busy: bool, counters: Sequence[int], state: int = 0) -> int:
        """Read one byte for the host.

        address: 0..127. busy: a frame runs. counters: current values in the order of the map. state: current value of
        the register `state`. Returns 0..255; 0 at an unused address.
        """
        for f, value in zip(self.chip.counters, counters, strict=True):
            if address == f.byte:
                self.snapshot = value
            if f.byte <= address < f.byte + f.bytes:
                return self.snapshot >> 8 * (address - f.byte) & 0xFF
        first, size = self.chip.state[0].address, self.chip.state[0].size
        if first <= address < first + size:
            return state >> 8 * (address - first) & 0xFF
        if address == self.chip["busy"].byte:
            return self.held | busy << self.chip["busy"].shift
        return self.bytes.get(address, 0)

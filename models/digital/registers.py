"""The register file behind its SPI port: what a byte written or read does (models/parameters/registers)."""

from models.parameters.registers import register_map

ADDRESS_MAX = 127  # reached, the address no longer counts up


class RegisterBank:
    """State of the register file, byte by byte.

    resets: reset values that differ from the map's, by field (row1 and col1 follow the array).
    What a write makes happen is left in ``start`` and ``loop`` (a byte) until `take` collects it.
    """

    def __init__(self, resets=()):
        chip = register_map()
        self.chip = chip
        self.bytes = chip.image(chip.fields, dict(resets))
        self.writable = chip.writable()
        self.sticky = {f.name: f.shift for f in chip.fields if f.access == "w1c"}
        self.held = 0  # sticky bits at their places in the status byte
        self.snapshot = 0  # bytes of the counter whose first byte was read last
        self.start = False
        self.loop = None

    def value(self, key):
        """Present value of a configuration field, unsigned."""
        f = self.chip[key]
        raw = sum(self.bytes.get(f.byte + i, 0) << 8 * i for i in range(f.bytes))
        return raw >> f.shift & (1 << f.width) - 1

    def set(self, name):
        """Set a sticky status bit."""
        self.held |= 1 << self.sticky[name]

    def take(self):
        """(start, loop byte or None) since the last call."""
        out = self.start, self.loop
        self.start, self.loop = False, None
        return out

    def write(self, address, byte, busy, loop_full):
        """One byte from the host. busy: a frame runs. loop_full: the last loop-back byte still waits."""
        chip = self.chip
        if address == chip["start"].byte:
            if byte >> chip["start"].shift & 1:
                if busy:
                    self.set("refused")
                else:
                    self.start = True
                    self.held &= 1 << self.sticky["refused"]
        elif address == chip["busy"].byte:
            self.held &= ~byte
        elif address == chip["loop_back"].byte:
            if loop_full:
                self.set("refused")
            else:
                self.loop = byte
        elif address in self.writable:
            if busy:
                self.set("refused")
            else:
                self.bytes[address] = byte & self.writable[address]

    def read(self, address, busy, counters):
        """One byte for the host. counters: the present values in the order of the map."""
        for f, value in zip(self.chip.counters, counters, strict=True):
            if address == f.byte:
                self.snapshot = value
            if f.byte <= address < f.byte + f.bytes:
                return self.snapshot >> 8 * (address - f.byte) & 0xFF
        if address == self.chip["busy"].byte:
            return self.held | busy << self.chip["busy"].shift
        return self.bytes.get(address, 0)

"""Driver of the chip for a host in Python; asp_chip.h is the same in C, with the same error codes."""

import time
from collections.abc import Callable, Mapping, Sequence
from enum import IntEnum

from talbot.models.digital.host import command, decode_status, read_transfer, status_transfers, write_transfers
from talbot.models.parameters.registers import Field, array_resets, register_map


class Code(IntEnum):
    """Error of the driver."""

    IDENTITY = 2  # no AspChip answers, or one with another register map
    RANGE = 3  # a value does not fit its field
    READ_BACK = 4  # the configuration reads back otherwise than it was written
    REFUSED = 5  # the chip refused a write: a frame runs, or a loop-back byte waits, or loop_enable is in the way
    WINDOW = 6  # no frame: window inverted or outside the array, or nothing to read in it (cfg_err)
    DURATION = 7  # no frame: a duration is 0 (amp_err)
    ABORTED = 8  # the frame was aborted
    TIMEOUT = 9  # the limit has passed
    LINK = 10  # another byte than the expected one came from the link


class HostError(Exception):
    """An operation of `Host` failed, by its ``code``."""

    def __init__(self, code: Code, text: str) -> None:
        super().__init__(text)
        self.code = code


class Host:
    """A chip behind SPI and a link.

    transfer: one SPI transfer with csn low: bytes out, as many in. link: the bytes that have come since the last call,
    perhaps none. now: a clock that counts up; every limit is in its unit.
    """

    def __init__(
        self, transfer: Callable[[bytes], bytes], link: Callable[[], bytes], now: Callable[[], float] = time.monotonic
    ) -> None:
        self.transfer, self.link, self.now = transfer, link, now
        self.chip = register_map()
        self.identity: dict[str, int] = {}

    def identify(self) -> dict[str, int]:
        """Read who answers, field by field; `configure` needs it. Raises HostError IDENTITY."""
        self.identity = {f.name: self._value(f) for f in self.chip.identity}
        expected = {name: self.chip[name].reset for name in ("id", "version")}
        found = {name: self.identity[name] for name in expected}
        if found != expected:
            raise HostError(Code.IDENTITY, f"id, version = {found}: must be {expected}")
        return self.identity

    def defaults(self) -> dict[str, int]:
        """Return the configuration after a reset by key (models.digital.host.frame_values): the whole array."""
        found = self.identity
        resets = array_resets(found["rows"], found["cols"], found["lanes"], found["tile_rows"], found["tile_cols"])
        return {f.key: resets.get(f.key, f.reset) for f in self.chip.configuration}

    def configure(self, values: Mapping[str, int]) -> None:
        """Write ``values`` over the defaults, read back, compare. Raises HostError RANGE, REFUSED, READ_BACK."""
        values = self.defaults() | dict(values)
        for f in self.chip.configuration:
            low, high = f.range
            if not low <= values[f.key] <= high:
                raise HostError(Code.RANGE, f"{f.key} = {values[f.key]}: must be in {low}..{high}")
        image = self.chip.image(self.chip.configuration, values)
        self._write_checked(sorted(image.items()))
        first = min(image)
        back = self.read(first, max(image) - first + 1)
        for address, byte in image.items():
            if back[address - first] != byte:
                raise HostError(
                    Code.READ_BACK, f"byte at {address:#04x} = {back[address - first]:#04x}: must be {byte:#04x}"
                )

    def start(self) -> None:
        """Start a frame. Raises HostError REFUSED."""
        f = self.chip["start"]
        self._write_checked([(f.byte, 1 << f.shift)])

    def wait(self, limit: float) -> bytes:
        """Take the bytes of a frame until it has ended. Raises HostError WINDOW, DURATION, ABORTED, TIMEOUT."""
        since, taken = self.now(), b""
        while True:
            late, status = self.now() - since > limit, self.status()
            taken += self.link()
            if status["done"]:
                return taken
            for name, code in (("aborted", Code.ABORTED), ("amp_err", Code.DURATION), ("cfg_err", Code.WINDOW)):
                if status[name]:
                    raise HostError(code, f"status = {name}: the frame did not end by itself")
            if late:
                raise HostError(Code.TIMEOUT, f"limit = {limit}: the frame still runs")

    def frame(self, limit: float) -> bytes:
        """Start a frame and return its bytes; after TIMEOUT it is aborted. Raises HostError as `start` and `wait`."""
        self.link()
        self.start()
        try:
            return self.wait(limit)
        except HostError as error:
            if error.code == Code.TIMEOUT:
                self.abort()
            raise

    def abort(self) -> None:
        """End the frame, drop a loop-back byte that waits."""
        self.transfer(command("abort"))

    def status(self) -> dict[str, bool]:
        """Return the status bits by name."""
        (byte,) = self.read(self.chip["busy"].byte, 1)
        return {f.name: bool(byte >> f.shift & 1) for f in self.chip.fields if f.register == "status"}

    def counters(self) -> dict[str, int]:
        """All counters by name, in one transfer."""
        values = decode_status([self.transfer(t) for t in status_transfers()])
        return {f.name: int(values[f.name]) for f in self.chip.counters}

    def loop_back(self, data: bytes, limit: float) -> None:
        """Send bytes to loop_back and compare what the link brings. limit: for each.

        After an error a byte that waits is dropped; loop_enable is clear again. Raises HostError REFUSED,
        TIMEOUT, LINK.
        """
        self._loop_enable(True)
        self.link()
        try:
            for byte in data:
                self._loop_byte(byte, limit)
        except HostError:
            self.abort()
            raise
        finally:
            self._loop_enable(False)

    def read(self, address: int, count: int) -> bytes:
        """Read bytes."""
        return self.transfer(read_transfer(address, count))[1:]

    def write(self, writes: Sequence[tuple[int, int]]) -> None:
        """Write (address, byte) pairs."""
        for transfer in write_transfers(writes):
            self.transfer(transfer)

    def _value(self, f: Field) -> int:
        return int.from_bytes(self.read(f.byte, f.bytes), "little") >> f.shift & (1 << f.width) - 1

    def _write_checked(self, writes: Sequence[tuple[int, int]]) -> None:
        """Writes that the chip may refuse."""
        self.transfer(command("refused"))
        self.write(writes)
        if self.status()["refused"]:
            raise HostError(Code.REFUSED, f"write to {writes[0][0]:#04x}: refused")

    def _loop_enable(self, on: bool) -> None:
        f = self.chip["loop_enable"]
        others = self.read(f.byte, 1)[0] & ~(1 << f.shift)
        self._write_checked([(f.byte, others | on << f.shift)])

    def _loop_byte(self, byte: int, limit: float) -> None:
        self._write_checked([(self.chip["loop_back"].byte, byte)])
        since = self.now()
        while not (got := self.link()):
            if self.now() - since > limit:
                raise HostError(Code.TIMEOUT, f"limit = {limit}: no byte came from the link")
        if got != bytes((byte,)):
            raise HostError(Code.LINK, f"byte from the link = {got.hex(' ')}: must be {byte:02x}")

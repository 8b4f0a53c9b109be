"""Sessions at the chip's pins: lists of operations, random ones and mutations of those that reached something."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from talbot.models.digital.host import WRITE, command, read_transfer, write_transfers
from talbot.models.parameters import SensorParameters
from talbot.models.parameters.registers import register_map

Rng = np.random.Generator
CHIP = register_map()
STATUS = CHIP["busy"].byte
LENGTH = 24  # operations of a session at most
WAIT = 20_000  # cycles for a frame at most
DURATIONS = ("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard")
SETTINGS = tuple(f.key for f in CHIP.configuration if f.name != "trim")


@dataclass(frozen=True)
class Operation:
    """An operation of main.cpp. kind: R, W, L, E with ``value``, or T, a transfer of ``data``.

    bits: after which it is cut. half: cycles of half an SPI clock.
    """

    kind: str
    value: int = 0
    data: bytes = b""
    bits: int = 0
    half: int = 4

    @property
    def text(self) -> str:
        """The operation as the program reads it."""
        return f"T {self.half} {self.bits} {self.data.hex()}" if self.kind == "T" else f"{self.kind} {self.value}"


def transfer(data: bytes, bits: int = 1 << 12, half: int = 4) -> Operation:
    """Return a transfer. bits: cut after them."""
    return Operation("T", data=data, bits=min(bits, 8 * len(data)), half=half)


@dataclass(frozen=True)
class Session:
    """Operations after a reset. seed: of the registers at power-on, the link's stalls and late synchronizers."""

    seed: int
    scene: int
    operations: tuple[Operation, ...]

    @property
    def line(self) -> str:
        """The session as the program reads it."""
        return " ".join((f"{self.seed} {self.scene}", *(operation.text for operation in self.operations)))


def read(line: str) -> Session:
    """Return the session of a line."""
    words = line.split()
    seed, scene, at, operations = int(words[0]), int(words[1]), 2, []
    while at < len(words):
        if words[at] == "T":
            operations.append(transfer(bytes.fromhex(words[at + 3]), int(words[at + 2]), int(words[at + 1])))
        else:
            operations.append(Operation(words[at], int(words[at + 1])))
        at += 4 if words[at] == "T" else 2
    return Session(seed, scene, tuple(operations))


def number(rng: Rng, width: int) -> int:
    """Return a value of a field: an end, a power of two, or any."""
    choices = 0, 1, (1 << width) - 1, 1 << int(rng.integers(width)), int(rng.integers(1 << width))
    return choices[rng.integers(len(choices))]


class Maker:
    """Makes operations for the chip of ``sensor``."""

    def __init__(self, sensor: SensorParameters, rng: Rng) -> None:
        """Take the random generator of all that follows."""
        self.sensor, self.rng = sensor, rng
        last = sensor.full_window
        self.most = {"row0": last.row1, "row1": last.row1, "col0": last.col1, "col1": last.col1}
        self.kinds: tuple[Callable[[], list[Operation]], ...] = (
            self.settings, self.settings, self.frame, self.frame, self.frame, self.traffic, self.traffic, self.trims,
            self.wait, self.stall, self.abort, self.reset, self.loop_back, self.anything,
        )  # fmt: skip

    def value(self, key: str) -> int:
        """Return a value of a register, mostly one with which a short frame runs."""
        rng, field = self.rng, CHIP[key]
        if rng.random() < 0.04:
            return number(rng, field.width)
        if key in self.most:
            return int(rng.integers(self.most[key] + 1)) if rng.random() < 0.5 else self.most[key] * (key[-1] == "1")
        if key in (*DURATIONS, "n_cm"):
            return int(rng.integers(key != "n_cm", 5 if rng.random() < 0.9 else 300 if key in DURATIONS else 9))
        if key == "exposure":
            return int(rng.integers(8)) if rng.random() < 0.3 else 0
        if key == "loop_enable":
            return int(rng.random() < 0.05)
        if key == "mode":
            return int(rng.integers(8 if rng.random() < 0.2 else 5))
        if key == "mask" and rng.random() < 0.5:
            return (1 << self.sensor.tile.n_types) - 1
        return number(rng, field.width)

    def write(self, values: dict[str, int]) -> list[Operation]:
        """Write fields; the others of their bytes become 0."""
        half = 4 if self.rng.random() < 0.8 else int(self.rng.integers(4, 9))
        keys = {f.key for key in values for f in CHIP.configuration if f.byte == CHIP[key].byte}
        image = CHIP.image([CHIP[key] for key in sorted(keys)], values)
        return [transfer(data, half=half) for data in write_transfers(sorted(image.items()))]

    def settings(self) -> list[Operation]:
        """Write a few registers."""
        count = int(self.rng.integers(1, 4))
        return self.write({key: self.value(key) for key in self.rng.choice(SETTINGS, count, replace=False).tolist()})

    def configuration(self) -> list[Operation]:
        """Write all registers but the trims."""
        return self.write({key: self.value(key) for key in SETTINGS})

    def trims(self) -> list[Operation]:
        """Write trims of a few types."""
        first = int(self.rng.integers(self.sensor.tile.n_types))
        keys = [f.key for f in CHIP.trims[first : first + int(self.rng.integers(1, 5))]]
        return self.write({key: number(self.rng, CHIP[key].width) for key in keys})

    def frame(self) -> list[Operation]:
        """Start a frame and wait for its end, or for a time."""
        start, rng = transfer(command("start")), self.rng
        wait = Operation("E", WAIT) if rng.random() < 0.6 else Operation("W", int(rng.exponential(500)))
        return [start, wait, transfer(read_transfer(STATUS, 1)), *self.counters()]

    def counters(self) -> list[Operation]:
        """Read the counters, or nothing."""
        size = sum(f.bytes for f in CHIP.counters)
        return [transfer(read_transfer(CHIP.counters[0].byte, size))] if self.rng.random() < 0.3 else []

    def traffic(self) -> list[Operation]:
        """Read anything, cut anywhere."""
        data = read_transfer(int(self.rng.integers(128)), int(self.rng.integers(1, 10)))
        cut = 8 * len(data) if self.rng.random() < 0.7 else int(self.rng.integers(1, 8 * len(data) + 1))
        return [transfer(data, cut)]

    def wait(self) -> list[Operation]:
        """Wait: for the end, or for a time."""
        if self.rng.random() < 0.5:
            return [Operation("E", WAIT)]
        return [Operation("W", int(self.rng.exponential(200)) + 1)]

    def stall(self) -> list[Operation]:
        """Change the link's readiness."""
        return [Operation("L", int(self.rng.choice([16, 16, 15, 12, 8, 3, 1, 0])))]

    def abort(self) -> list[Operation]:
        """Abort what runs."""
        return [transfer(command("abort"))]

    def reset(self) -> list[Operation]:
        """Reset for some cycles."""
        return [Operation("R", int(self.rng.integers(4, 9)))]

    def loop_back(self) -> list[Operation]:
        """Send bytes in loop-back, and leave it."""
        options, loop = CHIP["loop_enable"], CHIP["loop_back"].byte
        data = self.rng.bytes(int(self.rng.integers(1, 4)))
        on = transfer(bytes((WRITE | options.byte, 1 << options.shift)))
        off = transfer(bytes((WRITE | options.byte, 0)))
        return [on, transfer(bytes((WRITE | loop, *data))), *([off] if self.rng.random() < 0.7 else [])]

    def anything(self) -> list[Operation]:
        """Write any bytes anywhere, cut anywhere."""
        data = bytes((WRITE | int(self.rng.integers(128)), *self.rng.bytes(int(self.rng.integers(1, 4)))))
        return [transfer(data, int(self.rng.integers(1, 8 * len(data) + 1)))]

    def few(self) -> list[Operation]:
        """Return operations of one kind."""
        return self.kinds[self.rng.integers(len(self.kinds))]()

    def session(self) -> Session:
        """Return a random session: a configuration, then anything."""
        operations = [*self.configuration(), *self.frame()]
        for _ in range(int(self.rng.integers(1, 6))):
            operations += self.few()
        return self.finished(operations)

    def finished(self, operations: Sequence[Operation]) -> Session:
        """Return a session that begins with a reset."""
        kept = (Operation("R", int(self.rng.integers(4, 9))), *operations[:LENGTH])
        return Session(int(self.rng.integers(1 << 32)), int(self.rng.integers(1 << 32)), kept)

    def mutated(self, session: Session, other: Session) -> Session:
        """Return a session with one to three changes: operations put in, left out, repeated, changed, or of another."""
        rng, operations = self.rng, list(session.operations[1:])
        for _ in range(int(rng.integers(1, 4))):
            at = int(rng.integers(len(operations) + 1))
            kind = rng.integers(6)
            if kind == 0:
                operations[at:at] = self.few()
            elif kind == 1:
                del operations[at : at + int(rng.integers(1, 3))]
            elif kind == 2:
                operations[at:at] = operations[max(at - 3, 0) : at]
            elif kind == 3:
                operations[at:] = other.operations[int(rng.integers(1, len(other.operations) + 1)) :]
            elif at < len(operations):
                operations[at] = self.changed(operations[at])
        changed = self.finished(operations)
        return replace(changed, seed=session.seed, scene=session.scene) if rng.random() < 0.5 else changed

    def changed(self, operation: Operation) -> Operation:
        """Return an operation with another number or byte."""
        rng = self.rng
        if operation.kind != "T":
            least, most = {"R": (4, 12), "L": (0, 16), "W": (1, 3000), "E": (WAIT, WAIT)}[operation.kind]
            near = operation.value + int(rng.integers(-3, 4))
            return replace(
                operation, value=int(np.clip(near if rng.random() < 0.7 else rng.integers(most), least, most))
            )
        if rng.random() < 0.2:
            return transfer(operation.data, int(rng.integers(1, 8 * len(operation.data) + 1)), operation.half)
        data = bytearray(operation.data)
        place = int(rng.integers(len(data)))
        data[place] = data[place] ^ 1 << int(rng.integers(8)) if rng.random() < 0.7 else int(rng.integers(256))
        return transfer(bytes(data), operation.bits, operation.half)

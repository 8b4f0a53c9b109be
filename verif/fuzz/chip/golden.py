"""The golden chip under a session: registers, frames and loop-back, driven by transfers and by when `busy` falls."""

import copy
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from itertools import product
from types import SimpleNamespace

import numpy as np
import numpy.typing as npt

from talbot.models.afe.noise import mix
from talbot.models.chip import golden_frame
from talbot.models.digital.host import cycles_at_most
from talbot.models.digital.pattern import PatternEnd
from talbot.models.digital.registers import RegisterBank
from talbot.models.digital.scan import pixels_read
from talbot.models.parameters import SAMPLES_PER_PIXEL, SIGNED, AmpTiming, ParameterError
from talbot.models.parameters import SensorParameters as Sensor
from talbot.models.parameters.registers import array_resets
from talbot.rtl.amp_ctrl.ports import TIMING
from talbot.rtl.asp_chip.asp_chip_fl import frame_of
from talbot.verif.fuzz.checks import Broken, demand
from talbot.verif.fuzz.chip.program import Byte, Observed, Run
from talbot.verif.fuzz.chip.sessions import CHIP, SETTINGS, STATUS, Operation, Session

COUNTERS = CHIP.counters
STATE = range(CHIP.state[0].address, CHIP.state[0].address + CHIP.state[0].size)
ERRORS = sum(1 << CHIP[name].shift for name in ("cfg_err", "amp_err"))
SYNC = 256
UNKNOWN = -1  # value of a counter that depends on time


@dataclass(frozen=True)
class SceneEnd(PatternEnd):
    """The front end of main.cpp. scene: its number. trims: signed, by pixel type."""

    scene: int = 0
    trims: tuple[int, ...] = ()

    def values(self, mode: str) -> npt.NDArray[np.float64]:
        """Return the values at the comparators, float64 (subs, rows, cols), in LSB."""
        sub, row, col = np.ogrid[: SAMPLES_PER_PIXEL[mode], : self.rows, : self.cols]
        place = np.full((), self.scene, np.uint32)
        for index, step in ((row, 0x9E3779B1), (col, 0x85EBCA6B), (sub, 0xC2B2AE35)):
            place = place + index.astype(np.uint32) * np.uint32(step)
        number = mix(place)
        high = (number >> np.uint32(8)).astype(np.float64)
        if mode not in SIGNED:
            return high % 272 - 8
        balance = np.array(self.trims)[self.tile.type_map(self.rows, self.cols)] >> 4
        return np.asarray(np.where(number & np.uint32(1), high % 17 - 8, high % 289 - 144) + balance, np.float64)


@lru_cache(4096)
def expected_frame(sensor: Sensor, scene: int, settings: tuple[int, ...], trims: tuple[int, ...]) -> "Frame":
    """Return what a start brings. settings: values of SETTINGS. trims: signed."""
    cfg = SimpleNamespace(**dict(zip(SETTINGS, settings, strict=True)))
    rows, cols, tile = sensor.array.rows, sensor.array.cols, sensor.tile
    try:
        frame = frame_of(cfg, sensor.chip.has_phase_path)
        pixels_read(rows, cols, sensor.chip.lanes, frame, tile)  # the window is refused before the durations
        frame = replace(frame, timing=AmpTiming(*(getattr(cfg, name) for name in (*TIMING, "exposure"))))
    except ParameterError as error:
        return Frame(errors=("cfg_err", "amp_err") if str(error).startswith("t_") else ("cfg_err",))
    end = PatternEnd(rows, cols, tile) if cfg.test_pattern else SceneEnd(rows, cols, tile, scene, trims)
    golden = golden_frame(np.zeros(0), sensor, frame, end)
    return Frame(golden.stream, golden.made, golden.left_out, limit=cycles_at_most(frame, sensor))


@dataclass(frozen=True)
class Frame:
    """A frame: its bytes and counters, or the error bits of a start without one. limit: cycles without stalls."""

    stream: bytes = b""
    made: int = 0
    left_out: int = 0
    errors: tuple[str, ...] = ()
    limit: int = 0

    @cached_property
    def link(self) -> list[int]:
        """The bytes as `Run` has them."""
        return [byte | SYNC for byte in self.stream]


@dataclass
class Chip:
    """A state of the golden chip. expected: bytes of the link since power-on. frame: the one that runs, or None."""

    sensor: Sensor
    scene: int
    bank: RegisterBank = field(init=False)
    expected: list[int] = field(default_factory=list)
    frame: Frame | None = None
    counters: list[int] = field(default_factory=lambda: [0] * len(COUNTERS))
    snapshot: int = 0
    begun: tuple[int, int] = 0, 0  # cycle and stalls at the start

    def __post_init__(self) -> None:
        """Reset the registers."""
        array, tile, chip = self.sensor.array, self.sensor.tile, self.sensor.chip
        self.bank = RegisterBank(array_resets(array.rows, array.cols, chip.lanes, tile.rows, tile.cols, chip.divider))

    def copied(self) -> "Chip":
        """Return an independent copy."""
        other = copy.copy(self)
        other.bank = copy.copy(self.bank)
        other.bank.bytes = dict(self.bank.bytes)
        other.expected, other.counters = list(self.expected), list(self.counters)
        return other

    def reset(self, taken: int) -> None:
        """Reset after ``taken`` bytes."""
        fresh = Chip(self.sensor, self.scene)
        self.bank, self.counters, self.snapshot, self.frame = fresh.bank, fresh.counters, 0, None
        self.expected = self.expected[:taken]

    def see(self, busy: bool, taken: int) -> None:
        """Follow `busy`: a frame ends where it is low. Raises Broken."""
        if self.frame is None:
            demand(not busy, "busy without a frame")
        elif not busy:
            demand(taken == len(self.expected), f"busy falls after {taken} of {len(self.expected)} bytes")
            for name in self.frame.errors or ("done",):
                self.bank.set(name)
            self.counters = [UNKNOWN] * 3 if self.frame.errors else [UNKNOWN, self.frame.made, self.frame.left_out]
            self.frame = None

    def write(self, address: int, byte: int, met: tuple[int, int, int], taken: int, begun: tuple[int, int]) -> None:
        """Write a byte where (busy, link_val, taken) are ``met``. taken: bytes until an abort."""
        busy, full, _ = met
        self.bank.write(address, byte, bool(busy), bool(full and self.bank.value("loop_enable")))
        start, abort, loop = self.bank.take()
        if loop is not None:
            self.expected.append(loop)
        if abort:
            self.frame, self.counters = None, [0] * len(COUNTERS)
            self.expected = self.expected[:taken]
        if start:
            settings = tuple(self.bank.value(key) for key in SETTINGS)
            trims = (self.bank.value(f.key) for f in CHIP.trims)
            half = 1 << CHIP.trims[0].width - 1
            self.frame = expected_frame(self.sensor, self.scene, settings, tuple((t ^ half) - half for t in trims))
            self.expected += self.frame.link
            self.counters, self.begun = [UNKNOWN] * len(COUNTERS), begun

    def read(self, address: int, met: tuple[int, int, int]) -> tuple[int, int]:
        """Fetch a byte; returns it and the mask of its bits that are known."""
        busy, full, _ = met
        for f, value in zip(COUNTERS, self.counters, strict=True):
            if address == f.byte:
                self.snapshot = value
            if f.byte <= address < f.byte + f.bytes:
                return self.snapshot >> 8 * (address - f.byte) & 0xFF, 0 if self.snapshot == UNKNOWN else 0xFF
        if address in STATE:
            return 0, 0 if busy or full else 0xFF
        known = 0xFF & ~ERRORS if address == STATUS and self.frame and self.frame.errors else 0xFF
        return self.bank.read(address, bool(busy), [0] * len(COUNTERS)), known


def check(sensor: Sensor, session: Session, run: Run) -> None:
    """Compare a run of a session. Raises Broken with the operation's number.

    With late synchronizers a byte may take effect before or after `busy` falls: all states that follow are tried.
    """
    chips, before = [Chip(sensor, session.scene)], Observed(0, 0, False, 0, "", [])
    for number, (operation, end) in enumerate(zip(session.operations, run.operations, strict=True)):
        alive: list[Chip] = []
        problem = ""
        for chip in chips:
            try:
                alive += follow(chip, operation, before, end, run.link)
            except Broken as error:
                problem = problem or str(error)
        demand(alive, f"operation {number} ({operation.text}): {problem}")
        chips, before = alive[:8], end


def follow(chip: Chip, operation: Operation, before: Observed, end: Observed, link: list[int]) -> list[Chip]:
    """Return the states after an operation; ``chip`` is that before it. Raises Broken where there is none."""
    if operation.kind == "R":
        chip = chip.copied()
        chip.reset(before.taken)
        chips: Iterable[Chip] = [chip]
    elif operation.kind == "T":
        chips = transfer(chip, operation, before, end)
    else:
        chips = [chip.copied()]
    alive, problem = [], ""
    for after in chips:
        try:
            after.see(end.busy, end.taken)
            for place in range(before.taken, end.taken):
                want = after.expected[place] if place < len(after.expected) else None
                demand(link[place] == want, f"byte {place} of the link = {link[place]}: must be {want}")
            if operation.kind == "E" and end.busy and after.frame:
                spent, stalls = end.cycle - after.begun[0], end.stalls - after.begun[1]
                demand(spent <= after.frame.limit + stalls, f"busy after {spent} cycles: at most {after.frame.limit}")
            alive.append(after)
        except Broken as error:
            problem = problem or str(error)
    demand(alive, problem)
    return alive


def transfer(chip: Chip, operation: Operation, before: Observed, end: Observed) -> list[Chip]:
    """Return the states after a transfer whose replies they allow. Raises Broken where there is none."""
    data, chips, problem = operation.data, [chip.copied()], ""
    command = data[0] if data else 0
    replies = [int(end.miso[8 * i : 8 * i + 8], 2) for i in range(len(end.bytes))]
    following = end.miso[8 * len(replies) :]  # bits of a byte that the transfer cuts
    begun = before.cycle, before.stalls
    expected = [(0, 0xFF)] * len(chips)
    for i, met in enumerate(end.bytes):
        alive: list[tuple[Chip, tuple[int, int]]] = []
        for state, (value, known) in zip(chips, expected, strict=True):
            if (replies[i] ^ value) & known:
                problem = (
                    problem or f"byte {i} of the reply is {replies[i]:02x}: must be {value:02x} in bits {known:02x}"
                )
                continue
            address = min((command & 0x7F) + i - 1, 127)
            for moment, answer in product(distinct(met.effect), distinct(met.fetch)):
                after = state.copied()
                try:
                    alive.append((after, effect(after, command, address, data[i], i, moment, met, answer, begun)))
                except Broken as error:
                    problem = problem or str(error)
        demand(alive, problem)
        alive = alive[:8]
        chips, expected = [state for state, _ in alive], [step for _, step in alive]
    if following:
        shift = 8 - len(following)
        chips = [
            state
            for state, (value, known) in zip(chips, expected, strict=True)
            if not (int(following, 2) ^ value >> shift) & known >> shift
        ]
        demand(chips, f"the cut byte of the reply is {following}: must begin {expected}")
    return chips


def distinct(moments: Iterable[tuple[int, int, int]]) -> list[tuple[int, int, int]]:
    """Return the moments that differ in busy or link_val."""
    return list({moment[:2]: moment for moment in moments}.values())


def effect(
    chip: Chip,
    command: int,
    address: int,
    byte: int,
    number: int,
    moment: tuple[int, int, int],
    met: Byte,
    answer: tuple[int, int, int],
    begun: tuple[int, int],
) -> tuple[int, int]:
    """Apply byte ``number`` of a transfer to ``chip``; returns the next byte of miso and its known bits."""
    writing = command & 0x80
    chip.see(bool(moment[0]), moment[2])
    if writing and number:
        chip.write(address, byte, moment, met.aborted, begun)
    chip.see(bool(answer[0]), answer[2])
    if writing:
        return 0, 0xFF
    return chip.read(min((command & 0x7F) + number, 127), answer)

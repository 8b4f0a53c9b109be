"""A row through the chip's Verilog with the circuit in the loop, and its codes and the real-number model's."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.imaging.frame.request import request
from talbot.models.afe import Converter, FrontEnd
from talbot.models.chip import golden_frame
from talbot.models.digital.stream import decode_stream
from talbot.models.parameters import (
    DRAWN,
    SHORT_TIMING,
    STANDARD,
    FrameParameters,
    ParameterError,
    SensorParameters,
    check_choice,
    check_int,
    circuit_columns,
    circuit_converter,
)
from talbot.models.parameters.electrical import AMPLIFIER
from talbot.pixels.circuits.interface import STROBE_TYPICAL
from talbot.pixels.circuits.specification import LaneSpec
from talbot.verif.cosim import lockstep
from talbot.verif.cosim.accuracy import Accuracy
from talbot.verif.cosim.columns import TIMING
from talbot.verif.cosim.deck import Deck, RowOfPixels, Timing, build
from talbot.verif.cosim.faults import Fault

MODES = ("edge", "image", "raw", "tof")
GAIN = 4.0


@dataclass(frozen=True)
class RowRequest:
    """A row of a small array.

    Attributes
    ----------
    mode : str
        Of MODES.
    cols : int
        Columns of the array, 6..48.
    lanes : int
        Converters, 1, 2 or 4.
    types : int
        Pixel types that are read, the first of the row's tile, 1..6.
    threshold : int
        Of edge mode, 0..127.
    seed : int
        Of the pixels' values, 0..2**32-1.
    fault : Fault or None
        Planted in the circuit.
    everything : bool
        Lanes that the row does not read are simulated, too.
    pixels : bool
        Pixels and column amplifiers are in the circuit; else ideal voltages.
    t_int : int
        Cycles of integration, 1..65535.
    amplifier : bool
        The lanes' difference amplifiers are in the circuit: edge mode with its pixels, or any with ``columns``; strobes
        as early as a lane times them.
    columns : bool
        The column amplifiers are transistors, too, and each half of the row's read takes 16 cycles.
    extracted : bool
        Lanes, amplifiers, biases and column amplifiers are as drawn, with their parasitics; without ``fault``.
    partition : bool
        Each lane and its columns are a separate circuit and process, with references, bias and row lines of their
        own; one chip hears all of them.
    sensor : SensorParameters
        Of which the small array has the tile and the chip.
    """

    mode: str = "image"
    cols: int = 12
    lanes: int = 2
    types: int = 6
    threshold: int = 10
    seed: int = 1
    fault: Fault | None = None
    everything: bool = False
    pixels: bool = True
    t_int: int = 20000
    amplifier: bool = False
    columns: bool = False
    extracted: bool = False
    partition: bool = True
    timing: Timing = Timing()
    accuracy: Accuracy = Accuracy()
    spec: LaneSpec = LaneSpec()
    sensor: SensorParameters = STANDARD

    def __post_init__(self) -> None:
        check_choice("mode", self.mode, MODES)
        check_int("cols", self.cols, 6, 48)
        check_choice("lanes", self.lanes, (1, 2, 4))
        check_int("types", self.types, 1, 6)
        check_int("threshold", self.threshold, 0, 127)
        check_int("t_int", self.t_int, 1, 65535)
        check_int("seed", self.seed, 0, 2**32 - 1)
        if self.extracted and self.fault:
            raise ParameterError(f"fault = {self.fault.name}: must be none with extracted circuits")
        if self.columns and not self.amplifier:
            raise ParameterError("columns = True: must be False without amplifier")
        if self.mode == "raw" and not self.columns:
            raise ParameterError("columns = False: must be True in mode raw, a lane reads either diode from them")
        if self.amplifier and not (self.pixels and (self.mode == "edge" or self.columns)):
            raise ParameterError("amplifier = True: must be False but in mode edge with pixels, or with columns")

    @property
    def name(self) -> str:
        """Of the row, for people."""
        return self.mode + ", as drawn" * self.extracted

    @cached_property
    def clock(self) -> Timing:
        """The circuit's timing."""
        return replace(self.timing, high=STROBE_TYPICAL) if self.amplifier else self.timing

    @cached_property
    def frame(self) -> tuple[SensorParameters, FrameParameters]:
        """The sensor, and a frame that reads one row of it."""
        rows = 4
        asked = request(
            rows=rows, cols=self.cols, lanes=self.lanes, mode=self.mode, converter="ideal", sensor=self.sensor
        )
        sensor = asked.sensor
        mask = sum(1 << kind for kind in set(sensor.tile.order[: self.types]))
        edge = self.mode == "edge"
        timing = replace(SHORT_TIMING, t_settle=TIMING.t_settle, t_read=TIMING.t_read) if self.columns else SHORT_TIMING
        frame = FrameParameters(
            window=sensor.full_window,
            mode=self.mode,
            mask=mask,
            threshold=self.threshold if edge else 0,
            timing=replace(timing, t_int=self.t_int, n_cm=0),
        )
        return sensor, frame

    @cached_property
    def front_end(self) -> FrontEnd:
        """The real-number front end: ideal converters, the amplifier's curve as fitted to ngspice's, drawn or not."""
        sensor, _ = self.frame
        none, converter = (0,) * sensor.tile.n_types, Converter.ideal(self.lanes)
        if self.amplifier:
            fitted = circuit_converter(DRAWN) if self.extracted else circuit_converter()
            curve = tuple(getattr(fitted, name) for name in AMPLIFIER)
            converter = replace(converter, amplifier=curve)
        return FrontEnd(GAIN, none, self.lanes, converter, sensor.tile)

    @cached_property
    def samples(self) -> npt.NDArray[np.float64]:
        """Diodes (taps, rows, cols, 2): sums over the whole range, differences of up to 30 LSB."""
        sensor, _ = self.frame
        rng = np.random.default_rng(self.seed)
        shape = (4 if self.mode == "tof" else 1, *sensor.shape)
        sums, differences = rng.uniform(35, 220, shape), rng.uniform(-30, 30, shape)
        return np.stack([(sums + differences) / 2, (sums - differences) / 2], -1)

    @cached_property
    def delivered(self) -> npt.NDArray[np.float64]:
        """`samples` as the column amplifiers give them: by their curves, as `make analog` measured a column."""
        if not self.columns:
            return self.samples
        curves = circuit_columns(DRAWN) if self.extracted else circuit_columns()
        return curves.samples(self.samples, self.mode)

    @cached_property
    def values(self) -> dict[tuple[int, int], float]:
        """LSB at (column, sub-sample) of the row's pixels that are read."""
        sensor, frame = self.frame
        read = golden_frame(self.delivered, sensor, frame, self.front_end).read
        values = self.front_end.values(self.delivered, self.mode)
        if self.front_end.converter:
            values = self.front_end.converter.amplified(values, self.mode != "edge")
        return {(int(c), s): float(values[s, 0, c]) for c in np.flatnonzero(read[0]) for s in range(len(values))}

    def lane_of(self, column: int) -> int:
        """Return the lane that converts a column."""
        return column // self.frame[0].tile.cols % self.lanes

    @cached_property
    def read(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Columns that are read, and lanes that convert them."""
        columns = {column for column, _ in self.values}
        return tuple(sorted(columns)), tuple(sorted(set(map(self.lane_of, columns))))

    @property
    def parts(self) -> tuple[Mapping[tuple[int, int], float], ...]:
        """`values` of each circuit."""
        if not self.partition or self.everything:
            return (self.values,)
        return tuple({at: v for at, v in self.values.items() if self.lane_of(at[0]) == lane} for lane in self.read[1])

    def decks(self, accuracy: Accuracy | None = None) -> tuple[Deck, ...]:
        """Return the circuit: of each lane that the row reads, or one of all."""
        return tuple(
            build(
                values,
                self.lanes,
                self.frame[0].tile.cols,
                self.mode != "edge",
                self.spec,
                self.clock,
                accuracy or self.accuracy,
                self.fault,
                self.everything,
                self._pixels if self.pixels else None,
                self.extracted,
                self.mode,
            )
            for values in self.parts
        )

    @property
    def _pixels(self) -> RowOfPixels:
        diodes = {
            c: {tap: (float(row[0, c, 0]), float(row[0, c, 1])) for tap, row in enumerate(self.samples)}
            for c in range(self.cols)
        }
        return RowOfPixels(
            diodes, self.cols, GAIN, self.t_int * self.timing.period, amplified=self.amplifier, columns=self.columns
        )


@dataclass(frozen=True)
class Sample:
    """One sample of the row. value: LSB at the lane. code, expected: of the circuit and of the real-number model.

    why: of the first decision in which they differ, (DAC code, volts' distance from the level in LSB), or None.
    """

    column: int
    sub: int
    lane: int
    value: float
    code: int
    expected: int
    why: tuple[int, float] | None


@dataclass(frozen=True)
class Row:
    """A row that was read. decision: s from the strobe to the comparator's decision, (cycles, lanes), nan for none."""

    request: RowRequest
    decks: tuple[Deck, ...]
    run: lockstep.Run
    samples: list[Sample]
    decision: npt.NDArray[np.float64]

    @property
    def lanes(self) -> list[int]:
        """Those in the circuit."""
        return [lane for deck in self.decks for lane in deck.lanes]

    @property
    def transistors(self) -> int:
        """Of all parts."""
        return sum(deck.transistors for deck in self.decks)

    @cached_property
    def at_lane(self) -> npt.NDArray[np.float64]:
        """Errors at the lane's input as its sample ends, LSB off the real-number model."""
        run, zero, off = self.run, 128 * (self.request.mode != "edge"), []
        for s in self.samples:
            end = (_held(run.cycles, s.column, s.sub, self.request)[0] + 1) * self.request.timing.period
            ends = (np.interp(end, run.time, run.waves[node]) for node in (f"in{s.lane}", f"ref{s.lane}"))
            volts = next(ends) - next(ends)
            off.append(volts / self.request.spec.lsb + zero - s.value)
        return np.array(off)

    @property
    def level_off(self) -> npt.NDArray[np.float64]:
        """Errors of the lane's levels in the search of each sample, LSB: 0 of an ideal lane.

        The comparator's inputs just before the strobe are a line through the two codes nearest to balance; its zero is
        the level that the value at the lane's input has.
        """
        run, at_lane, clock, off = self.run, self.at_lane, self.request.clock, []
        for s, miss in zip(self.samples, at_lane, strict=True):
            top, other = (run.waves[node] for node in self.decks[0].inside(s.lane)[:2])
            volts: dict[int, float] = {}
            for i in _search_of(run.cycles, _held(run.cycles, s.column, s.sub, self.request)[0], s.lane):
                strobe = i * clock.period + clock.high - clock.edge
                volts[int(run.cycles.asked[i, s.lane])] = float(np.interp(strobe, run.time, top - other))
            (a, at_a), (b, at_b) = sorted(volts.items(), key=lambda one: abs(one[1]))[:2]
            level = a - at_a * (b - a) / (at_b - at_a) - (0.5 if self.request.mode != "edge" else 128.5)
            off.append(level - s.value - miss)
        return np.array(off)

    @property
    def beyond(self) -> npt.NDArray[np.bool_]:
        """Whether a code is not the model's, and farther from its value than half an LSB and the noise."""
        stated = circuit_converter()
        far = 0.5 + float(np.hypot(stated.noise, stated.ktc))
        return np.array([s.code != s.expected and abs(s.code - s.value) > far for s in self.samples])

    @property
    def differences(self) -> npt.NDArray[np.int64]:
        """Codes of the circuit less those of the real-number model."""
        return np.array([s.code - s.expected for s in self.samples])


def read_row(asked: RowRequest, note: Callable[[str], None] = lambda text: None, program: Path | None = None) -> Row:
    """Read one row with the circuit in the loop. Raises ParameterError, ToolError."""
    sensor, frame = asked.frame
    binary, decks = program or lockstep.program(sensor, note), cache(asked.decks)
    run = lockstep.run(
        *(binary, decks, frame, asked.delivered, asked.front_end, asked.clock, asked.accuracy),
        note=lambda text: note(f"{asked.name}: {text}"),
    )
    codes = decode_stream(run.stream, sensor.tile)[0].samples[0]
    expected = golden_frame(asked.delivered, sensor, frame, asked.front_end).codes[0]
    found = []
    for (column, sub), value in asked.values.items():
        lane = asked.lane_of(column)
        why = _first_difference(run.cycles, lane, column, sub, asked)
        found.append(Sample(column, sub, lane, value, int(codes[column, sub]), int(expected[column, sub]), why))
    made = decks(asked.accuracy)
    return Row(asked, made, run, found, decision_times(run, made, asked.clock))


def _held(c: lockstep.Cycle, column: int, sub: int, asked: RowRequest) -> npt.NDArray[np.int64]:
    """Return the cycles in which a position is held."""
    width = asked.frame[0].tile.cols
    place = (c.group == column // (width * asked.lanes)) & (c.k == column % width) & (c.sub == sub)
    return np.flatnonzero(c.hold & place)


def _search_of(c: lockstep.Cycle, held: int, lane: int) -> Iterator[int]:
    """Yield the cycles in which a lane decides on the value held in a cycle."""
    for i in range(held + 1, len(c.hold)):
        if c.deciding[i, lane]:
            yield i
        if c.hold[i]:
            return


def _first_difference(
    c: lockstep.Cycle, lane: int, column: int, sub: int, asked: RowRequest
) -> tuple[int, float] | None:
    """Return the first decision on a sample in which circuit and model differ."""
    for held in _held(c, column, sub, asked):
        for i in _search_of(c, held, lane):
            if c.answer[i, lane] != c.expected[i, lane]:
                level = c.asked[i, lane] - (0.5 if c.unsigned[i] else 128.5)
                return int(c.asked[i, lane]), float(c.held[i, lane] - level)
    return None


def decision_times(run: lockstep.Run, decks: Sequence[Deck], timing: Timing) -> npt.NDArray[np.float64]:
    """Return the time, s, from the strobe's rise until the comparator's outputs are half the supply apart."""
    times = np.full(run.cycles.answer.shape, np.nan)
    for deck, lane in [(one, lane) for one in decks for lane in one.lanes]:
        half = 0.5 * deck.supply
        one, other = (run.waves[node] for node in deck.inside(lane)[2:])
        apart = np.abs(one - other)
        for i in np.flatnonzero(run.cycles.deciding[:, lane]):
            strobe = i * timing.period + timing.high + 0.5 * timing.edge
            first, last = np.searchsorted(run.time, (strobe, (i + 1) * timing.period))
            over = np.flatnonzero(apart[first:last] >= half)
            if over.size:
                j = first + over[0]
                part = (half - apart[j - 1]) / (apart[j] - apart[j - 1])
                times[i, lane] = run.time[j - 1] + part * (run.time[j] - run.time[j - 1]) - strobe
    return times

"""A frame at the chip's pins, from golden functions: the behaviour of AspChipFL."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from talbot.models.digital.pattern import pattern_value
from talbot.models.digital.phase import phase_samples
from talbot.models.digital.sar import decisions
from talbot.models.digital.scan import Scan, Step
from talbot.models.digital.stream import StreamHeader, encode_frame
from talbot.models.parameters import SIGNED, FrameParameters, SensorParameters


def idle_pins() -> dict[str, int]:
    """Return the pins that a frame drives, by name, with their value before a frame: 0."""
    return dict.fromkeys(
        (
            "dac",
            "hold",
            "wake",
            "convert",
            "unsigned_",
            "row",
            "group",
            "k",
            "sub",
            "en",
            "balance",
            "link_data",
            "link_val",
            "frame_sync",
        ),
        0,
    )


@dataclass
class GoldenRun:
    """One frame: the values of the pins by name, and the counters.

    trims: register values by pixel type, unsigned. Raises ParameterError if no frame can start.
    """

    sensor: SensorParameters
    frame: FrameParameters
    trims: tuple[int, ...]
    pins: dict[str, int] = field(default_factory=idle_pins)
    made: int = 0
    left_out: int = 0

    def __post_init__(self) -> None:
        array, chip = self.sensor.array, self.sensor.chip
        self.scan = Scan(array.rows, array.cols, chip.lanes, self.frame, self.sensor.tile)

    def cycles(self, comparator: Callable[[], int], link_rdy: Callable[[], bool]) -> Iterator[None]:
        """Generator of the frame: each `next` sets the pins for a cycle.

        comparator, link_rdy: functions that return the pin's value in that cycle.
        """
        sensor, frame = self.sensor, self.frame
        codes = np.zeros((sensor.array.rows, sensor.array.cols, self.scan.subs), np.int16)
        for row in self.scan.row_list:
            for step in self.scan.steps(int(row)):
                if step.enable:
                    yield from self._convert(step, codes, comparator)
        sent = np.stack(phase_samples(codes, sensor.chip, frame.noise_floor), -1) if frame.phase else codes
        header = StreamHeader.from_frame(sensor.array.rows, sensor.array.cols, sensor.chip.lanes, frame, sensor.tile)
        for byte in encode_frame(header, sent, self.made, self.left_out, sensor.tile):
            self.pins.update(link_data=byte, link_val=1, frame_sync=1)
            yield
            while not link_rdy():
                yield
        self.pins.update(link_val=0, frame_sync=0)

    def _convert(self, step: Step, codes: npt.NDArray[np.int16], comparator: Callable[[], int]) -> Iterator[None]:
        """Convert the lanes of a step into ``codes``, a decision of all lanes a cycle."""
        tile, frame = self.sensor.tile, self.frame
        tiles = {
            lane: self.scan.lanes * step.group + lane for lane in range(self.scan.lanes) if step.enable >> lane & 1
        }
        how = frame.mode not in SIGNED, frame.threshold, frame.mode == "ternary"
        searches = {lane: decisions(*how) for lane in tiles}
        trial = {lane: next(search) for lane, search in searches.items()}
        kind = tile.order[tile.cols * (step.row % tile.rows) + step.k]
        self.pins.update(wake=1)
        yield
        self.pins.update(
            wake=0,
            convert=1,
            hold=1,
            unsigned_=int(how[0]),
            row=step.row,
            group=step.group,
            k=step.k,
            sub=step.sub,
            en=step.enable,
            balance=self.trims[kind],
        )
        yield
        while trial:
            self.pins.update(hold=0, dac=sum(code << 8 * lane for lane, code in trial.items()))
            yield
            answers = comparator()
            for lane, code in list(trial.items()):
                above = bool(answers >> lane & 1)
                if frame.test_pattern:
                    above = bool(pattern_value(step.row, tiles[lane], step.k, step.sub) >= code)
                try:
                    trial[lane] = searches[lane].send(above)
                except StopIteration as end:
                    del trial[lane]
                    code, converted = end.value
                    codes[step.row, tile.cols * tiles[lane] + step.k, step.sub] = code
                    self.made += converted
                    self.left_out += not converted
        self.pins.update(convert=0)

"""The whole digital chip, bit true: from analog samples to codes and the byte stream."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from talbot.models.afe import Converter, FrontEnd
from talbot.models.digital.pattern import PatternEnd
from talbot.models.digital.phase import phase_samples
from talbot.models.digital.scan import pixels_read
from talbot.models.digital.stream import StreamHeader, encode_frame
from talbot.models.parameters import ConverterParameters, FrameParameters, SensorParameters
from talbot.models.parameters.energy import DigitalEvents


@dataclass(frozen=True, eq=False)
class GoldenFrame:
    """Expected output of the chip for one frame; samples that are not read are 0.

    sensor: the sensor.
    frame: configuration of the frame.
    codes: (rows, cols, subs), codes of the converters.
    converted: (rows, cols, subs), True where the search ran.
    sent: (rows, cols, subs), samples of the stream: the codes, or with ``frame.phase`` (phase, amplitude).
    read: (rows, cols), pixels that are read.
    decisions: comparator decisions, all lanes together.
    strobes: of all lanes' comparators: in a step each lane's is strobed from the sample until the last decision of any
        lane.
    """

    sensor: SensorParameters
    frame: FrameParameters
    codes: npt.NDArray[np.int16]
    converted: npt.NDArray[np.bool_]
    sent: npt.NDArray[np.int16]
    read: npt.NDArray[np.bool_]
    decisions: int
    strobes: int

    @property
    def samples(self) -> int:
        """Number of samples read from the array."""
        return int(self.read.sum()) * self.codes.shape[2]

    @property
    def made(self) -> int:
        """Number of conversions that ran."""
        return int(self.converted.sum())

    @property
    def left_out(self) -> int:
        """Number of samples that the window comparison set to zero."""
        return self.samples - self.made

    def digital_events(self, cycles: int) -> DigitalEvents:
        """Count the events of the digital part in a frame.

        cycles: in which the chip was busy. Returns DigitalEvents: for `EnergyParameters`.
        """
        divisions = int(self.read.sum()) if self.frame.phase else 0
        rows, sent = int(self.read.any(1).sum()), len(self.stream)
        return DigitalEvents(cycles, rows, self.samples, self.decisions, sent, divisions)

    @cached_property
    def stream(self) -> bytes:
        """Bytes of the frame."""
        array, lanes = self.sensor.array, self.sensor.chip.lanes
        header = StreamHeader.from_frame(array.rows, array.cols, lanes, self.frame, self.sensor.tile)
        return encode_frame(header, self.sent, self.made, self.left_out, self.sensor.tile)


def front_end_of(sensor: SensorParameters, trims: Iterable[int]) -> FrontEnd:
    """Analog front end of a sensor.

    sensor: the sensor. trims: register values by pixel type, -512..511. Returns FrontEnd: with drawn converters, or
    none where all imperfections are 0.
    """
    drawn = sensor.converter != ConverterParameters(seed=sensor.converter.seed)
    converter = Converter.draw(sensor.converter, sensor.chip.lanes) if drawn else None
    return FrontEnd(
        sensor.electrical.difference_gain, tuple(int(t) for t in trims), sensor.chip.lanes, converter, sensor.tile
    )


def golden_frame(
    samples: npt.NDArray[np.float64], sensor: SensorParameters, frame: FrameParameters, front_end: FrontEnd | PatternEnd
) -> GoldenFrame:
    """Run the golden chip on one exposure.

    samples: (taps, rows, cols, 2), diode pairs, a + b = 255 when both wells are full. sensor: the sensor. frame:
    configuration of the frame. front_end: converts the samples. Returns codes, samples sent and stream. Raises
    ParameterError for samples of a wrong shape or a window outside the array.
    """
    read = pixels_read(sensor.array.rows, sensor.array.cols, sensor.chip.lanes, frame, sensor.tile)
    done = front_end.convert(samples, frame.mode, frame.threshold)
    codes = np.moveaxis(done.codes, 0, 2) * read[..., None]
    converted = np.moveaxis(done.converted, 0, 2) & read[..., None]
    decisions = int(done.decisions[:, read].sum(dtype=np.int64))
    strobes = _strobes(done.decisions * read, sensor.chip.lanes, sensor.tile.cols)
    sent = codes
    if frame.phase:
        sent = np.zeros((*read.shape, 2), np.int16)
        sent[read] = np.stack(phase_samples(codes[read], sensor.chip, frame.noise_floor), -1)
    return GoldenFrame(sensor, frame, codes, converted, sent, read, decisions, strobes)


def _strobes(decisions: npt.NDArray[np.unsignedinteger], lanes: int, tile_cols: int) -> int:
    """Return the comparators' strobes for decisions (subs, rows, cols) of each pixel, 0 where none is read."""
    subs, rows, cols = decisions.shape
    wide = lanes * tile_cols
    steps = np.pad(decisions, ((0, 0), (0, 0), (0, -cols % wide))).reshape(subs, rows, -1, lanes, tile_cols).max(3)
    return lanes * int(steps.sum(dtype=np.int64) + np.count_nonzero(steps))

"""The whole digital chip, bit true: analog samples -> codes -> byte stream."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from models.afe import Converter, FrontEnd
from models.digital.phase import phase_samples
from models.digital.scan import Scan
from models.digital.stream import StreamHeader, encode_frame
from models.parameters import ConverterParameters, FrameParameters, SensorParameters


@dataclass(frozen=True, eq=False)
class GoldenFrame:
    """What the chip must send for one frame. Arrays are (rows, cols, subs); unread samples are 0.

    codes: int16, what the converters give. converted: bool, True where the search ran.
    sent: int16, what goes into the stream: the codes, or with ``frame.phase`` (phase, amplitude).
    read: bool (rows, cols). decisions: of the comparators, all together.
    """

    sensor: SensorParameters
    frame: FrameParameters
    codes: np.ndarray
    converted: np.ndarray
    sent: np.ndarray
    read: np.ndarray
    decisions: int

    @property
    def samples(self):
        """Samples read from the array."""
        return int(self.read.sum()) * self.codes.shape[2]

    @property
    def made(self):
        """Conversions that ran."""
        return int(self.converted.sum())

    @property
    def left_out(self):
        """Samples that the window comparison found to be zero."""
        return self.samples - self.made

    @cached_property
    def stream(self):
        """The frame's bytes."""
        array, lanes = self.sensor.array, self.sensor.chip.lanes
        header = StreamHeader.from_frame(array.rows, array.cols, lanes, self.frame, self.sensor.tile)
        return encode_frame(header, self.sent, self.made, self.left_out, self.sensor.tile)


def front_end_of(sensor, trims):
    """The analog front end of ``sensor``; ideal converters cost nothing. trims: register values by pixel type."""
    drawn = sensor.converter != ConverterParameters(seed=sensor.converter.seed)
    converter = Converter.draw(sensor.converter, sensor.chip.lanes) if drawn else None
    return FrontEnd(
        sensor.electrical.difference_gain, tuple(int(t) for t in trims), sensor.chip.lanes, converter, sensor.tile
    )


def golden_frame(samples, sensor, frame, front_end):
    """The golden chip on one exposure; returns GoldenFrame.

    samples: float64 (taps, rows, cols, 2), diode pairs with a + b = 255 when both wells are full.
    """
    read = Scan(sensor.array.rows, sensor.array.cols, sensor.chip.lanes, frame, sensor.tile).read
    done = front_end.convert(samples, frame.mode, frame.threshold)
    codes, converted, decisions = (np.moveaxis(part, 0, 2) * read[..., None] for part in done)
    sent = codes
    if frame.phase:
        sent = np.zeros((*read.shape, 2), np.int16)
        sent[read] = np.stack(phase_samples(codes[read], sensor.chip, frame.noise_floor), -1)
    return GoldenFrame(sensor, frame, codes, converted, sent, read, int(decisions.sum(dtype=np.int64)))

"""The analog front end for a whole frame, diode pairs to held values and codes: the NumPy twin of pixels/afe.sv."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from talbot.models.afe.converter import Converter
from talbot.models.afe.trim import trim_gain
from talbot.models.digital.sar import Conversion, convert
from talbot.models.parameters import MODES, SIGNED, ParameterError, TileParameters, check_choice, check_int, check_real


@dataclass(frozen=True, eq=False)
class FrontEnd:
    """Trimmed difference amplifier, sample-and-hold and converters of the whole array.

    gain: gain of the difference before conversion, 0.25..64.
    trim: register value of every pixel type, -512..511 (models/afe/trim.py).
    lanes: converters, 1..32; lane t mod lanes converts tile column t.
    converter: imperfections of the lanes; None is ideal ones.
    tile: the tile.

    Raises ParameterError for a value out of range, or a converter of other lanes.
    """

    gain: float
    trim: tuple[int, ...]
    lanes: int = 8
    converter: Converter | None = None
    tile: TileParameters = TileParameters()

    def __post_init__(self) -> None:
        check_real("gain", self.gain, 0.25, 64)
        check_int("lanes", self.lanes, 1, 32)
        trim_gain(self.trim)
        if len(self.trim) != self.tile.n_types:
            raise ParameterError(f"trim = {len(self.trim)} values: must be one per pixel type, {self.tile.n_types}")
        if self.converter is not None and self.converter.lanes != self.lanes:
            raise ParameterError(f"converter = {self.converter.lanes} lanes: must be {self.lanes}")

    def values(self, samples: npt.ArrayLike, mode: str) -> npt.NDArray[np.float64]:
        """Values at the input of the sample-and-hold.

        samples: (taps, rows, cols, 2), diodes a and b of every pixel, a + b = 255 when both wells are full. mode: edge
        and ternary: gain * (a - b * g); image: a + b; raw: 2 a and 2 b; tof: a + b of each tap. Returns (subs, rows,
        cols), in LSB. Raises ParameterError for a wrong shape, mode or number of taps, and for samples that are not
        finite.
        """
        check_choice("mode", mode, MODES)
        samples = np.asarray(samples)
        if samples.ndim != 4 or samples.shape[3] != 2 or samples.dtype != np.float64:
            raise ParameterError(f"samples = {samples.dtype} {samples.shape}: must be float64 (taps, rows, cols, 2)")
        if samples.shape[0] < (4 if mode == "tof" else 1):
            raise ParameterError(f"taps = {samples.shape[0]}: must be 4 in mode 'tof'")
        if not np.isfinite(samples).all():
            raise ParameterError("samples = nan or infinity: must be finite")
        a, b = samples[0, ..., 0], samples[0, ..., 1]
        if mode in SIGNED:
            g = trim_gain(self.trim)[self.tile.type_map(*a.shape)]
            return (self.gain * (a - b * g))[None]
        if mode == "image":
            return (a + b)[None]
        if mode == "raw":
            return np.stack([2.0 * a, 2.0 * b])
        return samples[:4, ..., 0] + samples[:4, ..., 1]

    def convert(self, samples: npt.ArrayLike, mode: str, threshold: int = 0) -> Conversion:
        """Convert a whole frame.

        The noise of a sample is drawn for its number (sub * rows + row) * cols + col: it does not depend on the
        window, the mask or the order in which samples are read.

        samples: (taps, rows, cols, 2), as in `values`. mode: one of MODES. threshold: 0..127 codes; edge and ternary
        mode. Returns Conversion: of arrays (subs, rows, cols). Raises ParameterError as in `values`, and for a
        threshold out of range.
        """
        v = self.values(samples, mode)
        unsigned = mode not in SIGNED
        if self.converter is not None:
            v = self.converter.amplified(v, unsigned)
        lane = np.arange(v.shape[2]) // self.tile.cols % self.lanes
        index = np.arange(v.size).reshape(v.shape)
        return convert(v, unsigned, threshold, self.converter, lane, index, mode == "ternary")

"""A bench: the simulated chip before a white screen, and a hole that moves across the pupil of its lens.

The chip's samples alone leave here. What makes them, the sensor's own optics, is not read by models/calibrate.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from talbot.base.progress import each
from talbot.imaging.frame.request import FrameRequest
from talbot.models.afe import FrontEnd, trim_gain
from talbot.models.calibrate import Sweep, block_means, sunflower
from talbot.models.capture import Exposure, Region, exposed, integrate
from talbot.models.chip import front_end_of, golden_frame
from talbot.models.parameters import ParameterError
from talbot.models.pixel import measured_gains
from talbot.models.pixel.weights import density
from talbot.models.scene import Sampling, load

Values = npt.NDArray[np.float64]
FLATS = 8  # frames each through the whole pupil, of the screen and of half its light
PEAK = 200.0  # code of the brightest pixel, of 255, to which the lamp is set
DIM = 0.2  # of the light of white: a first frame, which the lamp is set by
MARGIN = 0.97  # of the pupil's radius within which the hole moves


@dataclass(frozen=True)
class Bench:
    """The chip of a request in raw mode, on the bench. holes: across the pupil, 5..31."""

    request: FrameRequest
    holes: int

    def sweep(self, note: Callable[[str], None] = lambda text: None) -> Sweep:
        """Measurements of a bench."""
        sensor = self.request.lit
        tile, (rows, cols) = sensor.tile, sensor.shape
        if np.bincount(tile.type_map(rows, cols).ravel(), minlength=tile.n_types).min() == 0:
            raise ParameterError(f"rows, cols = {rows}, {cols}: must hold every pixel type")
        note("flat field")
        white, gray = (self._flat(light) for light in (0.5, 0.25))
        dark: Values = 2 * gray - white  # offsets without a dark frame, whose codes end at 0
        middle = (np.arange(n) - (n - 1) / 2 for n in (rows, cols))
        places = np.asarray(np.stack(np.meshgrid(*middle, indexing="ij"), -1), np.float64)
        holes = self._places()
        lamp = DIM * PEAK / max(float(self._frame(self._lit(np.zeros(2)) * DIM, 0).max()), 1.0)
        note(f"{len(holes)} places of the hole")
        offset = block_means(dark, tile)
        means = [
            block_means(self._frame(lamp * self._lit(hole), 1 + i), tile) - offset
            for i, hole in enumerate(each(holes, "hole", total=len(holes)))
        ]
        return Sweep(holes, np.stack(means), block_means(places, tile), measured_gains(white - dark, tile))

    def _places(self) -> Values:
        """Tangents (y, x) of the hole's places in the lens's disc."""
        return sunflower(round(np.pi / 4 * self.holes**2), MARGIN * self.request.lit.optics.nu_max)

    def _flat(self, light: float) -> Values:
        """Mean of frames of the screen through the whole pupil, (rows, cols, 2) in codes."""
        sensor = self.request.lit
        region = Region(1, np.ones(sensor.shape, bool))
        pair = np.asarray(integrate(load("flat:100", Sampling.of(sensor)), sensor, region)[0], np.float64)
        first = 10_000 + round(1000 * light)
        return np.asarray(sum(self._frame(light * pair, first + i) for i in range(FLATS)), np.float64) / FLATS

    def _lit(self, hole: Values) -> Values:
        """Photocurrents of white through the hole, (2, rows, cols)."""
        sensor = self.request.lit
        kinds = sensor.tile.type_map(*sensor.shape)
        power = sensor.optics.camera.pupil_power * sensor.array.pitch
        y, x = (
            np.broadcast_to(tangents, kinds.shape)
            for tangents in (
                hole[0] + power * (np.arange(len(kinds)) - (len(kinds) - 1) / 2)[:, None],
                hole[1] + power * (np.arange(kinds.shape[1]) - (kinds.shape[1] - 1) / 2),
            )
        )
        out = np.empty((2, *kinds.shape))
        for number, kind in enumerate(sensor.tile.types):
            of_type = kinds == number
            out[:, of_type] = density((kind,), sensor.optics, x[of_type], y[of_type])[0]
        return out

    @cached_property
    def _front_end(self) -> FrontEnd:
        return front_end_of(self.request.lit, np.zeros(self.request.sensor.tile.n_types, int))

    def _frame(self, pair: Values, number: int) -> Values:
        """Codes of a raw frame of the golden chip, (rows, cols, 2); each number has independent noise."""
        request, sensor = self.request, self.request.lit
        front_end = self._front_end
        exposure = Exposure(
            sensor.electrical, request.frame.exposing, sensor.chip.f_clk, request.noise, request.seed, number
        )
        samples = np.asarray(exposed(pair[None], sensor, exposure, trim_gain(front_end.trim)), np.float64)
        return golden_frame(samples, request.sensor, request.frame, front_end).sent.astype(float)

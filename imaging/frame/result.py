"""Results of the main job: exposure, the chip's frame, the golden frame."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from talbot.base.kept import kept
from talbot.imaging.frame.hardware import HardwareFrame
from talbot.imaging.frame.request import FrameRequest
from talbot.models.afe import FrontEnd
from talbot.models.capture import Views
from talbot.models.chip import GoldenFrame
from talbot.models.digital.stream.frame import DecodedFrame
from talbot.models.parameters import SIGNED, FrameParameters, SensorParameters
from talbot.models.pixel.time_of_flight import quadrature
from talbot.models.plan import Plan
from talbot.models.reconstruct import edge_images, rebuild, sum_image
from talbot.models.reconstruct.rebuild import Rebuilt
from talbot.models.scene import Scene

if TYPE_CHECKING:
    from talbot.models.reconstruct.methods import Found

PHASE_TURN = 2 * np.pi / 256  # rad a code


@dataclass(frozen=True, eq=False)
class Exposed:
    """One exposure of a scene.

    views: how many views of which pixels.
    samples: (taps, rows, cols, 2), what the front end samples. clean: the same without noise. ideal: (rows, cols,
    subs), the values ahead of the converters, in LSB, of the clean ones. full: (rows, cols), pixels with a full well,
    whose values no figure counts.
    """

    scene: Scene
    plan: Plan
    views: Views
    front_end: FrontEnd
    samples: npt.NDArray[np.float64]
    clean: npt.NDArray[np.float64]
    ideal: npt.NDArray[np.float64]
    full: npt.NDArray[np.bool_]


SIGN = 1.7  # thresholds that a sign counts as: the mean of codes above 5 to 20 on usual scenes is 1.4 to 2.3


def in_codes(samples: npt.NDArray[Any], frame: FrameParameters) -> npt.NDArray[Any]:
    """Return decoded samples in codes: in ternary mode a sign is an estimate of one, `SIGN` thresholds."""
    return samples * (SIGN * max(frame.threshold, 1)) if frame.mode == "ternary" else samples


@dataclass(frozen=True, eq=False)
class GoldenResult:
    """One run of the golden chip, and its stream decoded."""

    request: FrameRequest
    exposed: Exposed
    golden: GoldenFrame
    decoded: DecodedFrame

    @property
    def stream(self) -> bytes:
        """The bytes that were decoded."""
        return self.golden.stream

    @property
    def by_content(self) -> "GoldenResult":
        """The result as an argument of `kept`: without fields that change from run to run."""
        return GoldenResult(self.request.of_frame, self.exposed, self.golden, self.decoded)

    @cached_property
    def sensor(self) -> SensorParameters:
        """The sensor as it is known, in the light of the frame, with as many views as the scene has."""
        sensor, calibration = self.request.lit, self.request.calibration
        sensor = calibration.applied(sensor) if calibration else sensor
        return replace(sensor, optics=replace(sensor.optics, views=self.exposed.scene.views))

    @property
    def counted(self) -> npt.NDArray[np.bool_]:
        """Pixels that are read and have no full well: those that the figures are of, (rows, cols)."""
        return np.asarray(self.golden.read & ~self.exposed.full)

    @cached_property
    def rebuilt(self) -> Rebuilt:
        """The 2-D image rebuilt from the decoded edges and the scene's disparity."""
        exposed, edges = self.exposed, in_codes(self.decoded.samples, self.request.frame)[..., 0]
        trim, timing = exposed.front_end.trim, self.request.frame.exposing
        read = self.decoded.read & ~exposed.full
        return kept("rebuilt", rebuild, edges, read, exposed.scene, self.sensor, trim, timing)

    @property
    def edges(self) -> npt.NDArray[np.float64]:
        """One image of decoded differences a pixel type, in codes, (types, tile rows, tile cols); not of sums."""
        frame = self.request.frame
        samples = in_codes(self.decoded.samples, frame).astype(float)
        difference = samples[..., 0] if frame.mode in SIGNED else samples[..., 0] - samples[..., 1]
        return edge_images(difference, self.request.sensor.tile)

    @cached_property
    def image(self) -> npt.NDArray[np.float64]:
        """The 2-D image of the mode, relative radiance: rebuilt from edges, or from sums, or the taps' amplitude."""
        frame, sensor, samples = self.request.frame, self.request.lit, self.decoded.samples.astype(float)
        if frame.mode in SIGNED:
            return self.rebuilt.image
        if frame.mode == "tof":
            # Amplitude is half the difference of two taps that see a wave of half the light, times the contrast.
            return np.asarray(
                sum_image(self.echo[1] / sensor.electrical.contrast, sensor, self.decoded.read, frame.exposing), float
            )
        total = samples[..., 0] if frame.mode == "image" else samples.sum(2) / 2
        return np.asarray(sum_image(total, sensor, self.decoded.read, frame.exposing), float)

    @cached_property
    def echo(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Phase (rad) and amplitude (codes) of the decoded samples, (rows, cols); time of flight only."""
        samples = self.decoded.samples.astype(float)
        if self.request.frame.phase:
            return samples[..., 0] * PHASE_TURN, samples[..., 1]
        x, y = quadrature(np.moveaxis(samples, 2, 0))
        return np.arctan2(y, x), np.hypot(x, y)

    @property
    def light_field_method(self) -> str:
        """Name of the method of `estimate`; raw mode only."""
        from talbot.imaging.frame import light_field  # it imports for long

        return light_field.method_of(self)

    @cached_property
    def estimate(self) -> "Found":
        """The light field from the decoded diodes, relative radiance, by `light_field_method`; raw mode only."""
        from talbot.imaging.frame import light_field

        return light_field.estimate(self, self.light_field_method)


@dataclass(frozen=True, eq=False)
class FrameResult(GoldenResult):
    """Everything of one run through the chip's Verilog, for the figures, the pictures and the report.

    decoded: the chip's stream. program: the simulator.
    """

    chip: HardwareFrame
    program: Path

    @property
    def stream(self) -> bytes:
        """The bytes that left the chip."""
        return self.chip.stream

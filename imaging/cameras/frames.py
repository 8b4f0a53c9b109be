"""A frame of any camera: its samples by the same exposure, noise and converters, with bytes and energy."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from talbot.imaging.frame.figures import golden_events
from talbot.models.capture import Exposure, cells, exposed
from talbot.models.capture.cameras import LIGHT, OPEN
from talbot.models.capture.projection import Projection
from talbot.models.chip import front_end_of, golden_frame
from talbot.models.digital.exposure import integration_cycles
from talbot.models.digital.stream import decode_stream
from talbot.models.parameters import (
    ELEMENTARY_CHARGE,
    EnergyParameters,
    FrameParameters,
    LightParameters,
    RoomParameters,
    SensorParameters,
    TileParameters,
)
from talbot.models.plan.exposure import exposed_for, frame_cycles
from talbot.models.reconstruct import diode_noise, white_sum
from talbot.models.reconstruct.intensity import sum_noise
from talbot.models.scene import Scene

Values = npt.NDArray[np.float64]
FINE = 15  # cells of the pupil through which a scene is captured, along its diameter
RAW, IMAGE = "raw", "image"  # modes of the chip: both diodes of a pixel, or their sum


@dataclass(frozen=True, eq=False)
class Frame:
    """A frame of a camera.

    samples: (channels, rows, cols), white is 1 in the mean. noise: their standard deviation in the frame's mean light.
    """

    samples: Values
    snr_db: float
    noise: float
    bytes: int
    energy_uj: float
    seconds: float


def fine(scene: Scene) -> int:
    """Return the cells of the pupil through which ``scene`` is captured: its own where it has no other views."""
    return FINE if callable(scene.render) and scene.angular else scene.views


def captured(scene: Scene, camera: Projection) -> Values:
    """Return the samples of ``scene`` without noise, (channels, rows, cols)."""
    see = scene.view(np.ones(scene.shape, bool))
    step, middle = scene.views / camera.pupil, (camera.pupil - 1) / 2
    out = np.zeros(camera.responses.shape)
    for v, u in np.argwhere(cells(camera.pupil)):
        camera.add(out, see((v - middle) * step, (u - middle) * step)[0], v, u)
    return out


def seconds_of(sensor: SensorParameters, lux: float) -> float:
    """Return the exposure in which an open pixel's white gives the signal of RoomParameters, in s."""
    lit, frame = _lit(sensor, lux, 1.0, IMAGE)
    timing = exposed_for(RoomParameters.signal, frame, lit)
    return integration_cycles(timing)[-1] / sensor.chip.f_clk


def expose(sensor: SensorParameters, name: str, clean: Values, lux: float, seconds: float, seed: int) -> Frame:
    """Return the frame of samples without noise ``clean`` (channels, rows, cols), of a camera of `CAMERAS`.

    lux, seconds: illuminance of white, and exposure. seed: of fixed pattern and noise.
    """
    mode = RAW if len(clean) == 2 else IMAGE
    lit, frame = _lit(sensor, lux, LIGHT[name], mode)
    e = lit.electrical
    signal = seconds * e.white_current / ELEMENTARY_CHARGE / e.full_well
    frame = replace(frame, timing=exposed_for(signal, frame, lit))
    pair = clean if mode == RAW else np.repeat(clean, 2, 0)
    exposure = Exposure(e, frame.exposing, lit.chip.f_clk, 1.0, seed)
    samples = np.asarray(exposed(pair[None], lit, exposure), float)
    golden = golden_frame(samples, lit, frame, front_end_of(lit, [0] * lit.tile.n_types))
    decoded = decode_stream(golden.stream, lit.tile)[0]
    values = np.moveaxis(np.asarray(decoded.samples, float), 2, 0) / white_sum(lit, frame.exposing)
    mean = clean.mean()
    noise = diode_noise(mean, lit, frame.exposing) if mode == RAW else sum_noise(mean, lit, frame.exposing)
    cycles = frame_cycles(frame, lit)
    energy = EnergyParameters().total(golden_events(golden, golden.stream, cycles, cycles))
    error = np.mean((values - clean) ** 2)
    taken = integration_cycles(frame.exposing)[-1] / lit.chip.f_clk
    snr = 10 * np.log10(np.mean(clean**2) / error)
    return Frame(values, float(snr), float(noise), len(golden.stream), 1e6 * energy[0], taken)


@lru_cache(maxsize=16)
def _lit(sensor: SensorParameters, lux: float, light: float, mode: str) -> tuple[SensorParameters, FrameParameters]:
    """Return the chip of a camera in this light, and its frame: pixels without gratings have a tile of one type."""
    tile = sensor.tile if mode == RAW else TileParameters(1, 1, (OPEN,), (0,))
    lit = RoomParameters(illuminance=lux).lit(replace(sensor, tile=tile), LightParameters(gratings=light))
    return lit, FrameParameters(window=lit.full_window, mode=mode)

"""Polarization and depth of a run, by the same functions as `make polar` and `make depth`."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.api.image import Image, embedded, png, table
from talbot.api.light_field import LightField
from talbot.imaging.depth.capture import capture
from talbot.imaging.depth.measure import read_depth
from talbot.imaging.frame import pictures
from talbot.imaging.frame.light_field import prior_of
from talbot.imaging.frame.result import FrameResult, GoldenResult
from talbot.imaging.polar.measure import read_polarization
from talbot.models.parameters import ParameterError, check_int, check_real
from talbot.models.scene import RADIANCE_MAX

DISPARITIES = 21  # as `make depth` tries them


@dataclass(frozen=True, eq=False)
class Measured:
    """Figures of a run. summary: the figures, as in summary.json of the command."""

    summary: dict[str, Any]


@dataclass(frozen=True, eq=False, repr=False)
class PolarizationResult(Measured):
    """Linear polarization at every pixel, each (rows, cols).

    psi: angle in rad, (-pi/2, pi/2]. degree: 0..1. light: S0, 1 = white. confidence: 0..1, 0 where psi is not known.
    highlights: bool, where a reflection of a lamp is seen.
    """

    psi: Image
    degree: Image
    light: Image
    confidence: Image
    highlights: npt.NDArray[np.bool_]

    def __repr__(self) -> str:
        return f"<Polarization of {self.psi.shape[0]} x {self.psi.shape[1]} pixels>"

    def _repr_png_(self) -> bytes | None:
        return png(pictures.angle(np.where(self.confidence > 0, self.psi, np.nan)))

    def _repr_html_(self) -> str:
        return _shown(self, "psi_error_deg", "degree_rms", "sure", "f1")


@dataclass(frozen=True, eq=False, repr=False)
class DepthResult(Measured):
    """Depth at every pixel, each (rows, cols) in m.

    depth: finite everywhere. sure: bool, where the whole turns of the phase are known. disparity: of the light field
    that tells them, px per view step. behind: of what an occluder hides, NaN where no ray passes; None without one.
    light_field: mean light of the four taps, l[v, u, y, x], 1 = white.
    """

    depth: Image
    sure: npt.NDArray[np.bool_]
    disparity: Image
    behind: Image | None
    light_field: LightField

    def __repr__(self) -> str:
        return f"<Depth of {self.depth.shape[0]} x {self.depth.shape[1]} pixels, {100 * self.sure.mean():.1f} % sure>"

    def _repr_png_(self) -> bytes | None:
        low, high = float(self.depth.min()), float(self.depth.max())
        return png(pictures.depth(np.where(self.sure, self.depth, np.nan), low, high + 1e-3))

    def _repr_html_(self) -> str:
        return _shown(self, "depth_rms_m", "depth_sure", "range_m", "ambiguity_m")


def polarization_of(result: GoldenResult, highlight: float) -> PolarizationResult:
    """Polarization of a raw frame. Raises ParameterError."""
    _check_mode(result, "raw", "polarization")
    check_real("highlight", highlight, 0, 16)
    frame = read_polarization(result, highlight)
    polarized = frame.found
    psi, degree, light, confidence = map(
        Image.of, (polarized.psi, polarized.degree, polarized.light, polarized.confidence)
    )
    return PolarizationResult(frame.summary, psi, degree, light, confidence, frame.tags)


def depth_of(result: GoldenResult, near: float | None, far: float | None, disparities: int) -> DepthResult:
    """Depth of the scene of a frame in tof mode, from six read-outs of its four exposures. Raises ParameterError."""
    _check_mode(result, "tof", "depth")
    if far is not None:
        check_real("far", far, -20, 20)
    if near is not None:
        check_real("near", near, -20 if far is None else far, 20)
    check_int("disparities", disparities, 1, 500)
    request = result.request
    frames = capture(request, golden=not isinstance(result, FrameResult))
    depth = read_depth(frames, prior_of(frames.sums, near=near, far=far, disparities=disparities))
    light = np.clip(depth.field.taps.mean(0), 0, RADIANCE_MAX)
    disparity = depth.field.disparity
    return DepthResult(
        depth.summary,
        Image.of(depth.depth[depth.lead]),
        depth.sure[depth.lead],
        Image.of(disparity),
        None if depth.behind is None else Image.of(depth.behind),
        LightField(light, disparity, f"{request.name}_estimate"),
    )


def _check_mode(result: GoldenResult, mode: str, what: str) -> None:
    """Raise ParameterError for a frame of another mode."""
    actual = result.request.frame.mode
    if actual != mode:
        raise ParameterError(f"mode = {actual!r}: must be {mode!r}, for {what}")


def _shown(result: Any, *names: str) -> str:
    return table({name: result.summary[name] for name in names}) + embedded(result._repr_png_())

"""A frame: samples, bytes, figures, reconstructions."""

from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from talbot.api.image import Image, embedded, png, table
from talbot.api.light_field import LightField
from talbot.api.measured import DISPARITIES, DepthResult, PolarizationResult, depth_of, polarization_of
from talbot.api.run_file import read_run, write_run
from talbot.imaging.frame import outputs, pictures
from talbot.imaging.frame.figures import summarize, summarize_golden
from talbot.imaging.frame.light_field import SURE, estimate
from talbot.imaging.frame.result import FrameResult, GoldenResult
from talbot.models.parameters import SIGNED, ParameterError
from talbot.models.pixel import depth_of as depth_of_phase
from talbot.models.scene import RADIANCE_MAX

WHAT = {
    "edge": ("image", "edges"),
    "image": ("image",),
    "raw": ("image", "edges", "light_field", "disparity"),
    "tof": ("image", "depth"),
    "ternary": ("image", "edges"),
}
SHOWN = ("scene", "mode", "rows", "cols", "stream_bytes", "raw_bytes", "conversions_made", "conversions_left_out") + (
    *("snr_db", "image_psnr_db", "light_field_psnr_db", "cycles", "frame_s_at_clock", "stream_mismatches"),
)


class Run:
    """A frame that was read out, by the chip's Verilog or by the golden model.

    result: everything that was computed on the way (imaging/frame/result.py).
    """

    def __init__(self, result: GoldenResult) -> None:
        self.result = result

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the run in a file or folder that `save` wrote; equal to that one. Raises ParameterError.

        It has the samples and all that is computed of them; a scene that was rendered has its light field alone.
        """
        result, summary = read_run(Path(path))
        run = cls(result)
        run.summary = summary
        return run

    def save(self, path: str | Path) -> None:
        """Write it for `load`: a file, x.run, or, where the name has no suffix, a folder.

        The folder has stream.bin, decoded.npz, sensor.toml and summary.json of `make sim`, too. Runs can also be
        pickled and copied. Raises ParameterError where a pixel type has a function for a response, OSError.
        """
        write_run(Path(path), replace(self.result), self.summary)

    def __getstate__(self) -> dict[str, Any]:
        """Return the state to copy: the result without fields that can be computed again, and any figures."""
        kept = {"summary": self.summary} if "summary" in vars(self) else {}
        return {"result": replace(self.result)} | kept

    def __eq__(self, other: object) -> bool:
        """Return whether both are the same frame: chip or golden model, settings, scene, samples and bytes."""
        if not isinstance(other, Run):
            return NotImplemented
        mine, its = self.result, other.result
        return (
            type(mine) is type(its)
            and replace(mine.request, scene=mine.request.name) == replace(its.request, scene=its.request.name)
            and mine.stream == its.stream
            and np.array_equal(mine.exposed.samples, its.exposed.samples)
            and np.array_equal(mine.exposed.scene.image, its.exposed.scene.image)
        )

    def __hash__(self) -> int:
        return hash(self.stream)

    @property
    def samples(self) -> npt.NDArray[np.int16]:
        """The decoded samples, int16 (rows, cols, samples of a pixel), 0 where nothing is read.

        A pixel has 1 sample in edge mode (-128..127) and in image mode (0..255), 2 in raw mode (twice each diode), 4 in
        tof mode, or phase and amplitude.
        """
        return self.result.decoded.samples

    @property
    def read(self) -> npt.NDArray[np.bool_]:
        """Pixels that were read, bool (rows, cols)."""
        return self.result.decoded.read

    @property
    def stream(self) -> bytes:
        """The bytes that left the chip."""
        return self.result.stream

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The figures, as in summary.json of `make sim`; of the golden model without cycles and energy."""
        result = self.result
        return summarize(result) if isinstance(result, FrameResult) else summarize_golden(result)

    def reconstruct(
        self, what: str = "image", *, disparity: npt.ArrayLike | None = None, method: str | None = None
    ) -> Image | LightField:
        """Return what the samples show.

        image: 2-D, relative radiance, Image (rows, cols); rebuilt from differences (edge, ternary) of mean 0.
        edges (edge, ternary, raw): an image of differences a pixel type, in codes, Image (types, tile rows, tile cols).
        light_field (raw mode): LightField of linear radiance in as many views as the scene has; below 0 where noise and
        error take it there. It is without the scene's disparity: its `disparity()` is what its views show.
        disparity (raw mode): px of the array per view step, Image (rows, cols), NaN where the mixture is not sure.
        depth (tof mode): in m, Image (rows, cols), NaN where there is no amplitude.

        method: of a light field (imaging/lightfield/README.md), by the name that it has in `make lightfield` and in the
        summary of `make sim`: linear (the default), direct (the thesis's), sparse, autoencoder, convolutions,
        two_branch, mixture, layers. Of a decimated frame, and of more than 17 x 17 views, direct is the default.
        disparity: (rows, cols), px of the array per view step, for an image from edges; by default the scene's own.
        Raises ParameterError.
        """
        result, mode = self.result, self.result.request.frame.mode
        if what not in WHAT[mode]:
            raise ParameterError(f"what = {what!r}: must be one of {', '.join(WHAT[mode])} in {mode} mode")
        if disparity is not None and (what != "image" or mode not in SIGNED):
            raise ParameterError("disparity = an array: must be left out, it is of an image from edges")
        if method is not None and what != "light_field":
            raise ParameterError(f"method = {method!r}: must be left out, it is of a light field")
        if what == "disparity":
            estimated = estimate(result, "mixture")
            if estimated.disparity is None or estimated.spread is None:
                raise AssertionError("the mixture has a disparity")
            return Image.of(np.where(estimated.spread <= SURE, estimated.disparity, np.nan))
        if what == "light_field":
            method = method or result.light_field_method
            estimated = result.estimate if method == result.light_field_method else estimate(result, method)
            values = np.clip(estimated.light_field, -RADIANCE_MAX, RADIANCE_MAX)
            return LightField(values, name=f"{result.request.name}_{method}")
        if what == "edges":
            return Image.of(result.edges)
        if what == "depth":
            phase, strength = result.echo
            far = depth_of_phase(phase, result.request.sensor.electrical.f_mod)
            return Image.of(np.where(self.read & (strength > 0), far, np.nan))
        if disparity is not None:
            scene = replace(result.exposed.scene, disparity=np.asarray(disparity, float))
            result = replace(result, exposed=replace(result.exposed, scene=scene))
        return Image.of(result.image)

    def polarization(self, highlight: float = 0.1) -> PolarizationResult:
        """Angle and degree of linear polarization at every pixel, and highlights, of a raw frame; as `make polar`.

        highlight: polarized light of one, of white, 0..16. The frame may be of any part of the array. Its summary has
        the errors against the scene, where that is polarized. Raises ParameterError in other modes.
        """
        return polarization_of(self.result, highlight)

    def depth(self, near: float | None = None, far: float | None = None, disparities: int = DISPARITIES) -> DepthResult:
        """Depth in m at every pixel of a frame in tof mode, its whole turns found by the light field; as `make depth`.

        The exposure of the frame is read out six times, by the chip's Verilog where the run was: seconds to minutes.
        near, far: disparities that are tried, far..20 and -20..20 px per view step, of which a depth beyond them is not
        sure; disparities: how many, 1..500. For a room, a lens of life size: talbot.Sensor(scale=1, focus=3,
        focal_length=25e-3, f_mod=100e6). Raises ParameterError in other modes, and for a part of the array.
        """
        return depth_of(self.result, near, far, disparities)

    def __repr__(self) -> str:
        s = self.summary
        by = "the chip's Verilog" if isinstance(self.result, FrameResult) else "the golden model"
        return f"<Run of {s['scene']} in {s['mode']} mode by {by}: {s['rows']} x {s['cols']}, {len(self.stream)} bytes>"

    def _repr_png_(self) -> bytes:
        shown = outputs.shown(self.result, self.summary)
        return png(pictures.overview([(picture.name, picture.image) for picture in shown]))

    def _repr_html_(self) -> str:
        figures = {name: self.summary[name] for name in SHOWN if name in self.summary}
        return table(figures) + embedded(self._repr_png_())

"""Streams of the chip back to samples."""

from pathlib import Path

import numpy as np

from talbot.api.image import png
from talbot.api.sensor import Sensor
from talbot.imaging.decode import describe
from talbot.imaging.frame import pictures
from talbot.models.digital import stream
from talbot.models.digital.stream.frame import DecodedFrame as Decoded
from talbot.models.parameters import TileParameters


class DecodedFrame(Decoded):
    """One frame of a stream: header, samples (int16 (rows, cols, samples of a pixel)), read (bool (rows, cols)),
    bad_rows, made and left_out (conversions), errors (a line each); complete where nothing is lost; save(file.npz)."""

    def __repr__(self) -> str:
        return f"<{describe(self)}>"

    def _repr_png_(self) -> bytes:
        images, edge = self.samples.astype(float).transpose(2, 0, 1), self.header.edge
        top = max(float(np.abs(images).max()), 1.0)
        shown = [pictures.signed(image, top) if edge else pictures.gray(image, 0, top) for image in images]
        return png(pictures.overview([(f"sample {i}", picture) for i, picture in enumerate(shown)]))


def decode(source: str | Path | bytes, sensor: Sensor | None = None) -> list[DecodedFrame]:
    """Return the frames of a stream, at least one; damage is in each frame's bad_rows and errors.

    source: a file, as stream.bin of a run or captured from a chip, or the bytes. sensor: of the chip, for its tile, or
    None for the thesis's. Raises ParameterError where there is no frame, OSError.
    """
    tile = TileParameters() if sensor is None else sensor.parameters.tile
    frames = stream.decode_stream(source, tile) if isinstance(source, bytes) else stream.decode_file(source, tile)
    return [DecodedFrame(**vars(frame)) for frame in frames]

"""Videos as players show them: turned by the display matrix, at their presentation times, edit lists applied.

A video is decoded twice: when it is opened, to refuse a damaged one before anything is simulated and for the time of
each frame, and when its frames are read.
"""

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError
from talbot.models.scene import resample
from talbot.models.scene.picture_file import luminance_of
from talbot.models.scene.pixels import Pixels, over_white
from talbot.models.scene.sampling import Sampling

VIDEOS = (".mp4", ".m4v", ".mov", ".mkv", ".webm", ".avi", ".ts", ".mts", ".m2ts", ".wmv", ".3gp", ".3g2", ".ogv")
VIDEOS += (".flv", ".mpg", ".mpeg", ".vob", ".asf", ".mxf", ".y4m")
RATE = 30.0  # frames a second, where a file does not say
COVER = 1 << 10  # disposition of a picture that comes with sound
HDR = {16: "PQ", 18: "HLG"}  # transfer characteristics
ALPHA = {"vp8": "libvpx", "vp9": "libvpx-vp9"}  # decoders that read the alpha of WebM
ASPECT_MAX = 10  # of a pixel, or its inverse


class Video:
    """A video that can be decoded to its end.

    path: the file. seconds: how long each frame is shown. Raises ParameterError without the package av, and for a video
    that is damaged, has no frames, or is HDR.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        times, rate, last = [], RATE, 0.0
        with self._stream() as (stream, frames):
            rate = float(stream.average_rate or RATE)
            for number, frame in enumerate(frames):
                times.append(number / rate if frame.time is None else frame.time)
                last = float((frame.duration or 0) * frame.time_base)
                if frame.color_trc in HDR:
                    raise self._refused(
                        f"is HDR ({HDR[frame.color_trc]}): must be SDR; convert it with ffmpeg's tonemap"
                    )
        if not times:
            raise self._refused("the video is damaged (no frame)")
        steps = [after - before for before, after in pairwise(times)]
        steps.append(last or (steps[-1] if steps else 0))
        self.seconds = [step if step > 0 else 1 / rate for step in steps]

    def read(self, sampling: Sampling) -> Iterator[npt.NDArray[np.floating]]:
        """Decode the frames.

        sampling: array; much larger pictures are reduced. Yields (height, width): linear luminance, 0..1, of square
        pixels, upright. Raises ParameterError if the video is damaged.
        """
        with self._stream() as (stream, frames):
            aspect = float(stream.sample_aspect_ratio or 1)
            for frame in frames:
                light = luminance_of(_pixels(frame), self.path, *sampling.shape)
                if 1 / ASPECT_MAX <= aspect <= ASPECT_MAX and aspect != 1:
                    height, width = light.shape
                    light = resample.resize(light, height, max(1, round(width * aspect))).clip(0, 1)
                yield _turned(light, frame)

    @contextmanager
    def _stream(self) -> Iterator[tuple[Any, Iterator[Any]]]:
        """The video stream and its frames."""
        try:
            import av
            from av.error import FFmpegError
        except ModuleNotFoundError:
            raise self._refused("a video needs the package av: pip install 'talbot[video]'") from None
        try:
            with av.open(str(self.path)) as container:
                stream = container.streams.best("video")
                if not len(container.streams):
                    raise self._refused("the video is damaged (no stream)")
                if stream is None or int(stream.disposition) & COVER:
                    raise self._refused("must have a video stream")
                self._check_length(stream)
                decoder = stream.codec_context
                if stream.metadata.get("alpha_mode") == "1" and decoder.name in ALPHA:
                    decoder = av.CodecContext.create(ALPHA[decoder.name], "r")
                decoder.options = {"err_detect": "explode"}  # damage is an error, not a guess
                yield stream, self._frames(container, stream, decoder)
        except FFmpegError as error:
            raise self._refused(f"the video is damaged ({error.strerror})") from None

    def _frames(self, container: Any, stream: Any, decoder: Any) -> Iterator[Any]:
        for packet in container.demux(stream):
            if packet.is_corrupt:
                raise self._refused("the video is damaged (a packet is incomplete)")
            for frame in decoder.decode(packet):
                if frame.is_corrupt:
                    raise self._refused("the video is damaged (a frame is incomplete)")
                yield frame

    def _check_length(self, stream: Any) -> None:
        """Refuse a file that ends before what its header and index promise."""
        size = self.path.stat().st_size
        with self.path.open("rb") as file:
            ends = [_declared_end(file.read(4096))]
        ends += [entry.pos + entry.size for entry in stream.index_entries]
        if max(ends) > size:
            raise self._refused(f"the video is damaged (of {max(ends)} bytes {size} are there)")

    def _refused(self, why: str) -> ParameterError:
        return ParameterError(f"scene = {str(self.path)!r}: {why}")


def _declared_end(head: bytes) -> int:
    """Length in bytes that the header of an AVI or a Matroska file says, 0 where none does."""
    if head.startswith(b"RIFF"):
        return 8 + struct.unpack("<I", head[4:8])[0]
    segment = head.find(b"\x18\x53\x80\x67") + 4
    if not head.startswith(b"\x1aE\xdf\xa3") or segment < 4 or segment + 8 > len(head):
        return 0
    digits = 9 - head[segment].bit_length()
    length = int.from_bytes(head[segment : segment + digits]) & ((1 << 7 * digits) - 1)
    return 0 if length == (1 << 7 * digits) - 1 else segment + digits + length


def _pixels(frame: Any) -> Pixels:
    """Return a frame as codes of 8 or 16 bits, on white."""
    parts = frame.format.components
    deep, clear = max(part.bits for part in parts) > 8, any(part.is_alpha for part in parts)
    white = 65535.0 if deep else 255.0
    name = ("rgba64le" if deep else "rgba") if clear else ("rgb48le" if deep else "rgb24")
    codes = frame.to_ndarray(format=name)
    return Pixels(over_white(codes[..., :3], codes[..., 3] / white, white) if clear else codes, white)


def _turned(light: npt.NDArray[np.floating], frame: Any) -> npt.NDArray[np.floating]:
    """Return a picture as the display matrix turns and mirrors it, in quarters of a turn."""
    matrix = next((bytes(part) for part in frame.side_data if part.type.name == "DISPLAYMATRIX"), b"")
    if len(matrix) < 36:
        return light
    a, b, _, c, d = struct.unpack("<5i", matrix[:20])
    if abs(b) > abs(a):
        light, a, d = light.T, c, b
    return light[:: -1 if d < 0 else 1, :: -1 if a < 0 else 1]

"""Videos as players show them: turned by the display matrix, at their presentation times, edit lists applied.

A video is decoded twice: when it is opened, to refuse a damaged one before anything is simulated and for the time of
each frame, and when its frames are read.
"""

import re
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import Any, BinaryIO

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
HEAD, TAIL = 4096, 1 << 17  # bytes; a page of Ogg has at most 65307
ASF_FILE = bytes.fromhex("a1dcab8c47a9cf118ee400c00c205365")  # File Properties Object
MXF_HEADER = rb"(?s)\x06\x0e\x2b\x34\x02\x05\x01\x01\x0d\x01\x02\x01\x01\x02.\0(\x83.{3}|[\0-\x7f])"
BOXES = {b"ftyp", b"moov", b"moof", b"mdat", b"mfra", b"sidx", b"styp", b"free", b"skip", b"wide", b"udta", b"meta"}
PACKETS = 188, 192, 204  # bytes of a transport stream's packet, with the time of Blu-ray and AVCHD, with parity


class Video:
    """A video that can be decoded to its end.

    path: the file. seconds: how long each frame is shown. Raises ParameterError without the package av, and for a video
    that is damaged, has no frames, or is HDR.
    """

    def __init__(self, path: Path) -> None:
        self.path, self._last = path, (0, 0)
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
        if self._breaks_off():
            raise self._refused(f"the video is damaged (the file ends early; frames read: {len(times)})")
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
            if packet.size:
                self._last = packet.pos or 0, packet.size
            for frame in decoder.decode(packet):
                if frame.is_corrupt:
                    raise self._refused("the video is damaged (a frame is incomplete)")
                yield frame

    def _check_length(self, stream: Any) -> None:
        """Refuse a file that ends before what its header and index promise."""
        size = self.path.stat().st_size
        with self.path.open("rb") as file:
            ends = [_declared_end(file, size)]
        ends += [entry.pos + entry.size for entry in stream.index_entries]
        if max(ends) > size:
            raise self._refused(f"the video is damaged (of {max(ends)} bytes {size} are there)")

    def _breaks_off(self) -> bool:
        """Return whether a file without such a promise ends within a frame or a packet, which FFmpeg leaves out."""
        size = self.path.stat().st_size
        with self.path.open("rb") as file:
            head = file.read(HEAD)
        if head.startswith(b"YUV4MPEG2"):
            return sum(self._last) != size
        for length in PACKETS:
            if found := re.search(rb"(?s)(?=G.{%d}G.{%d}G)" % (length - 1, length - 1), head):
                before = 4 * (length == 192)  # its time
                return (size - found.start() + before) % length != 0
        return False

    def _refused(self, why: str) -> ParameterError:
        return ParameterError(f"scene = {str(self.path)!r}: {why}")


def _declared_end(file: BinaryIO, size: int) -> int:
    """Length in bytes of an AVI, ASF, Matroska, MP4, MXF or Ogg file by its own parts, 0 where none says it."""
    head = file.read(HEAD)
    if head.startswith(b"RIFF"):
        return 8 + struct.unpack("<I", head[4:8])[0]
    if (place := head.find(ASF_FILE)) > 0 and len(head) >= place + 92:
        length, flags = struct.unpack_from("<Q", head, place + 40)[0], head[place + 88]
        return 0 if flags & 1 else length  # it was a broadcast
    if (found := re.match(MXF_HEADER, head)) and len(head) >= found.end() + 32:
        return 1 + struct.unpack_from(">Q", head, found.end() + 24)[0]  # where the footer begins
    if head[4:8] in BOXES:
        return _end_of_boxes(file, size)
    if head.startswith(b"OggS"):
        file.seek(max(0, size - TAIL))
        tail = file.read()
        page = max(0, tail.rfind(b"OggS"))
        lengths = tail[page + 27 : page + 27 + tail[page + 26]] if len(tail) > page + 26 else b""
        return size - len(tail) + page + 27 + len(lengths) + sum(lengths)
    segment = head.find(b"\x18\x53\x80\x67") + 4
    if not head.startswith(b"\x1aE\xdf\xa3") or segment < 4 or segment + 8 > len(head):
        return 0
    digits = 9 - head[segment].bit_length()
    length = int.from_bytes(head[segment : segment + digits]) & ((1 << 7 * digits) - 1)
    return 0 if length == (1 << 7 * digits) - 1 else segment + digits + length


def _end_of_boxes(file: BinaryIO, size: int) -> int:
    """Where the last of an MP4 file's boxes ends; something else behind them does not count."""
    end = 0
    while end < size:
        file.seek(end)
        head = file.read(16)
        if head[4:8] not in BOXES:
            break
        length = struct.unpack(">I", head[:4])[0]
        if length == 1 and len(head) == 16:
            length = struct.unpack(">Q", head[8:])[0]
        if length < 8:  # to the end of the file
            break
        end += length
    return end


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

"""Sequences of pictures, read one by one: a folder of frames, an animated GIF, WebP, PNG or AVIF, a video, arrays."""

import re
from collections.abc import Callable, Iterable, Iterator, Sized
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError

from .light_field import LightField
from .picture_file import frames_of, loaded, luminance_of, opened, undamaged
from .sampling import Sampling

VIDEOS = ".mp4", ".m4v", ".mov", ".mkv", ".webm", ".avi"
RATE = 30.0  # frames a second, where a file does not say
SHORTEST = 0.02  # s that a frame is shown: browsers take less, in a GIF, for "not said"

Luminance = npt.NDArray[np.floating]


class Frame(NamedTuple):
    """A frame of a clip.

    Attributes
    ----------
    luminance : float (height, width)
        Linear, 1 = diffuse white.
    seconds : float
        How long it is shown.
    """

    luminance: Luminance
    seconds: float


@dataclass(frozen=True, eq=False)
class Clip:
    """A sequence of pictures; its frames are read when they are asked for.

    Attributes
    ----------
    name : str
        Name in reports.
    count : int or None
        Number of frames, None where only reading tells.
    read : callable
        Gives the frames. Raises ParameterError for what cannot be read, and for a frame of another size.
    """

    name: str
    count: int | None
    read: Callable[[], Iterator[Frame]]

    def __iter__(self) -> Iterator[Frame]:
        """The frames, from the first."""
        first = None
        for number, frame in enumerate(self.read()):
            first = first or frame.luminance.shape
            if frame.luminance.shape != first:
                shape, wanted = (f"{height} x {width}" for height, width in (frame.luminance.shape, first))
                raise ParameterError(f"scene {self.name}, frame {number} = {shape}: must be as frame 0, {wanted}")
            yield frame


def open_clip(source: str | Path | Iterable[npt.ArrayLike], sampling: Sampling) -> Clip:
    """Open a sequence of pictures.

    Parameters
    ----------
    source : path or iterable of arrays
        A folder of pictures of one kind and size in the order of their numbers, an animated picture, or a video; or
        arrays (height, width) or (height, width, 3): uint8 and uint16 are sRGB codes, floats linear radiance, 0..16.
    sampling : Sampling
        Array; much larger pictures are reduced.

    Returns
    -------
    Clip
        The sequence.

    Raises
    ------
    ParameterError
        For what is missing, damaged or no sequence, and for a video without the package av.
    """
    if not isinstance(source, str | Path | Iterable):
        raise ParameterError(f"frames = {source!r}: must be a folder, an animated picture, a video, or arrays")
    if not isinstance(source, str | Path):
        count = len(source) if isinstance(source, Sized) else None
        if count == 0:
            raise ParameterError("frames = []: must be one array or more")
        return Clip("frames", count, lambda: (Frame(_of_array(values), 1 / RATE) for values in source))
    path = Path(source)
    if path.is_dir():
        return _folder(path, sampling)
    if path.suffix.lower() in VIDEOS and path.is_file():
        return _video(path, sampling)
    return _animated(path, sampling)


def _of_array(values: npt.ArrayLike) -> Luminance:
    array = np.asarray(values)
    if array.ndim not in (2, 3):
        raise ParameterError(f"frame = array of shape {array.shape}: must be (height, width), or with 3 colours behind")
    return LightField(array[None, None]).view(0, 0)


def _folder(path: Path, sampling: Sampling) -> Clip:
    files = sorted((entry for entry in path.iterdir() if not entry.name.startswith(".")), key=_numbers)
    if not files:
        raise ParameterError(f"scene = {str(path)!r}: must hold the frames, pictures of one kind; it is empty")
    kinds = sorted({entry.suffix.lower() if entry.is_file() else f"folder {entry.name}" for entry in files})
    if len(kinds) > 1:
        raise ParameterError(f"scene = {str(path)!r}: must hold pictures of one kind, has {', '.join(kinds[:5])}")
    size = None
    for entry in files:  # before anything is simulated: of pictures the header alone is read
        with opened(entry, "scene") as picture:
            size = size or picture.size
            if picture.size != size or frames_of(picture, entry) > 1:
                has = f"{picture.height} x {picture.width} px, frames {frames_of(picture, entry)}"
                raise ParameterError(f"scene = {str(entry)!r}: {has}: must be one of {size[1]} x {size[0]} px")

    def _read() -> Iterator[Frame]:
        for entry in files:
            with opened(entry, "scene") as picture:
                yield Frame(luminance_of(loaded(picture, entry, "scene"), entry, *sampling.shape), 1 / RATE)

    return Clip(path.resolve().name, len(files), _read)


def _numbers(path: Path) -> list[tuple[int, str]]:
    """Sorting key: frame2 comes before frame10."""
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in re.split(r"(\d+)", path.name)]


def _animated(path: Path, sampling: Sampling) -> Clip:
    with opened(path, "scene") as picture:
        count = frames_of(picture, path)
    if count < 2:
        raise ParameterError(f"scene = {str(path)!r}: has one frame: must have more; make sim takes one picture")

    def _read() -> Iterator[Frame]:
        with opened(path, "scene") as picture:
            for number in range(count):
                with undamaged("scene", path, f"frame {number}"):
                    picture.seek(number)
                luminance = luminance_of(loaded(picture, path, "scene"), path, *sampling.shape)
                seconds = float(picture.info.get("duration") or 0) / 1000
                yield Frame(luminance, seconds if seconds >= SHORTEST else 1 / RATE)

    return Clip(path.stem, count, _read)


def _video(path: Path, sampling: Sampling) -> Clip:
    try:
        import av
        from av.error import FFmpegError
    except ModuleNotFoundError:
        raise ParameterError(
            f"scene = {str(path)!r}: a video needs the package av: pip install 'talbot[video]'"
        ) from None

    @contextmanager
    def _stream() -> Iterator[Any]:
        try:
            with av.open(str(path)) as container:
                if not container.streams.video:
                    raise ParameterError(f"scene = {str(path)!r}: must have a video stream")
                yield container.streams.video[0]
        except FFmpegError as error:
            raise ParameterError(f"scene = {str(path)!r}: the video is damaged ({error.strerror})") from None

    with _stream() as stream:
        count = stream.frames or None

    def _read() -> Iterator[Frame]:
        with _stream() as stream:
            stream.codec_context.options = {"err_detect": "explode"}  # damage is an error, not a guess
            seconds, found = 1 / float(stream.average_rate or RATE), 0
            for picture in stream.container.decode(stream):
                codes = picture.to_image()
                yield Frame(luminance_of(codes, path, *sampling.shape), seconds)
                found += 1
            if found < (count or 1):
                raise ParameterError(f"scene = {str(path)!r}: the video is damaged ({found} of {count or 1} frames)")

    return Clip(path.stem, count, _read)

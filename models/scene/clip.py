"""Sequences of pictures, read one by one: a folder of frames, an animation, a TIFF stack, a video, arrays."""

import re
from collections.abc import Callable, Iterable, Iterator, Sized
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError
from talbot.models.scene.file_form import is_video
from talbot.models.scene.light_field import LightField
from talbot.models.scene.picture_file import header_of, luminance_of, read_frames, read_pixels
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.video_file import RATE, VIDEOS, Video

SAME = {".jpeg": ".jpg", ".jpe": ".jpg", ".jfif": ".jpg", ".tiff": ".tif"}  # suffixes of one kind of picture
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
        """Yield the frames, from the first."""
        first = None
        for number, frame in enumerate(self.read()):
            first = first or frame.luminance.shape
            if frame.luminance.shape != first:
                shape, expected = (f"{height} x {width}" for height, width in (frame.luminance.shape, first))
                raise ParameterError(f"scene {self.name}, frame {number} = {shape}: must be as frame 0, {expected}")
            yield frame


def open_clip(source: str | Path | Iterable[npt.ArrayLike], sampling: Sampling) -> Clip:
    """Open a sequence of pictures.

    source: path or iterable of arrays, a folder of pictures of one kind and size in the order of their numbers, an
    animated picture, or a video; or arrays (height, width) or (height, width, 3): uint8 and uint16 are sRGB codes,
    floats linear radiance, 0..16. sampling: array; much larger pictures are reduced. Returns Clip: the sequence. Raises
    ParameterError for what is missing, damaged or no sequence, and for a video without the package av.
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
    if path.is_file() and (path.suffix.lower() in VIDEOS or is_video(path)):
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
    kinds = sorted({_kind(entry) if entry.is_file() else f"folder {entry.name}" for entry in files})
    if len(kinds) > 1:
        raise ParameterError(f"scene = {str(path)!r}: must hold pictures of one kind, has {', '.join(kinds[:5])}")
    shape = None
    for entry in files:  # before anything is simulated: of pictures the header alone is read
        header = header_of(entry, "scene")
        shape = shape or header.shape
        if header.shape != shape or header.frames > 1:
            height, width = header.shape
            raise ParameterError(
                f"scene = {str(entry)!r}: {height} x {width} px, frames {header.frames}: "
                f"must be one of {shape[0]} x {shape[1]} px"
            )

    def _read() -> Iterator[Frame]:
        for entry in files:
            pixels = read_pixels(entry, "scene", sampling.shape)
            yield Frame(luminance_of(pixels, entry, *sampling.shape), 1 / RATE)

    return Clip(path.resolve().name, len(files), _read)


def _kind(path: Path) -> str:
    suffix = path.suffix.lower()
    return SAME.get(suffix, suffix)


def _numbers(path: Path) -> list[tuple[int, str]]:
    """Sorting key: frame2 comes before frame10."""
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in re.split(r"(\d+)", path.name)]


def _animated(path: Path, sampling: Sampling) -> Clip:
    count = header_of(path, "scene").frames
    if count < 2:
        raise ParameterError(f"scene = {str(path)!r}: has one frame: must have more; make sim takes one picture")

    def _read() -> Iterator[Frame]:
        for pixels, seconds in read_frames(path, "scene"):
            luminance = luminance_of(pixels, path, *sampling.shape)
            yield Frame(luminance, seconds if seconds >= SHORTEST else 1 / RATE)

    return Clip(path.stem, count, _read)


def _video(path: Path, sampling: Sampling) -> Clip:
    video = Video(path)

    def _read() -> Iterator[Frame]:
        yield from map(Frame, video.read(sampling), video.seconds)

    return Clip(path.stem, len(video.seconds), _read)

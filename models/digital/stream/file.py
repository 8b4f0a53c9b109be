"""A stream in a file to arrays in files."""

from pathlib import Path

from models.parameters import TileParameters

from .decode import decode_stream
from .header import StreamError


def decode_file(path, out=None, tile=TileParameters()):
    """Decode a file; returns a list of DecodedFrame.

    out: npz file to write; with several frames their number goes before the suffix: x.npz, x-1.npz, x-2.npz.
    Raises StreamError, its message naming the file, or OSError when a file cannot be read or written.
    """
    with open(path, "rb") as file:
        try:
            frames = decode_stream(file.read(), tile)
        except StreamError as error:
            raise StreamError(f"file = {path}: {error}") from None
    if out is not None:
        out = Path(out)
        for i, frame in enumerate(frames):
            frame.save(out.with_name(f"{out.stem}-{i}{out.suffix}") if i else out)
    return frames

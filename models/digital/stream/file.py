"""From a stream in a file to arrays in files."""

from pathlib import Path

from models.parameters import TileParameters

from .decode import decode_stream
from .frame import DecodedFrame
from .header import StreamError


def decode_file(
    path: str | Path, out: str | Path | None = None, tile: TileParameters = TileParameters()
) -> list[DecodedFrame]:
    """Decode a file.

    Parameters
    ----------
    path : path
        The stream.
    out : path, optional
        npz file to write; with several frames their number precedes the suffix: x.npz, x-1.npz, x-2.npz.
    tile : TileParameters
        The sensor's tile.

    Returns
    -------
    list of DecodedFrame
        At least one.

    Raises
    ------
    StreamError
        If there is no frame; the message names the file.
    OSError
        If a file cannot be read or written.
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

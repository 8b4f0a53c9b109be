"""A stream in a file."""

from pathlib import Path

from talbot.models.digital.stream.decode import decode_stream
from talbot.models.digital.stream.frame import DecodedFrame
from talbot.models.digital.stream.header import StreamError
from talbot.models.parameters import TileParameters


def decode_file(path: str | Path, tile: TileParameters = TileParameters()) -> list[DecodedFrame]:
    """Decode a file.

    path: the stream. tile: the sensor's tile. Returns list of DecodedFrame: at least one. Raises StreamError if there
    is no frame; the message names the file. Raises OSError if the file cannot be read.
    """
    if Path(path).is_char_device():  # some never end
        raise StreamError(f"file = {path}: must be a file, not a device")
    with open(path, "rb") as file:
        try:
            return decode_stream(file.read(), tile)
        except StreamError as error:
            raise StreamError(f"file = {path}: {error}") from None

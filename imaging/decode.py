"""A byte stream of the chip back to samples: FILE.npz, and a further file for each further frame."""

from argparse import ArgumentParser, Namespace
from collections.abc import Iterable
from pathlib import Path

from talbot.base.files import atomic, check_file
from talbot.base.sensor import Varied, add_sensor, sensor_asked
from talbot.models.digital.stream import decode_file
from talbot.models.digital.stream.frame import DecodedFrame
from talbot.models.digital.stream.header import StreamHeader
from talbot.models.parameters import ParameterError, SensorParameters, TileParameters

VARIED = Varied(used=("array.rows", "array.cols", "tile.rows", "tile.cols", "tile.order", "chip.lanes"))


def add_arguments(parser: ArgumentParser) -> None:
    """Arguments of `talbot decode`."""
    parser.add_argument("file", type=Path, help="stream.bin of a run, or captured from a chip")
    add_sensor(parser)
    parser.add_argument("--out", type=Path, help="the .npz; further frames: X-1.npz ... (default: next to FILE)")


def run(options: Namespace) -> int:
    """Decode the file and print a line for each frame; 1 where a frame is damaged, corrected or not."""
    out = options.out or options.file.with_suffix(".npz")
    check_file("out", out)
    if out.exists() and options.file.exists() and out.samefile(options.file):
        raise ParameterError(f"out = {str(out)!r}: must not be the stream itself")
    sensor = sensor_asked(options, VARIED) if options.sensor else None  # without a file any size with the default tile
    frames = decode_to(options.file, out, sensor.tile if sensor else TileParameters(), sensor)
    for frame in frames:
        print(describe(frame))
    print(f"written: {out}")
    return 0 if all(frame.complete and not frame.errors for frame in frames) else 1


def decode_to(
    path: Path, out: Path, tile: TileParameters = TileParameters(), sensor: SensorParameters | None = None
) -> list[DecodedFrame]:
    """Decode the stream in ``path`` and write each frame: ``out`` = x.npz, then x-1.npz, x-2.npz, each atomically.

    sensor: of the chip; None for any with this tile. Raises StreamError where there is no frame,
    ParameterError for a frame of another sensor, OSError.
    """
    frames = decode_file(path, tile)
    if sensor:
        for frame in frames:
            check_header(frame.header, sensor)
    for i, frame in enumerate(frames):
        with atomic(out.with_name(f"{out.stem}-{i}{out.suffix}") if i else out) as part:
            frame.save(part)
    return frames


def check_header(header: StreamHeader, sensor: SensorParameters) -> None:
    """Raise ParameterError where a frame is not of ``sensor``."""
    for field, value, sent in (
        ("array.rows", sensor.array.rows, header.rows),
        ("array.cols", sensor.array.cols, header.cols),
        ("chip.lanes", sensor.chip.lanes, header.lanes),
    ):
        if value != sent:
            raise ParameterError(f"{field} = {value}: must be {sent}, as in the header of frame {header.frame_number}")


def describe(frame: DecodedFrame) -> str:
    """Return a line: the frame's header, its damage, and its counts."""
    h, rows = frame.header, frame.layout.rows.size
    wrong = [*frame.errors, *([f"bad rows: {ranges(frame.bad_rows)}"] if frame.bad_rows else [])]
    counts = "counts lost" if frame.made is None else f"{frame.made} conversions, {frame.left_out} left out"
    return (
        f"frame {h.frame_number}: {h.mode}, {h.rows} x {h.cols}, {'; '.join(wrong) or 'complete'}; threshold "
        f"{h.threshold}, {rows - len(frame.bad_rows)} of {rows} rows, {counts}, {frame.stop - frame.start} bytes"
    )


def ranges(numbers: Iterable[int]) -> str:
    """Sorted integers in short: '3-7, 9', or 'none'."""
    runs: list[list[int]] = []
    for n in map(int, numbers):
        if runs and n == runs[-1][1] + 1:
            runs[-1][1] = n
        else:
            runs.append([n, n])
    return ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in runs) or "none"

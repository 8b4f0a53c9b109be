"""Checks of the decoder's result for any input."""

import contextlib
import io
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from talbot.base.command import main
from talbot.imaging import decode
from talbot.models.digital.stream import DecodedFrame, StreamError, decode_stream
from talbot.models.parameters import TileParameters
from talbot.verif.fuzz.streams import Case, Sent


class Broken(AssertionError):
    """A result is not what the decoder promises; one line."""


def demand(holds: object, text: str) -> None:
    """Raise Broken with ``text`` unless ``holds``."""
    if not holds:
        raise Broken(text)


def check_stream(case: Case) -> list[DecodedFrame]:
    """Decode a Case; returns its frames, [] for a StreamError. Raises Broken or the decoder's exception."""
    try:
        frames = decode_stream(case.data, case.tile)
    except StreamError as error:
        demand("\n" not in str(error) and str(error), f"the StreamError is no line: {error!r}")
        demand(case.sent is None, f"a frame with at most one wrong byte is refused: {error}")
        return []
    demand(frames, "neither frames nor a StreamError")
    at = 0
    for frame in frames:
        _check_frame(frame, at, len(case.data))
        at = frame.stop
    if case.sent:
        _check_survived(case, case.sent, frames)
    return frames


def _check_frame(frame: DecodedFrame, at: int, size: int) -> None:
    header, rows = frame.header, frame.layout.rows.tolist()
    demand(at <= frame.start < frame.stop <= size, f"bytes {frame.start}..{frame.stop} after {at}, of {size}")
    demand(frame.samples.shape == (header.rows, header.cols, header.subs), f"samples are {frame.samples.shape}")
    demand(
        set(frame.bad_rows) <= set(rows) and frame.bad_rows == sorted(set(frame.bad_rows)),
        f"bad rows {frame.bad_rows} of {rows}",
    )
    demand(frame.complete or frame.errors, "incomplete without an error")
    unread = np.ones(header.rows, bool)
    unread[rows] = False
    unread[frame.bad_rows] = True
    demand(not frame.samples[unread].any(), "samples in a row that is bad or was not sent")
    if header.edge and frame.samples.size:
        low, high = (-1, 1) if header.mode == "ternary" else (-128, 127)
    else:
        low, high = 0, 255
    demand(frame.samples.min() >= low and frame.samples.max() <= high, "samples out of their range")


def _check_survived(case: Case, sent: Sent, frames: Sequence[DecodedFrame]) -> None:
    demand(len(frames) == 1, f"{len(frames)} frames of one")
    frame = frames[0]
    demand(frame.header == sent.header, "another header")
    demand(frame.complete, f"incomplete: {frame.errors}")
    demand(np.array_equal(frame.samples, sent.samples), "other samples than were sent")
    demand(bool(frame.errors) == (case.data != sent.data), f"errors reported: {frame.errors}")


def check_file(case: Case, frames: Sequence[DecodedFrame]) -> None:
    """Decode a Case through a file, `decode_to` and the command: same result, one line per error. Raises Broken."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        source, out = Path(folder) / "stream.bin", Path(folder) / "decoded.npz"
        source.write_bytes(case.data)
        try:
            again = decode.decode_to(source, out, case.tile)
        except StreamError as error:
            demand(not frames and str(source) in str(error), f"decode_to refuses what decode_stream reads: {error}")
        else:
            demand(len(again) == len(frames), "decode_to and decode_stream differ")
            names = [out.name] + [f"decoded-{i}.npz" for i in range(1, len(frames))]
            demand(sorted(p.name for p in Path(folder).glob("*.npz")) == sorted(names), "files are missing")
            for name, frame in zip(names, frames, strict=True):
                with np.load(out.with_name(name)) as archive:
                    demand(np.array_equal(archive["samples"], frame.samples), f"{name} holds other samples")
        if case.tile == TileParameters():
            _check_command(source, frames)


def _check_command(source: Path, frames: Sequence[DecodedFrame]) -> None:
    output, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        status = main(decode, [str(source)])
    expected = 2 if not frames else int(not all(frame.complete and not frame.errors for frame in frames))
    demand(status == expected, f"exit status {status}, not {expected}")
    demand(len(output.getvalue().splitlines()) == len(frames) + bool(frames), "not one line per frame")
    demand(status != 2 or errors.getvalue().count("\n") == 1, "an error of more than one line")

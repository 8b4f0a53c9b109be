"""python -m models.digital.stream FILE [--out X.npz]: decode a byte stream of the chip."""

import argparse
import sys

from . import StreamError, decode_file


def main(argv=None):
    """Decode a file and say what was in it; returns 0, 1 when something was damaged, 2 when there is no frame."""
    parser = argparse.ArgumentParser(prog="python -m models.digital.stream", description=__doc__)
    parser.add_argument("file", help="the bytes that left the chip")
    parser.add_argument("--out", metavar="X.npz", help="write the samples here (frames after the first: X-1.npz, ...)")
    args = parser.parse_args(argv)
    try:
        frames = decode_file(args.file, args.out)
    except StreamError as error:
        return _fail(error)
    except OSError as error:
        return _fail(f"{error.filename or args.out or args.file}: {error.strerror}")
    for frame in frames:
        print(_describe(frame))
        for error in frame.errors:
            print(f"  {error}", file=sys.stderr)
    return 1 if any(frame.errors for frame in frames) else 0


def _fail(message):
    print(f"error: {message}", file=sys.stderr)
    return 2


def _describe(frame):
    header, rows = frame.header, frame.layout.rows.size
    counts = "counts lost" if frame.made is None else f"{frame.made} conversions, {frame.left_out} left out"
    return (
        f"frame {header.frame_number}: {header.mode}, {header.rows} x {header.cols}, threshold {header.threshold}, "
        f"{rows - len(frame.bad_rows)} of {rows} rows, {counts}, {frame.stop - frame.start} bytes"
    )


if __name__ == "__main__":
    sys.exit(main())

"""One decoded frame, and the file it is kept in."""

import dataclasses
import json
import os
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .header import Layout, StreamHeader


@dataclass(eq=False)
class DecodedFrame:
    """What the decoder found of one frame.

    header: StreamHeader. samples: int16 (rows, cols, header.subs), zero where nothing was read or its row is bad.
    bad_rows: rows that were sent but are damaged or missing, ascending. made, left_out: conversions, or None when
    the trailer is lost. errors: one line for each thing that was wrong, mended or not. start, stop: its bytes.
    """

    header: StreamHeader
    samples: np.ndarray
    layout: Layout
    start: int
    stop: int = 0
    bad_rows: list = field(default_factory=list)
    made: int | None = None
    left_out: int | None = None
    errors: list = field(default_factory=list)

    @property
    def complete(self):
        """True when every row and the trailer's counts are there."""
        return not self.bad_rows and self.made is not None

    @property
    def read(self):
        """Pixels whose samples came through: bool (rows, cols)."""
        mask = np.zeros((self.header.rows, self.header.cols), bool)
        bad = set(self.bad_rows)
        for i, row in enumerate(self.layout.rows.tolist()):
            if row not in bad:
                mask[row, self.layout.places_of(i) // self.header.subs] = True
        return mask

    def save(self, path):
        """Write samples, read, bad_rows, made, left_out (-1 when lost) and the header as JSON to an npz file.

        The file is whole or not there. Raises OSError when it cannot be written.
        """
        path = Path(path)
        counts = {
            name: -1 if count is None else count for name, count in (("made", self.made), ("left_out", self.left_out))
        }
        handle, part = tempfile.mkstemp(prefix=".part-", suffix=".npz", dir=path.parent)
        try:
            with os.fdopen(handle, "wb") as out:
                np.savez_compressed(
                    out,
                    samples=self.samples,
                    read=self.read,
                    header=json.dumps(dataclasses.asdict(self.header)),
                    bad_rows=np.array(self.bad_rows, np.int32),
                    **counts,
                )
            os.chmod(part, 0o644)
            os.replace(part, path)
        except BaseException:
            os.unlink(part)
            raise

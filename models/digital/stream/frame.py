"""One decoded frame, and its file."""

import dataclasses
import json
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.models.digital.stream.header import Layout, StreamHeader


@dataclass(eq=False)
class DecodedFrame:
    """Result of decoding one frame.

    header: the frame's header, corrected.
    samples: (rows, cols, header.subs), zero where nothing is read or the row is bad.
    layout: rows and samples of the frame.
    start, stop: position of its bytes.
    bad_rows: rows that are damaged or missing, ascending.
    made, left_out: conversions; None when the trailer is lost.
    truncated: the trailer's counts are decoded, the bytes after them end too early.
    segments: segments, each with a mark, that are decoded.
    errors: one line for each error, corrected or not.
    """

    header: StreamHeader
    samples: npt.NDArray[np.int16]
    layout: Layout
    start: int
    stop: int = 0
    bad_rows: list[int] = field(default_factory=list)
    made: int | None = None
    left_out: int | None = None
    truncated: bool = False
    segments: int = 0
    errors: list[str] = field(default_factory=list)

    @property
    def complete(self) -> bool:
        """True when every row is decoded and the trailer is there with all its bytes."""
        return not self.bad_rows and self.made is not None and not self.truncated

    @property
    def read(self) -> npt.NDArray[np.bool_]:
        """Pixels whose samples are decoded: bool (rows, cols)."""
        mask = np.zeros((self.header.rows, self.header.cols), bool)
        bad = set(self.bad_rows)
        for i, row in enumerate(self.layout.rows.tolist()):
            if row not in bad:
                mask[row, self.layout.places_of(i) // self.header.subs] = True
        return mask

    def save(self, path: str | Path) -> None:
        """Write samples, read, bad_rows, made, left_out (-1 when lost) and the header as JSON to an npz file.

        path: the file. Raises OSError if it cannot be written.
        """
        with open(path, "wb") as file:
            np.savez_compressed(
                file,
                samples=self.samples,
                read=self.read,
                header=json.dumps(dataclasses.asdict(self.header)),
                bad_rows=np.array(self.bad_rows, np.int32),
                made=-1 if self.made is None else self.made,
                left_out=-1 if self.left_out is None else self.left_out,
            )

"""ReadoutSeq's ports, the same at every level (README.md), and the array's edges from its parameters."""

from collections.abc import Sequence
from typing import NamedTuple

from pymtl3 import InPort, OutPort
from pymtl3.stdlib.stream.ifcs import SendIfcRTL

from talbot.models.parameters import ParameterError
from talbot.rtl.messages import step_msg
from talbot.rtl.sizes import check_size, check_tile

WINDOW = ("row0", "row1", "col0", "col1")


class Edges(NamedTuple):
    """The last tile row and column of the array, which may be partial.

    last_row, last_col: their index, 0..255. rows_there, cols_there: rows and columns of pixels in them, 1..the tile's.
    """

    last_row: int
    rows_there: int
    last_col: int
    cols_there: int


def edges(rows: int, cols: int, lanes: int, order: Sequence[int], tile_rows: int, tile_cols: int) -> Edges:
    """Return the edges of an array of rows x cols pixels. Raises ParameterError if the ports cannot address it."""
    check_size(rows=rows, cols=cols, lanes=lanes)
    check_tile(order, tile_rows, tile_cols)
    last_row, last_col = (rows - 1) // tile_rows, (cols - 1) // tile_cols
    if max(last_row, last_col) > 255:
        raise ParameterError(f"array = {rows} x {cols}: must be at most 256 x 256 tiles of {tile_rows} x {tile_cols}")
    return Edges(last_row, rows - last_row * tile_rows, last_col, cols - last_col * tile_cols)


def declare_ports(s, lanes: int) -> None:
    """Give the component ``s`` its ports."""
    s.start, s.overlap = InPort(), InPort()
    s.mode, s.mask, s.decimation = InPort(2), InPort(24), InPort(2)
    for name in WINDOW:
        setattr(s, name, InPort(8))
    s.exposure = InPort(10)
    s.amp_done, s.amp_err, s.bank_idle = InPort(), InPort(), InPort()
    s.busy, s.done, s.cfg_err = OutPort(), OutPort(), OutPort()
    s.amp_start, s.amp_row, s.reset_row = OutPort(), OutPort(10), OutPort(10)
    s.slot_resets, s.slot_reads, s.slot_opens = OutPort(), OutPort(), OutPort()
    s.four_tap, s.hold_free = OutPort(), OutPort()
    s.step = SendIfcRTL(step_msg(lanes))
    s.cycles = OutPort(64)

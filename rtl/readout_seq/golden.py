"""The golden scan for the levels of ReadoutSeq: configuration from the ports, messages to them."""

from models.digital.scan import Scan
from models.parameters import MODES, FrameParameters, TileParameters, Window
from rtl.messages import SAMPLE, step_msg

from .ports import WINDOW


def configured_scan(s, rows, cols, lanes, tile):
    """The Scan that the ports of component ``s`` configure. Raises ParameterError if no frame can start."""
    window = Window(*(int(getattr(s, name)) for name in WINDOW))
    frame = FrameParameters(window, MODES[int(s.mode)], int(s.mask), decimation=int(s.decimation))
    return Scan(rows, cols, lanes, frame, tile)


def tile_of(order, tile_rows, tile_cols):
    """TileParameters with the pixel types in ``order``."""
    return TileParameters(tile_rows, tile_cols, TileParameters().types[: tile_rows * tile_cols], tuple(order))


def row_steps(scan, row):
    """The messages that convert one row, in order: list of StepMsg."""
    Step = step_msg(scan.lanes)
    return [Step(SAMPLE, row, step.group, step.k, step.sub, step.enable) for step in scan.steps(row) if step.enable]


def mark(kind, lanes, row=0):
    """The FRAME, ROW or END message."""
    return step_msg(lanes)(kind, row)

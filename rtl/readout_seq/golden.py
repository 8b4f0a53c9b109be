"""The golden scan for the levels of ReadoutSeq: configuration from the ports, messages to them."""

from collections.abc import Sequence
from typing import Any

from talbot.models.digital.scan import Scan
from talbot.models.parameters import MODES, FrameParameters, TileParameters, Window
from talbot.rtl.messages import SAMPLE, step_msg
from talbot.rtl.readout_seq.ports import WINDOW


def configured_scan(s, rows: int, cols: int, lanes: int, tile: TileParameters) -> Scan:
    """Return the Scan that the ports of component ``s`` configure. Raises ParameterError if no frame can start."""
    window = Window(*(int(getattr(s, name)) for name in WINDOW))
    frame = FrameParameters(window, MODES[int(s.mode)], int(s.mask), decimation=int(s.decimation))
    return Scan(rows, cols, lanes, frame, tile)


def tile_of(order: Sequence[int], tile_rows: int, tile_cols: int) -> TileParameters:
    """Return TileParameters with the pixel types in ``order``."""
    return TileParameters(tile_rows, tile_cols, TileParameters().types[: tile_rows * tile_cols], tuple(order))


def row_steps(scan: Scan, row: int) -> list[Any]:
    """Return the StepMsg that convert one row, in order."""
    Step = step_msg(scan.lanes)
    return [Step(SAMPLE, row, step.group, step.k, step.sub, step.enable) for step in scan.steps(row) if step.enable]


def lead(s) -> int:
    """Return the slots from a row's reset to its read, as the ports of component ``s`` configure it."""
    return 0 if MODES[int(s.mode)] == "tof" else int(s.exposure)


def mark(kind: int, lanes: int, row: int = 0) -> Any:
    """Return the StepMsg of a FRAME, ROW or END."""
    return step_msg(lanes)(kind, row)

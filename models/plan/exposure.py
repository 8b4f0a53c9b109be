"""The timing with which a frame of a sensor gives the signal that it is to give."""

from dataclasses import replace

from talbot.models.digital.exposure import slot_cycles
from talbot.models.digital.scan import Scan
from talbot.models.parameters import ELEMENTARY_CHARGE, EXPOSURE_MAX, AmpTiming, FrameParameters, SensorParameters

CYCLES_A_STEP = 11  # a converter's go, its longest search, and a cycle between two
CYCLES_A_ROW = 16  # marks, and what the bank and the encoder still hold


def fitting(frame: FrameParameters, sensor: SensorParameters) -> AmpTiming:
    """Timing of a frame with t_int so long that no row waits for the converters: all slots last as long.

    frame: the frame. sensor: the sensor. Returns AmpTiming: of the frame, t_int longer where needed.
    """
    timing = frame.timing
    scan = Scan(*sensor.shape, sensor.chip.lanes, frame, sensor.tile)
    steps = max(len(scan.steps(int(row))) for row in scan.row_list[: sensor.tile.rows])
    # The encoder takes a sample a cycle, and incompressible samples are 17 bytes of 16.
    step = max(CYCLES_A_STEP, -(-17 * sensor.chip.lanes // 16) + 1)
    busy = timing.t_settle + timing.t_read + timing.t_guard + steps * step + CYCLES_A_ROW
    return replace(timing, t_int=timing.t_int + max(0, busy - slot_cycles(timing)))


def exposed_for(signal: float, frame: FrameParameters, sensor: SensorParameters) -> AmpTiming:
    """Timing with which white gives a part of a full well, or as much of it as the longest exposure does.

    In light that would give more in t_int alone the reset pointer does not lead, and t_int is shorter.

    signal: part of a full well, 0..1. frame: the frame, without common-mode resets. sensor: the sensor; its
    white_current is that of the light. Returns AmpTiming: of the frame but t_int and exposure.
    """
    e = sensor.electrical
    cycles = round(signal * e.full_well * ELEMENTARY_CHARGE / e.white_current * sensor.chip.f_clk)
    timing = fitting(frame, sensor)
    if cycles <= timing.t_int:
        return replace(frame.timing, t_int=max(1, min(cycles, frame.timing.t_int)), exposure=0)
    rows = round((cycles - timing.t_int) / slot_cycles(timing))
    return replace(timing, exposure=min(rows, EXPOSURE_MAX))


def row_cycles(frame: FrameParameters, sensor: SensorParameters) -> int:
    """Cycles of a row: its slot, or as long as the converters take where every sample has the longest search.

    frame: the frame; in time of flight a slot has four integrations. sensor: the sensor. Returns cycles from a row to
    the next.
    """
    timing = frame.exposing
    fitted = fitting(replace(frame, timing=timing), sensor)  # of tof: all four samples in one slot
    converting = slot_cycles(replace(timing, t_int=fitted.t_int), False)
    return max(slot_cycles(timing, True), converting) if frame.mode == "tof" else converting


def frame_cycles(frame: FrameParameters, sensor: SensorParameters) -> int:
    """Cycles of a frame: a row's for each row that is read, and for each by which the reset pointer leads.

    frame: the frame. sensor: the sensor. Returns int: without what a slow host takes.
    """
    scan = Scan(*sensor.shape, sensor.chip.lanes, frame, sensor.tile)
    return (len(scan.row_list) + frame.exposing.exposure) * row_cycles(frame, sensor)

"""What a frame costs: bytes, energy and time by the models of `make sim`, and the area of the sensor's blocks.

Area and time are known before a frame is simulated, and of the energy what does not depend on the scene: a sensor that
breaks a limit by these alone is refused at once.
"""

from collections.abc import Sequence

from talbot.imaging.frame.figures import golden_events
from talbot.imaging.frame.request import FrameRequest
from talbot.imaging.frame.result import GoldenResult
from talbot.models.digital.scan import Scan
from talbot.models.parameters import (
    SAMPLES_PER_PIXEL,
    EnergyParameters,
    LightParameters,
    ParameterError,
    SensorParameters,
)
from talbot.models.parameters.energy import DECISIONS, WINDOW, DigitalEvents, Events
from talbot.models.parameters.stream_format import HEADER_BYTES, TRAILER_BYTES
from talbot.models.plan.exposure import frame_cycles
from talbot.pixels.blocks import AnalogSizes

# docs/results: the chip as laid out with the cells Compact (layout.md), gates of blocks (blocks.md)
CHIP_MM2, CHIP_GATES, LANES, LANE_GATES = 0.2231, 25892, 8, 4834 / 8
PHASE_GATES, DIVIDER_GATES = 3063, {"radix2": 952, "radix4": 1135, "pipelined": 3382, "cordic": 2128}
TURN_S = 91.2e-9  # settling of the column's turn as drawn, slowest of the corners that keep the limit (analog.md)


def area_mm2(sensor: SensorParameters) -> float:
    """Sum of the blocks' areas: pixels, row driver, column amplifiers, converters, digital chip.

    Without pads, ring and what the die's floorplan leaves free. Analog blocks have the room of `pixels.blocks`, the
    chip the area of its layout, scaled by the gates of lanes and divider.
    """
    array, chip, room = sensor.array, sensor.chip, AnalogSizes()
    width, height = array.cols * array.pitch * 1e6, array.rows * array.pitch * 1e6
    lanes = (chip.lanes * room.lane_um + room.bias_um) * room.lanes_um
    gates = CHIP_GATES + (chip.lanes - LANES) * LANE_GATES
    # Without a divider there is no phase path at all
    gates += DIVIDER_GATES[chip.divider] - DIVIDER_GATES["radix4"] if chip.divider in DIVIDER_GATES else -PHASE_GATES
    analog = width * height + room.row_driver_um * height + width * room.columns_um + lanes
    return 1e-6 * analog + CHIP_MM2 * gates / CHIP_GATES


def check_settling(sensor: SensorParameters) -> None:
    """Raise ParameterError where a cycle is shorter than a column's turn as drawn takes to settle."""
    if sensor.chip.f_clk * TURN_S > 1:
        most = f"{1 / TURN_S:.3g} Hz, a column settles in {TURN_S:.3g} s"
        raise ParameterError(f"chip.f_clk = {sensor.chip.f_clk:g}: must be at most {most}")


def least(requests: Sequence[FrameRequest]) -> dict[str, float]:
    """Of frames that one result takes: time, the least energy and the fewest bytes, whatever the scene is."""
    energy, seconds = 0.0, 0.0
    for request in requests:
        sensor, frame = request.sensor, request.frame
        scan, cycles = Scan(*sensor.shape, sensor.chip.lanes, frame, sensor.tile), frame_cycles(frame, sensor)
        taps, read = 4 if frame.mode == "tof" else 1, int(scan.read.sum())
        rows, columns = len(scan.row_list), int(scan.read.any(0).sum())
        samples = read * SAMPLES_PER_PIXEL[frame.mode]
        windowed = frame.mode == "ternary" or frame.mode == "edge" and frame.threshold
        decisions = samples * (WINDOW if windowed else DECISIONS)
        digital = DigitalEvents(cycles, rows, samples, decisions)
        spent = cycles / sensor.chip.f_clk
        events = Events(rows * sensor.array.cols * taps, rows * columns * taps, spent, decisions, 0, digital)
        energy, seconds = energy + EnergyParameters().total(events)[0], seconds + spent
    size = (HEADER_BYTES + TRAILER_BYTES) * len(requests)
    return {"energy_uj": 1e6 * energy, "bytes": float(size), "frames_per_s": 1 / seconds}


def measured(requests: Sequence[FrameRequest], results: Sequence[GoldenResult]) -> dict[str, float]:
    """Energy (lower reading), bytes and rate of the frames of ``requests``, as the golden chip read them.

    Where ``results`` are of the middle of the array, their decisions, bytes and changes count for all pixels alike.
    """
    energy = size = seconds = 0.0
    for request, result in zip(requests, results, strict=True):
        golden, cycles, whole = result.golden, frame_cycles(request.frame, request.sensor), request.sensor.array
        part = result.request.sensor.array
        times = whole.rows * whole.cols / (part.rows * part.cols)
        events = golden_events(golden, golden.stream, cycles, cycles)
        digital = DigitalEvents(
            cycles,
            round(events.digital.rows * whole.rows / part.rows),
            *(round(times * count) for count in events.digital[2:]),
        )
        events = Events(
            round(times * events.resets),
            round(times * events.amplified),
            cycles / request.sensor.chip.f_clk,
            round(times * events.decisions),
            round(times * events.toggles),
            digital,
        )
        energy += EnergyParameters().total(events)[0]
        size += times * len(golden.stream)
        seconds += events.seconds
    return {"energy_uj": 1e6 * energy, "bytes": size, "frames_per_s": 1 / seconds}


def light_uj(request: FrameRequest) -> float:
    """Electrical energy of the source of time of flight in a frame of four taps, as `make sim` counts it."""
    sensor, timing = request.sensor, request.frame.exposing
    array, lens = sensor.array, sensor.optics.camera
    lit = array.rows * 4 * timing.t_int * (timing.n_cm + 1) / sensor.chip.f_clk
    power = LightParameters().power(
        sensor.electrical.white_current, array.pitch, array.rows * array.cols, lens.nu_max, lens.magnification
    )
    return 1e6 * power * lit

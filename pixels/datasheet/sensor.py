"""The sensor as a buyer sees it: what its pixels, circuits and chip do together, with the condition of each figure."""

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from talbot.models.digital.scan import Scan
from talbot.models.parameters import (
    ELEMENTARY_CHARGE,
    MODES,
    SAMPLES_PER_PIXEL,
    EnergyParameters,
    FrameParameters,
    RoomParameters,
    SensorParameters,
)
from talbot.models.parameters.electrical import TEMPERATURE
from talbot.models.parameters.energy import DECISIONS, WINDOW, DigitalEvents, Events
from talbot.models.parameters.sources import sources
from talbot.models.plan.exposure import exposed_for, frame_cycles
from talbot.pixels.designs import gratings
from talbot.pixels.layout.write import fitted
from talbot.pixels.pixel_circuit.emva import emva

HEAD = "characteristic", "value", "unit", "condition"
Rows = list[tuple[str, str, str, str]]


def figures(pdk: str, sensor: SensorParameters) -> dict[str, Any]:
    """Return ``emva`` (the table of `Emva`), ``modes`` (frames/s and W by mode) and ``gratings`` (fits by beta)."""
    chosen = gratings(pdk)
    fits = {f"{beta:g}": asdict(fitted(one, chosen.wavelength_um)) for beta, one in chosen.geometries.items()}
    modes = {mode: rate_and_power(mode, sensor) for mode in MODES}
    return {"emva": asdict(emva(sensor.electrical)), "modes": modes, "gratings": fits}


def rate_and_power(mode: str, sensor: SensorParameters) -> dict[str, float]:
    """Frames/s of a whole frame, and W at the rate of Table 6.1 or at that where it is lower.

    low, high: both readings. Every sample is converted and sent as a byte; in edge mode with a threshold none is.
    """
    frame = FrameParameters(sensor.full_window, mode)
    if mode != "tof":
        room = RoomParameters()
        timing = exposed_for(room.signal, frame, room.lit(sensor))
        frame = FrameParameters(sensor.full_window, mode, timing=timing)
    cycles, taps, edge = frame_cycles(frame, sensor), 4 if mode == "tof" else 1, mode == "edge"
    scan = Scan(*sensor.shape, sensor.chip.lanes, frame, sensor.tile)
    rows, pixels = len(scan.row_list), int(scan.read.sum())
    samples, seconds = pixels * SAMPLES_PER_PIXEL[mode], cycles / sensor.chip.f_clk
    decisions, sent = samples * (WINDOW if edge else DECISIONS), 0 if edge else samples
    digital = DigitalEvents(cycles, rows, samples, decisions, sent)
    energy = EnergyParameters()
    toggles = (4 + 2) * sent  # half of the data pins change, the strobe up and down
    low, high = energy.total(Events(pixels * taps, pixels * taps, seconds, decisions, toggles, digital))
    rate = min(energy.frame_rate, 1 / seconds)
    return {"frames_per_s": 1 / seconds, "low": low * rate, "high": high * rate}


def rows(found: dict[str, Any], sensor: SensorParameters, enob: float | None) -> Rows:
    """Return the rows of the page. enob: of a lane."""
    return [*_pixels(found, sensor), *_chip(found, sensor, enob), *_optics(found)]


def _pixels(found: dict[str, Any], sensor: SensorParameters) -> Iterator[tuple[str, str, str, str]]:
    e, table = sensor.electrical, found["emva"]
    source = {row.name: row.source for row in sources(e)}
    kelvin = f"models of make sim, flat pictures of one diode before the converter, {TEMPERATURE:g} K"
    array = sensor.array
    yield "pixels", f"{array.rows} x {array.cols}", "", f"pitch {array.pitch_um:g} um, two diodes each"
    yield "full well", f"{e.full_well:,.0f}", "e", f"of a diode; {source['full_well']}"
    yield "saturation", f"{table['saturation']:,.0f}", "e", f"photon transfer; {kelvin}"
    yield "noise in the dark", f"{table['dark_noise']:.1f}", "e", f"rms; {source['read_noise']}"
    yield "absolute sensitivity threshold", f"{table['threshold']:.0f}", "e of light", kelvin
    yield "dynamic range", f"{table['dynamic_range_db']:.1f}", "dB", kelvin
    yield "SNR max", f"{table['snr_max_db']:.1f}", "dB", kelvin
    yield "DSNU", f"{table['dsnu']:.0f}", "e", f"rms; pixels: {source['offset_fpn']}; columns: {source['column_fpn']}"
    yield "PRNU", f"{100 * table['prnu']:.2f}", "%", source["gain_fpn"]
    yield "dark current", f"{e.dark_current / ELEMENTARY_CHARGE:,.0f}", "e/s", source["dark_current"]


def _chip(found: dict[str, Any], sensor: SensorParameters, enob: float | None) -> Iterator[tuple[str, str, str, str]]:
    room, energy = RoomParameters(), EnergyParameters()
    if enob is not None:
        yield "effective number of bits", f"{enob:.2f}", "bit", "a lane's, median of drawn capacitor arrays, with noise"
    for mode, one in found["modes"].items():
        light = "its own light" if mode == "tof" else f"white at {room.illuminance:g} lux fills {100 * room.signal:g} %"
        clock = f"{1e-6 * sensor.chip.f_clk:g} MHz, {sensor.chip.lanes} lanes, exposure included; {light}"
        yield f"frame rate, {mode} mode", f"{one['frames_per_s']:.1f}", "frames/s", clock
        rate = min(energy.frame_rate, one["frames_per_s"])
        sent = "no edge sent" if mode == "edge" else "every sample sent"
        condition = f"{rate:.3g} frames/s, {sent}; Table 6.1 and the chip's layout, tt, 1.8 V, both readings"
        yield f"power, {mode} mode", f"{1e3 * one['low']:.2f} to {1e3 * one['high']:.2f}", "mW", condition


def _optics(found: dict[str, Any]) -> Iterator[tuple[str, str, str, str]]:
    for beta, one in found["gratings"].items():
        text = f"beta {one['beta']:.1f}, m {one['m']:.2f}"
        condition = f"infinite gratings, unpolarized; quantum efficiency {100 * one['quantum_efficiency']:.0f} %"
        yield f"gratings for beta {beta}", text, "", condition

"""The figures of summary.json, each measured or counted in the run."""

import sys
from collections.abc import Iterable
from importlib.metadata import version
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.verilator import verilator_version
from talbot.imaging.frame.quality import decoding_error, ideal_samples, quality
from talbot.imaging.frame.result import FrameResult, GoldenResult
from talbot.models.afe.trim import TRIM_MAX, TRIM_MIN
from talbot.models.chip import GoldenFrame
from talbot.models.digital.exposure import integration_cycles, slot_cycles
from talbot.models.parameters import ELEMENTARY_CHARGE, SIGNED, CircuitEnergy, EnergyParameters, LightParameters
from talbot.models.parameters.energy import DECISIONS, EYE_LIMIT, WINDOW, DigitalEvents, Events
from talbot.models.parameters.stream_format import HEADER_BYTES, MARK, TRAILER_BYTES

Codes, Values = npt.NDArray[np.integer], npt.NDArray[np.float64]
ROW_PULSES = 4  # of a row's lines when it is read: reset, shutter, integrate and read; integrate again after each n_cm
PEAK = 255.0  # span of the 8-bit codes


def mismatches(first: bytes, second: bytes) -> int:
    """Return how many bytes differ, a missing byte counting as one."""
    a, b = (np.frombuffer(x, np.uint8) for x in (first, second))
    common = min(a.size, b.size)
    return int((a[:common] != b[:common]).sum()) + abs(a.size - b.size)


def psnr(error: Values) -> float | None:
    """10 log10(255^2 / mean square) in dB, or None where there is no error at all (JSON has no infinity)."""
    mean_square = float(np.mean(np.square(error))) if error.size else 0.0
    return 10 * float(np.log10(PEAK**2 / mean_square)) if mean_square else None


def events_of(result: FrameResult) -> Events:
    """Return the frame's events, for its energy."""
    chip = result.chip
    return golden_events(result.golden, chip.stream, chip.status["cycles"], chip.activity["busy"])


def golden_events(golden: GoldenFrame, stream: bytes, cycles: int, busy: int) -> Events:
    """Return the events of a frame of ``cycles`` that sends ``stream``; the chip is busy for ``busy`` cycles."""
    array, taps = golden.sensor.array, 4 if golden.frame.mode == "tof" else 1
    rows, columns = int(golden.read.any(1).sum()), int(golden.read.any(0).sum())
    seconds, sent = cycles / golden.sensor.chip.f_clk, np.frombuffer(stream, np.uint8)
    # Data pins that change from byte to byte, and the strobe up and down
    toggles = int(np.unpackbits(sent[1:] ^ sent[:-1]).sum()) + 2 * sent.size
    digital = golden.digital_events(busy)
    pulses = rows * taps * (ROW_PULSES + golden.frame.exposing.n_cm)
    pixels = rows * array.cols * taps, rows * columns * taps
    return Events(*pixels, seconds, golden.decisions, toggles, digital, pulses, golden.strobes)


def energy_of(result: FrameResult) -> dict[str, float]:
    """Return the energy of the frame in uJ, by part (docs/figures.md)."""
    events, request, energy = events_of(result), result.request, EnergyParameters()
    parts = {name: (1e6 * low, 1e6 * high) for name, (low, high) in energy.frame(events).items()}
    out = {name: low for name, (low, _) in parts.items()} | {"adcs_high": parts["adcs"][1]}
    out["total"], out["total_high"] = (1e6 * total for total in energy.total(events))
    circuits = {f"circuits_{name}": 1e6 * value for name, value in CircuitEnergy().frame(events).items()}
    out |= circuits | {"circuits": sum(circuits.values()) + out["digital"] + out["pads"]}
    if (source := light_of(result)) is not None:
        out["light"] = 1e6 * source["power_w"] * source["lit_s"]
    if request.frame.mode not in SIGNED:
        return out
    plain = image_mode(events, result.golden.samples)
    out["image_mode"], out["image_mode_high"] = (1e6 * total for total in energy.total(plain))
    out["saved_by_edge"] = 1e6 * (_by_sample(plain) - _by_sample(events))
    if request.frame.mode == "edge":
        out["edge_pays_below"] = edge_pays_below(events, result.golden.made)
    return out


def light_of(result: FrameResult) -> dict[str, float] | None:
    """Return the light source of time of flight, None in other modes.

    power_w: electrical, while it is on. lit_s: of a frame, in which a row integrates. irradiance: of the focal plane in
    W/m^2 while it is on; mean_irradiance: of frame after frame. eye_limit: of infrared at an eye for more than 1000 s.
    """
    sensor, timing = result.request.sensor, result.request.frame.exposing
    if result.request.frame.mode != "tof":
        return None
    events, array, lens, light = events_of(result), sensor.array, sensor.optics.camera, LightParameters()
    current = sensor.electrical.white_current
    lit = events.resets / array.cols * timing.t_int * (timing.n_cm + 1) / sensor.chip.f_clk
    irradiance = light.field(current, array.pitch, lens.nu_max)
    power = light.power(current, array.pitch, array.rows * array.cols, lens.nu_max, lens.magnification)
    return {"power_w": power, "lit_s": lit, "irradiance": irradiance} | {
        "mean_irradiance": irradiance * min(lit / events.seconds, 1.0),
        "eye_limit": EYE_LIMIT,
    }


def light_line(summary: dict[str, Any]) -> str:
    """Return the source of time of flight and whether its light keeps the limit, '' without a source."""
    source = summary.get("light_source")
    if not source:
        return ""
    mean, limit = source["mean_irradiance"], source["eye_limit"]
    against = f"{mean / limit:.2g} times the limit of" if mean > limit else "within the limit of"
    return (
        f"light source: {source['power_w']:.3g} W electrical for {1e3 * source['lit_s']:.3g} ms; "
        f"{source['irradiance']:.3g} W/m2 at the focal plane, {mean:.3g} in the mean: {against} {limit:g} W/m2 "
        "for an eye there for more than 1000 s (IEC 62471)"
    )


def edge_pays_below(events: Events, conversions: int) -> float:
    """Return the share of converted samples below which edge mode takes less than image mode, at most 1.

    A converted sample counts with its share of the bytes and changes of the frame that had ``events``.
    """
    none = Events(0, 0, 0.0, WINDOW, 0, DigitalEvents(decisions=WINDOW))
    saved = _by_sample(image_mode(Events(0, 0, 0.0, 0, 0), 1)) - _by_sample(none)
    conversions = max(conversions, 1)
    searched = DECISIONS * conversions
    digital = DigitalEvents(decisions=searched, bytes=events.digital.bytes)
    return min(saved * conversions / _by_sample(Events(0, 0, 0.0, searched, events.toggles, digital)), 1.0)


def image_mode(events: Events, samples: int) -> Events:
    """Return the events with a full conversion and a byte for every sample; half of the data pins change."""
    digital = events.digital._replace(decisions=DECISIONS * samples, bytes=samples)
    return events._replace(decisions=DECISIONS * samples, toggles=(4 + 2) * samples, digital=digital)


def _by_sample(events: Events) -> float:
    """Return the energy (J) of converters (lower reading), digital part (by the layout) and pads."""
    parts = EnergyParameters().frame(events)
    return sum(parts[name][0] for name in ("adcs", "digital", "pads"))


def energy_line(summary: dict[str, Any]) -> str:
    """Energy of a frame, both readings, and power (lower) at 30 frames a second or as many as there is time for."""
    e = summary["energy_uj"]
    rate = min(EnergyParameters().frame_rate, 1 / summary["frame_s_at_clock"])
    text = f"{e['total']:.1f} to {e['total_high']:.1f} uJ"
    if "image_mode" in e:
        text += f" (image mode {e['image_mode']:.1f} to {e['image_mode_high']:.1f})"
    if "circuits" in e:
        text += f", {e['circuits']:.1f} uJ by the circuits"
    if "light" in e:
        text += f" and {e['light'] / 1e6:.3g} J of light"
    if "edge_pays_below" in e:
        text += f"; edges save {e['saved_by_edge']:.1f} uJ, and pay below {100 * e['edge_pays_below']:.0f} % converted"
    return f"{text}; {e['total'] * rate / 1e3:.2f} mW at {rate:.3g} frames/s"


def digital_line(summary: dict[str, Any]) -> str:
    """Energy of the digital part by both of its sources."""
    e = summary["energy_uj"]
    return f"{e['timing']:.1f} uJ by the table's timing, {e['digital']:.1f} uJ by the layout's gates"


def camera_of(result: GoldenResult) -> dict[str, float | None]:
    """Return camera and distances of the scene, in m; exit_pupil_m: None is infinity."""
    optics, depth = result.request.sensor.optics, result.exposed.scene.depth
    lens = optics.camera
    near, far = (None, None) if depth is None else (float(depth.min()), float(depth.max()))
    return (
        {"f_number": lens.f_number, "focal_length_m": lens.focal_length, "focus_m": lens.focus, "scale": lens.scale}
        | {"views": result.exposed.views.most, "exit_pupil_m": lens.exit_pupil, "magnification": lens.magnification}
        | {"nearest_m": near, "farthest_m": far}
    )


def exposure_of(result: GoldenResult) -> dict[str, Any]:
    """Return how long a row integrates, and the light: lux of the room, to volts and codes of a white diode.

    white_electrons: before the first common-mode reset, if no well were full; white_volts, white_codes: of the well.
    deviating_rows: rows that integrated other than the formula
    says, by the pins of the chip; of the golden chip none.
    """
    request, timing = result.request, result.request.frame.exposing
    sensor, e, cycles = request.lit, request.lit.electrical, integration_cycles(timing)
    seconds = sum(cycles) / sensor.chip.f_clk
    measured = result.chip.integrated if isinstance(result, FrameResult) else []
    rows = np.flatnonzero(result.golden.read.any(1)) if measured else []
    light: dict[str, float] = {}
    if request.frame.mode != "tof":
        light = request.room.white(sensor.array.pitch, sensor.optics.nu_max, spectral=sensor.spectral)._asdict()
    electrons = e.white_current * cycles[0] / sensor.chip.f_clk / ELEMENTARY_CHARGE
    held = min(electrons, e.full_well)
    return (
        {
            "rows": timing.exposure,
            "t_int_cycles": timing.t_int,
            "slot_cycles": slot_cycles(timing, request.frame.mode == "tof"),
        }
        | {"integration_cycles": sum(cycles), "integration_s": seconds, "white": light, "white_electrons": electrons}
        | {"white_volts": e.swing * held / e.full_well, "white_codes": held / e.lsb_electrons}
        | {"full_well_electrons": e.full_well}
        | {"deviating_rows": sum(measured[row] != sum(cycles) for row in rows)}
    )


def exposure_line(summary: dict[str, Any]) -> str:
    """Return a row's integration, the light and the codes of white, in one line."""
    x = summary["exposure"]
    text = f"a row integrates {1e3 * x['integration_s']:.3g} ms of {1e3 * summary['frame_s_at_clock']:.3g} ms"
    if x["deviating_rows"]:
        text += f", {x['deviating_rows']} rows longer"
    lit = x["white"]
    if lit:
        text += f", {lit['room_lux']:g} lux: {lit['sensor_lux']:.3g} lux at the pixels, {lit['irradiance']:.3g} W/m2"
        text += f", {1e12 * lit['current']:.3g} pA"
    volts = f"= {x['white_volts']:.2g} V = {x['white_codes']:.3g} codes"
    if x["white_electrons"] <= x["full_well_electrons"]:
        return f"{text}; white gives {x['white_electrons']:,.0f} electrons a diode {volts}"
    times = x["white_electrons"] / x["full_well_electrons"]
    well = f"the full well of {x['full_well_electrons']:,.0f} electrons {volts}"
    return f"{text}; white is {times:.3g} times {well}, at which it clips"


def full_line(summary: dict[str, Any]) -> str:
    """Pixels with a full well, which no figure counts, '' if none."""
    full, pixels = summary["full_pixels"], summary["pixels"]
    if not full:
        return ""
    share = 100 * full / pixels
    return f"{full:,} of {pixels:,} pixels ({share:.3g} %) have a full well: no figure counts them"


def camera_line(summary: dict[str, Any]) -> str:
    """Return camera and distances of the scene in one line."""
    c = summary["camera"]
    pupil = "telecentric" if c["exit_pupil_m"] is None else f"exit pupil at {1e3 * c['exit_pupil_m']:.4g} mm"
    text = f"f/{c['f_number']:g} lens of {1e3 * c['focal_length_m']:.4g} mm, {pupil}, focused at {_far(c['focus_m'])}"
    if c["nearest_m"] is None:
        return text
    near, far = _far(c["nearest_m"]), _far(c["farthest_m"])
    return f"{text}; the scene, 1:{c['scale']:g}, stands at {near if near == far else f'{near} to {far}'}"


def _far(metres: float) -> str:
    return f"{100 * metres:.3g} cm" if metres < 1 else f"{metres:.3g} m"


def depth_line(summary: dict[str, Any]) -> str:
    """Return the error of the depth and that of one depth for all, '' without depth."""
    error, constant = summary["depth_rms_m"], summary["depth_rms_constant_m"]
    if error is None:
        return ""
    note = ", no better than one depth for all" if error >= constant else "; one depth for all"
    return f"depth {100 * error:.3g} cm RMS{note}: {100 * constant:.3g} cm"


def trims_at_end(trims: Iterable[int]) -> list[int]:
    """Pixel types whose trim register is at an end of its range: flat areas may leave a difference."""
    return [kind for kind, trim in enumerate(trims) if not TRIM_MIN < trim < TRIM_MAX]


def trims_line(summary: dict[str, Any]) -> str:
    """Return a line about the types of `trims_at_end`, '' if there are none."""
    kinds = summary["trims_at_end"]
    if not kinds:
        return ""
    return (
        f"trim registers of pixel types {', '.join(map(str, kinds))} are at the end of their range: "
        "flat areas may leave a difference"
    )


def summarize(result: FrameResult) -> dict[str, Any]:
    """Figures for summary.json, without `wall_s`: those of `summarize_golden`, and the chip's own.

    stream_mismatches: bytes that differ between the chip's stream and the golden encoder's.
    decoded_mismatches: decoded samples that differ from the golden codes, bad rows' among them.
    """
    golden, chip, status, f_clk = result.golden, result.chip, result.chip.status, result.request.sensor.chip.f_clk
    return (
        summarize_golden(result)
        | {name: status[name] for name in ("conversions_made", "conversions_left_out", "cycles")}
        | {"frame_s_at_clock": status["cycles"] / f_clk, "cycles_by_pin": chip.activity}
        | {"stream_mismatches": mismatches(chip.stream, golden.stream)}
        | {"decoded_mismatches": int((result.decoded.samples != golden.sent).sum())}
        | {"energy_uj": energy_of(result), "light_source": light_of(result)}
        | {"rtl_cycles_per_s": chip.cycles / chip.seconds, "rtl_simulated_cycles": chip.cycles}
        | {"tools": _tools() | {"verilator": verilator_version()}}
    )


def _tools() -> dict[str, str]:
    return {"python": sys.version.split()[0]} | {name: version(name) for name in ("pymtl3", "numpy", "numba")}


def summarize_golden(result: GoldenResult) -> dict[str, Any]:
    """Return the figures of a frame that the golden chip can give (docs/figures.md): no cycles, no energy."""
    request, golden, decoded = result.request, result.golden, result.decoded
    sensor, frame = request.sensor, request.frame
    ideal, marks = result.exposed.ideal, MARK.size * decoded.segments
    sent, size = golden.read.sum() * golden.sent.shape[2], len(result.stream)
    counted, full = result.counted, int((golden.read & result.exposed.full).sum())
    span = np.ptp(ideal_samples(ideal, frame)[counted]) if counted.any() else 0.0
    error = decoding_error(decoded.samples, ideal, counted, frame)
    rest = size - HEADER_BYTES - TRAILER_BYTES - marks
    parts = {"header": HEADER_BYTES, "samples": rest, "marks": marks, "trailer": TRAILER_BYTES}
    ratio = float(sent) / max(size, 1)
    return (
        {"scene": request.name, "mode": frame.mode, "rows": sensor.array.rows, "cols": sensor.array.cols}
        | {"threshold": frame.threshold, "lanes": sensor.chip.lanes, "noise": request.noise, "seed": request.seed}
        | {"window": vars(frame.window), "mask": f"{frame.mask:#08x}", "decimation": frame.decimation}
        | {"camera": camera_of(result), "exposure": exposure_of(result)}
        | {"quadrature_error_codes": result.exposed.views.error, "hidden_light_codes": result.exposed.views.hidden}
        | {"trims_at_end": trims_at_end(result.exposed.front_end.trim)}
        | {"phase": frame.phase, "pixels": int(golden.read.sum()), "full_pixels": full, "samples": golden.samples}
        | {"conversions_made": golden.made, "conversions_left_out": golden.left_out}
        | {"comparator_decisions": golden.decisions}
        | {"stream_bytes": size, "raw_bytes": int(sent), "bytes": parts, "compression_ratio": ratio}
        | {"psnr_db": psnr(error[:, 1:] if frame.phase else error), "peak": PEAK}
        | quality(result)
        | {"signal_span": float(span)}
        | {"left_out": [entry._asdict() for entry in (*result.exposed.views.left_out, *result.exposed.plan.left_out)]}
        | {"tools": _tools()}
    )

"""The pixel's circuit over corners, its spread, its EMVA table -> page, summary.json, and a sensor file."""

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from pathlib import Path
from time import perf_counter
from typing import Any

from talbot.base.files import check_file, check_folder, staged, write
from talbot.base.jobs import Job, run
from talbot.base.paths import BUILD
from talbot.base.records import from_json
from talbot.cells.corner import Corner
from talbot.models.parameters import (
    ELEMENTARY_CHARGE,
    STANDARD,
    ElectricalParameters,
    ParameterError,
    SensorParameters,
    sensor_text,
)
from talbot.pixels.designs import gratings
from talbot.pixels.layout.circuit import spice
from talbot.pixels.layout.write import fitted
from talbot.pixels.pixel_circuit.deck import Bench
from talbot.pixels.pixel_circuit.drawn import drawn, measured, spread_of
from talbot.pixels.pixel_circuit.emva import emva
from talbot.pixels.pixel_circuit.measure import PixelFound, Spread
from talbot.platforms.pixel import pixel_process

STEPS = "corners", "mismatch", "exposures", "report"
STORE = BUILD / "pixel" / "circuit"
PROCESSES, TEMPERATURES = ("tt", "ss", "ff"), (-40, 25, 85)
DRAWN = 50  # pixels with mismatch, two diodes each
LAG_MOST, FRAMES_MOST = 1e-3, 5e-3  # of the full well: what a frame leaves, and transients off the characteristic
FILES = "summary.json", "sensor.toml", "pixel.spice"


def typical(pdk: str) -> Corner:
    """Return the corner of the sensor file. Raises ParameterError."""
    return Corner("tt", 25, pixel_process(pdk).supply_v)


def corners(pdk: str, wanted: str) -> list[Corner]:
    """Corners of 'all' (9), 'typical', or a list of processes and degrees, tt_25,ss_-40. Raises ParameterError."""
    supply = pixel_process(pdk).supply_v
    if wanted == "typical":
        return [typical(pdk)]
    if wanted == "all":
        return [Corner(process, degrees, supply) for process in PROCESSES for degrees in TEMPERATURES]
    known = {f"{process}_{degrees}": (process, degrees) for process in PROCESSES for degrees in TEMPERATURES}
    names = wanted.split(",")
    if wrong := [name for name in names if name not in known]:
        raise ParameterError(f"corners = {wrong[0]!r}: must be all, typical, or some of {', '.join(known)}")
    return [typical(pdk), *(Corner(*known[name], supply) for name in names if known[name] != ("tt", 25))]


def make(
    pdk: str,
    wanted: str,
    bench: Bench,
    out: Path,
    table: Path | None = None,
    workers: int = -1,
    note: Callable[[str], None] = lambda text: None,
    sensor: SensorParameters = STANDARD,
) -> dict[str, Any]:
    """Measure and report into ``out``, into ``table`` what sensors take; returns the summary.

    sensor: of the written sensor file, but for what is measured.

    Raises ParameterError, ToolError.
    """
    from talbot.pixels.pixel_circuit import page  # Matplotlib: not before it is needed

    start = perf_counter()
    check_folder("out", out)
    if table:
        check_file("table", table)
    made, middle = drawn(pdk, bench.pitch_um), typical(pdk)
    asked = corners(pdk, wanted)
    note("corners")
    jobs = [
        Job(one.name, measured, (pdk, one, bench), (pdk, *asdict(one).values(), *asdict(bench).values()))
        for one in asked
    ]
    found = {
        one.name: from_json(PixelFound, result)
        for one, result in zip(asked, run(jobs, STORE, "corners", workers), strict=True)
    }
    note("mismatch")
    usual = found[middle.name]
    levels = usual.reset_v, usual.reset_v - usual.full_well / 2 * ELEMENTARY_CHARGE / (1e-15 * usual.well_ff)
    inputs = (pdk, *asdict(middle).values(), *asdict(bench).values(), *levels, DRAWN)
    (result,) = run([Job("spread", spread_of, (pdk, middle, bench, levels, DRAWN), inputs)], STORE, "mismatch", 1)
    spread_ = from_json(Spread, result)
    note("exposures")
    electrical = electrical_of(usual, spread_, sensor.electrical)
    exposures = emva(replace(electrical, column_fpn=0.0, flicker_noise=0.0))
    summary: dict[str, Any] = {
        "process": pdk,
        "bench": asdict(bench),
        "supply_v": middle.supply,
        "corners": {name: asdict(one) | {"dark_noise": one.dark_noise} for name, one in found.items()},
        "spread": asdict(spread_) | {"offset_electrons": 1e6 * spread_.offset / usual.gain_uv},
        "emva": asdict(exposures),
        "quantum_efficiency": _efficiency(pdk, made.fill_factor),
        "sensor": {key: getattr(electrical, key) for key in sources(usual, spread_)},
        "passed": all(one.lag < LAG_MOST and one.frames < FRAMES_MOST for one in found.values()),
        "wall_s": perf_counter() - start,
    }
    note("report")
    process = made.process
    with staged(out, (*FILES, *page.NAMES)) as folder:
        (folder / "pixel.spice").write_text(
            spice("pixel", made.circuit, process.transistor, process.diode), encoding="utf-8"
        )
        (folder / "sensor.toml").write_text(
            sensor_file(replace(sensor, electrical=electrical), sources(usual, spread_)), encoding="utf-8"
        )
        page.write(folder, summary)
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if table:
        write(table, json.dumps(sensor_table(summary, sources(usual, spread_)), indent=1, allow_nan=False) + "\n")
    return summary


def electrical_of(usual: PixelFound, found: Spread, base: ElectricalParameters) -> ElectricalParameters:
    """Return the pixels' electrical parameters by the circuit; what is of amplifiers and light is as it was."""
    return replace(
        base,
        full_well=round(usual.full_well),
        swing=round(usual.full_well * ELEMENTARY_CHARGE / (1e-15 * usual.well_ff), 4),
        read_noise=round(usual.dark_noise, 2),
        dark_current=float(f"{usual.dark_current:.4g}"),
        gain_fpn=round(found.gain, 5),
    )


def sources(usual: PixelFound, found: Spread) -> dict[str, str]:
    """Where each parameter of `electrical_of` comes from."""
    at = f"make pixel-circuit, {usual.corner}"
    return {
        "full_well": f"{at}: from the reset level to the least voltage of the column",
        "swing": f"{at}: of the node, over the full well",
        "read_noise": f"{at}: sqrt(2) times reset ({usual.reset_closed:.1f}) and follower ({usual.read_noise:.1f})",
        "dark_current": f"{at}: SkyWater's saturation current of the junction, less the reset transistor's leakage",
        "gain_fpn": f"{at}: {found.diodes} diodes' transistors with the models' mismatch; the wells' is not known",
    }


def sensor_table(summary: Mapping[str, Any], came: Mapping[str, str]) -> dict[str, Any]:
    """Return the data of `models.parameters.drawn_electrical`: values, sources, and deviations of corners."""
    corners = summary["corners"]
    figures = ("full_well", "dark_noise", "gain_uv", "linearity", "lag", "dark_current", "gates_ff")
    return {
        "command": f"make pixel-circuit, {summary['process']}",
        "parameters": summary["sensor"],
        "sources": came,
        "corners": [*corners],
        "over_corners": {
            name: [float(f"{end(one[name] for one in corners.values()):.4g}") for end in (min, max)] for name in figures
        },
    }


def sensor_file(sensor: SensorParameters, came: Mapping[str, str]) -> str:
    """Text of a sensor's file, with the source of each measured parameter at its top."""
    known = "".join(f"# {name}: {source}\n" for name, source in came.items())
    return f"# The pixel in transistors. What is not named here is assumed, as `talbot sensor` says.\n{known}" + (
        sensor_text(sensor)
    )


def _efficiency(pdk: str, fill: float) -> dict[str, dict[str, float]]:
    """Return quantum efficiencies at the gratings' wavelength, by beta: of the gratings, of a pixel."""
    chosen = gratings(pdk)
    found = {
        f"{beta:g}": fitted(geometry, chosen.wavelength_um).quantum_efficiency
        for beta, geometry in chosen.geometries.items()
    }
    return {beta: {"gratings": share, "pixel": share * fill} for beta, share in found.items()}

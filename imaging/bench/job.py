"""Readings -> sensor.toml, response.npz, page, summary.json; and what a bench is expected to read."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from talbot.base.files import check_folder, staged
from talbot.base.table import markdown_table
from talbot.imaging.bench import simulated as bench
from talbot.imaging.bench.chip import Measured, check_tile, measured
from talbot.imaging.bench.readings import Readings, joined, read, text_of
from talbot.models.parameters import ParameterError, PixelType, SensorParameters
from talbot.pixels.measured import SUFFIX
from talbot.pixels.tabled import pixel_of
from talbot.pixels.test_chip.places import COLS, COVERED, PLAIN, REFERENCE, by_type

SIMULATED = "simulated"


@dataclass(frozen=True)
class Simulation:
    """Settings of a simulated bench. holes: angles along the diameter of the lens's cone. lux: on the chip."""

    holes: int = 13
    noise: float = 1.0
    seed: int = 1
    lux: float = 500.0


def read_files(paths: Sequence[str]) -> Readings:
    """Return the readings of files. Raises ParameterError."""
    return joined([read(Path(path)) for path in paths])


def make(
    out: Path,
    sensor: SensorParameters,
    files: Sequence[str] = (),
    simulation: Simulation | None = None,
    note: Callable[[str], None] = lambda text: None,
    typed: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """Calibrate from ``files``, or from a ``simulation`` of ``sensor``, into ``out``; returns the summary.

    sensor: with ``files``, has the parameters that a bench does not measure. Raises ParameterError.
    """
    check_tile(sensor.tile)
    readings = None
    truth: dict[str, Any] = {}
    if files:
        readings = read_files(files)  # bad input is refused before anything slow is imported
    from talbot.imaging.bench import page  # Matplotlib: not before it is needed

    check_folder("out", out, page.NAMES)
    note("read")
    about = ", ".join(Path(file).name for file in files)
    if simulation:
        readings, truth = _simulated(sensor, simulation)
        about = f"a simulated bench, pixel {pixel_of(sensor)}, noise {simulation.noise:g}, seed {simulation.seed}"
    assert readings is not None
    note("fit")
    done = measured(readings, sensor)
    summary = done.summary
    if simulation:
        summary |= {"truth": truth | {"types": [_labels(kind, sensor) for kind in sensor.tile.types]}}
        summary["response_rms"] = _response_rms(done, sensor)
        summary["simulation"] = {name: getattr(simulation, name) for name in ("holes", "noise", "seed", "lux")}
    summary["arguments"] = typed or {}
    note("report")
    with staged(out, page.NAMES) as folder:
        page.write(folder, done, about)
        if simulation:
            (folder / page.READINGS).write_text(text_of(readings), encoding="utf-8")
        (folder / "summary.json").write_text(json.dumps(summary, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return summary


def _simulated(sensor: SensorParameters, simulation: Simulation) -> tuple[Readings, dict[str, Any]]:
    source = pixel_of(sensor)
    if source.endswith(SUFFIX):
        raise ParameterError(f"pixel = {source!r}: must be one that is computed, to simulate its bench")
    readings, truth = bench.simulate(
        sensor, bench.desk_lamp(simulation.lux), bench.angles(simulation.holes), simulation.noise, simulation.seed
    )
    formula = all(kind.response is None for kind in sensor.tile.types)
    return readings, {
        "efficiency": [*truth.levels],
        "crosstalk": truth.crosstalk,
        "dark": [*truth.dark],
        "doubling": bench.DOUBLING,
        "gain": truth.gain,
        "bend": truth.bend,
        "sigma": sensor.optics.aperture_sigma if formula else None,
    }


def _labels(kind: PixelType, sensor: SensorParameters) -> dict[str, float] | None:
    """Return what a fit is to find; None for a type that is not of Eq. 3.1."""
    if kind.response is not None:
        return None
    return {"beta": kind.beta, "gamma_deg": kind.gamma_deg, "alpha": kind.alpha} | {
        "m": sensor.optics.m if kind.m is None else kind.m
    }


def _response_rms(done: Measured, sensor: SensorParameters) -> float:
    """RMS error of (a - b) / (a + b) of the measured responses, over types and angles that were read."""
    y, x = done.angles.tangents.T
    light = by_type(bench.relative(sensor, done.angles.tangents))
    theta = np.arctan(x), np.arctan(y)
    errors = []
    for k, table in enumerate(done.responses):
        if np.isfinite(done.signals[:, k]).any():
            a, b = table(*theta)
            c, d = light[:, k].T
            errors.append((a - b) / np.maximum(a + b, 1e-9) - (c - d) / (c + d))
    return float(np.sqrt(np.mean(np.square(errors))))


def expected(sensor: SensorParameters, lux: float, holes: int) -> str:
    """Return a table of what pixels of ``sensor`` are expected to show: currents, exposures, volts."""
    tangents = bench.angles(holes)
    light = bench.relative(sensor, tangents)
    gain = np.diff(bench.PAD_V[[-5, -1]])[0] / np.diff(bench.DIODE_V[[-5, -1]])[0]
    lamp = bench.desk_lamp(lux)
    seconds = bench.exposures(light, lamp)
    rows = []
    for name, pixels in _groups(sensor):
        row, col = np.array(pixels).T
        current = light[:, row, col] * lamp.plain_current()
        time = float(seconds[row, col].min())
        volts = gain * bench.fall(current * time / bench.FARAD)
        rows.append(
            (
                name,
                f"{1e12 * current.min():.3g}..{1e12 * current.max():.3g}",
                _time(time),
                f"{1e3 * volts.min():.0f}..{1e3 * volts.max():.0f}",
            )
        )
    return markdown_table(("pixels", "pA of a diode", "exposure", "fall of a pad, mV"), rows, 1)


def _groups(sensor: SensorParameters) -> list[tuple[str, list[tuple[int, int]]]]:
    plain = [(REFERENCE, col) for col in PLAIN]
    groups: dict[str, list[tuple[int, int]]] = {"plain": plain}
    for place, number in enumerate(sensor.tile.order):
        name = f"beta {sensor.tile.types[number].beta:g}"
        groups.setdefault(name, []).append(divmod(place, COLS))
    covered = [(REFERENCE, col) for col in COVERED]
    return [("plain", plain), *sorted((n, p) for n, p in groups.items() if n != "plain"), ("covered", covered)]


def _time(seconds: float) -> str:
    for unit, scale in (("s", 1.0), ("ms", 1e3)):
        if seconds * scale >= 1:
            return f"{seconds * scale:.3g} {unit}"
    return f"{seconds * 1e6:.3g} us"

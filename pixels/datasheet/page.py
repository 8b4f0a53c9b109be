"""The datasheet as a page: the sensor, then characteristics of circuits, corners, distributions."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from talbot.base.charts import COLOURS, svg
from talbot.base.page import TABLES, Section, Tile, render
from talbot.models.parameters import SensorParameters
from talbot.pixels.datasheet import sensor as sensors
from talbot.pixels.datasheet.datasheet import HEAD, Row
from talbot.pixels.datasheet.found import Found
from talbot.pixels.datasheet.lane import inl
from talbot.pixels.pixel_circuit.page import transfer

NAMES = ("datasheet.html", "summary.json")
AMPLIFIER = ("corner", "gain", "INL LSB", "settling ns", "left LSB", "ambient LSB", "energy pJ", "retries")
CORNERS = ("corner", "decision ns", "energy pJ", "settling ns", "INL LSB", "droop LSB", "lane pJ a decision", "retries")


def write(folder: Path, summary: dict[str, Any], rows: list[Row], found: Found, sensor: SensorParameters) -> None:
    """Write the page into ``folder``, which exists."""
    limited, corners = [row.verdict for row in rows if row.verdict], len(summary["corners"])
    passed = f"{limited.count('pass')} of {len(limited)}"
    tiles = [Tile(passed, "limits are kept", "bad" if summary["failed"] else "good")]
    if "open" in limited:
        tiles.append(Tile(str(limited.count("open")), f"not bounded by {summary['draws']} draws"))
    for row in rows:
        if row.name in ("offset, rms", "ENOB of a sine", "energy of a decision") and row.typical is not None:
            tiles.append(Tile(f"{row.typical:.3g} {row.unit}", f"{row.circuit}: {row.name}"))
    spec, sizes = summary["specification"], summary["sizes"]
    text = render(
        TABLES,
        f"{summary['pdk']}: the sensor, and its circuits in transistors",
        about=f"{corners} corner{'s' * (corners > 1)}, {summary['draws']} draws; make analog",
        tiles=tiles,
        sections=[
            Section(
                "The sensor",
                "Simulated, at the typical corner where nothing else is said; no silicon was measured.",
                charts=[svg(transfer(summary["sensor"]["emva"]))],
                head=sensors.HEAD,
                rows=sensors.rows(summary["sensor"], sensor, float(np.median(found.enob)) if found.enob else None),
                numbers=False,
            ),
            Section(
                "Circuits",
                "Limits follow from the sensor, the chip's clock and Table 6.1. The typical corner is tt, 27 °C, "
                f"1.8 V; an LSB is {1e3 * (spec['refp'] - spec['refn']) / 256:.2f} mV at the lane's input.",
                head=HEAD,
                rows=[row.texts for row in rows],
                numbers=False,
            ),
            Section(head=CORNERS, rows=[_corner(name, found) for name in summary["corners"]]),
            Section("Amplifier", head=AMPLIFIER, rows=[_amplifier(name, found) for name in summary["corners"]]),
            Section(
                "Mismatch",
                "Comparators with the mismatch of the models, and capacitor arrays in closed form.",
                charts=[svg(_histograms(found))],
            ),
            Section(
                "Sizes",
                f"{summary['transients']} transients, {summary['retried']} of them with a retry.",
                head=("", "value"),
                rows=[
                    (f"{circuit}: {name.replace('_', ' ')}", _size(name, value))
                    for circuit, part in sizes.items()
                    if isinstance(part, dict)
                    for name, value in part.items()
                ],
            ),
        ],
    )
    (folder / "datasheet.html").write_text(text, encoding="utf-8")


def _size(name: str, value: object) -> str:
    if not isinstance(value, float):
        return str(value)
    scale, unit = {"unit": (1e15, "fF"), "area": (1e12, "um2"), "unit_mismatch": (100, "%")}.get(name, (1, "um"))
    return f"{scale * value:.4g} {unit}"


def _corner(name: str, found: Found) -> tuple[str, ...]:
    one, lane = found.decisions[name], found.lanes[name]
    values = (1e9 * one.delay, 1e12 * one.energy, 1e9 * lane.settling, inl(lane.levels)[2], lane.droop)
    values += (1e12 * sum(lane.energy.values()),)
    return (name, *(f"{value:.3g}" for value in values), str(one.repeated + lane.repeated))


def _amplifier(name: str, found: Found) -> tuple[str, ...]:
    one = found.amplifiers[name]
    values = (one.gain, one.inl, 1e9 * one.settling, one.left, one.ambient, 1e12 * one.energy)
    return (name, *(f"{value:.3g}" for value in values), str(one.repeated))


def _histograms(found: Found) -> Figure:
    figure = Figure(figsize=(9, 2.6), layout="constrained")
    parts = (
        ("comparator's offset", found.offsets),
        ("peak INL", found.inl),
        ("peak DNL", found.dnl),
        ("ENOB", found.enob),
    )
    for axes, (title, values), colour in zip(figure.subplots(1, len(parts)), parts, COLOURS, strict=False):
        axes.hist(values, bins=min(30, max(8, int(np.sqrt(len(values))))), color=colour)
        axes.set_title(title, fontsize=9, loc="left")
        axes.set_xlabel("bit" if title == "ENOB" else "LSB", fontsize=8)
        axes.tick_params(labelsize=7)
    return figure

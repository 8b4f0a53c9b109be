"""The page of the pixel's circuit: corners, characteristic, photon transfer, EMVA table."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from talbot.base import page
from talbot.base.charts import svg
from talbot.base.page import TABLES, Section, Tile
from talbot.models.parameters import ELEMENTARY_CHARGE

NAMES = ("pixel_circuit.html",)
HEAD = (
    "corner",
    "reset V",
    "full well e",
    "fF",
    "uV/e",
    "nonlinear %",
    "reset noise e",
    "read noise e",
    "dark noise e",
    "lag %",
    "lag, soft %",
    "dark e/s",
    "settling ns",
    "gates fF",
)


def write(folder: Path, s: dict[str, Any]) -> None:
    """Write the page into ``folder``, which exists."""
    e, usual = s["emva"], next(one for name, one in s["corners"].items() if name.startswith("tt_025"))
    text = page.render(
        TABLES,
        f"{s['process']}: the pixel in transistors",
        about=f"{len(s['corners'])} corners, {s['spread']['diodes']} diodes with mismatch; make pixel-circuit",
        tiles=[
            Tile(f"{usual['full_well']:,.0f} e", "full well"),
            Tile(f"{usual['dark_noise']:.1f} e", "noise in the dark, reset noise in it"),
            Tile(f"{e['dynamic_range_db']:.1f} dB", "dynamic range"),
            Tile(f"{100 * usual['lag']:.3f} %", "lag", "good" if s["passed"] else "bad"),
        ],
        sections=[
            Section(
                "Corners",
                "The netlist that LVS compares with the layout, with the drawn diffusions, the well's junction by "
                f"area and edge and the node's wire; {s['bench']['rows']} pixels on a column, a sink of "
                f"{1e6 * s['bench']['sink_a']:g} uA that needs {s['bench']['low_v']:g} V (assumed). The reset line is "
                f"at {s['bench']['gate_v']:g} V; lag, soft: at the supply of {s['supply_v']:g} V.",
                charts=[svg(_characteristics(s))],
                head=HEAD,
                rows=[_row(name, one) for name, one in s["corners"].items()],
            ),
            Section(
                "In the manner of EMVA 1288",
                "Simulated exposures of flat pictures through the sensor's models with the typical corner's figures, "
                "before the converter; columns and amplifiers have no noise here; the circuit's bend is not in them.",
                charts=[svg(transfer(s["emva"]))],
                head=("", "", "unit"),
                rows=_emva(s),
            ),
            Section(
                "Into sensor.toml",
                "What make sim SENSOR=sensor.toml takes. Offsets of the followers, "
                f"{s['spread']['offset_electrons']:,.0f} e rms, are not in it: they cancel where the reset level is "
                "read, too.",
                head=("parameter", "value"),
                rows=[(name, f"{value:g}") for name, value in s["sensor"].items()],
            ),
        ],
    )
    (folder / NAMES[0]).write_text(text, encoding="utf-8")


def _row(name: str, one: dict[str, Any]) -> tuple[str, ...]:
    return (
        name,
        f"{one['reset_v']:.3f}",
        f"{one['full_well']:,.0f}",
        f"{one['well_ff']:.2f}",
        f"{one['gain_uv']:.2f}",
        f"{100 * one['linearity']:.2f}",
        f"{one['reset_closed']:.1f}",
        f"{one['read_noise']:.1f}",
        f"{one['dark_noise']:.1f}",
        f"{100 * one['lag']:.4f}",
        f"{100 * one['lag_soft']:.1f}",
        f"{one['dark_current'] / ELEMENTARY_CHARGE:,.0f}",
        f"{one['settling_ns']:.0f}",
        f"{one['gates_ff']:.2f}",
    )


def _emva(s: dict[str, Any]) -> list[tuple[str, str, str]]:
    e = s["emva"]
    efficiency = [
        (f"quantum efficiency, beta {beta}", f"{100 * one['pixel']:.1f}", "% of the light on a pixel")
        for beta, one in s["quantum_efficiency"].items()
    ]
    return [
        *efficiency,
        ("responsivity", f"{e['responsivity']:.4f}", "e for one that the light makes"),
        ("temporal dark noise", f"{e['dark_noise']:.1f}", "e"),
        ("absolute sensitivity threshold", f"{e['threshold']:.1f}", "e of light"),
        ("saturation", f"{e['saturation']:,.0f}", "e"),
        ("SNR max", f"{e['snr_max_db']:.1f}", "dB"),
        ("dynamic range", f"{e['dynamic_range_db']:.1f}", "dB"),
        ("DSNU", f"{e['dsnu']:.1f}", "e (assumed, models/parameters)"),
        ("PRNU", f"{100 * e['prnu']:.2f}", "%"),
    ]


def _characteristics(s: dict[str, Any]) -> Figure:
    figure = Figure(figsize=(8, 3), layout="constrained")
    left, right = figure.subplots(1, 2)
    for name, one in s["corners"].items():
        electrons, volts = np.array(one["curve"]).T
        left.plot(electrons / 1e3, volts, linewidth=0.9, label=name.removesuffix("_3v30"))
        right.plot(electrons / 1e3, 1e2 * (volts - _line(electrons, volts)) / np.ptp(volts), linewidth=0.9)
    left.set(xlabel="1000 electrons", ylabel="V at the column")
    right.set(xlabel="1000 electrons", ylabel="off a line, % of the range")
    left.legend(fontsize=6, frameon=False)
    return figure


def _line(electrons: np.ndarray, volts: np.ndarray) -> np.ndarray:
    inside = slice(1, -1)  # 5 to 95 %
    return np.polyval(np.polyfit(electrons[inside], volts[inside], 1), electrons)


def transfer(emva: Mapping[str, Any]) -> Figure:
    """Return the photon-transfer curve of an `Emva` table."""
    value, variance, _ = np.array(emva["photon_transfer"]).T
    figure = Figure(figsize=(4.6, 3), layout="constrained")
    axes = figure.subplots()
    axes.plot(value, variance, "o", markersize=3)
    axes.plot(value, emva["gain"] * value, linewidth=0.9)
    axes.set(xlabel="mean above dark", ylabel="temporal variance above dark", ylim=(0, 1.2 * variance.max()))
    return figure

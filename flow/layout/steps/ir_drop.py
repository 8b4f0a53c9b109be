"""IR drop of supply and ground at every cell, from the mean current of the power step."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.base.steps import Files
from talbot.base.style import own_style
from talbot.flow.layout.power.mesh import Tap, drops, metal
from talbot.flow.layout.steps.corner import CornerStep
from talbot.platforms.layout import LayoutPlatform, layout_platform
from talbot.signoff.netlist.netlist import Netlist
from talbot.signoff.netlist.placed import MIRRORED

Rows = Sequence[Sequence[Any]]  # of the placement's JSON
Point = tuple[float, float]  # um
Values = npt.NDArray[np.float64]


@dataclass(frozen=True)
class IrDropParameters:
    """Process, and corner of the power."""

    pdk: str = "sky130"
    corner: str = ""


class IrDrop(CornerStep[IrDropParameters]):
    """Rails and straps as resistors, strap ends at the supply; static: the mean over the trace, no peaks.

    ir_drop_percent: the largest sum of both drops at a cell, of the supply. current_lost: share, by the solver.
    """

    name = "ir_drop_{corner}"
    inputs = {"netlist": "stream_out.netlist", "placement": "stream_out.placement", "plan": "stream_out.plan"}
    inputs |= {"areas": "library.areas", "power": "power_{corner}.instances"}
    outputs = {"picture": "ir_drop.png", "cells": "ir_drop.json"}
    metrics = {"supply_drop_mv": "mV", "ground_rise_mv": "mV", "ir_drop_percent": "%"}
    metrics |= {"current_ua": "uA", "current_lost": ""}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech = layout_platform(self.parameters.pdk)
        netlist, plan = Netlist.read(inputs["netlist"]), json.loads(inputs["plan"].read_text(encoding="utf-8"))
        placed = json.loads(inputs["placement"].read_text(encoding="utf-8"))
        areas, power = (json.loads(inputs[name].read_text(encoding="utf-8")) for name in ("areas", "power"))
        _, bottom, _, top = plan["core"]
        cells = currents(netlist, placed["instances"], areas, power, tech, bottom)
        rows, height = round((top - bottom) / tech.row_um), top - bottom
        found, lost = [], []
        for net, odd in (("vdd", 1), ("vss", 0)):  # rails of even rows are ground
            rails = list(range(odd, rows + 1, 2))
            straps = [x for supply, x in placed["straps"] if supply == net]
            taps = [Tap(rails.index(row + (row % 2 != odd)), x_um, ampere) for row, x_um, ampere in cells]
            heights = [row * tech.row_um for row in rails]
            drop, share = drops(heights, straps, height, taps, metal(tech))
            found.append(drop * 1000)
            lost.append(share)
        total = found[0] + found[1]
        at = [(cell.x_um, bottom + (cell.row + 0.5) * tech.row_um) for cell in cells]
        rounded = [[round(x, 3), round(y, 3), float(mv)] for (x, y), mv in zip(at, total, strict=True)]
        outputs["cells"].write_text(json.dumps(rounded, indent=0) + "\n", encoding="utf-8")
        picture(outputs["picture"], at, total, placed["straps"], plan)
        return {
            "supply_drop_mv": float(f"{found[0].max():.4g}"),
            "ground_rise_mv": float(f"{found[1].max():.4g}"),
            "ir_drop_percent": float(f"{total.max() / tech.supply_v / 10:.4g}"),
            "current_ua": round(sum(cell.ampere for cell in cells) * 1e6, 3),
            "current_lost": float(f"{max(lost):.1e}"),
        }


class Current(NamedTuple):
    """The current of a cell. x_um: of its middle."""

    row: int
    x_um: float
    ampere: float


def currents(
    netlist: Netlist,
    placed: Rows,
    areas: Mapping[str, float],
    power: Mapping[str, float],
    tech: LayoutPlatform,
    bottom: float = 0.0,
) -> list[Current]:
    """Currents of the cells that have one.

    placed: of the placement, in the netlist's order. areas: cell -> um2. power: instance -> uW. bottom: of the
    rows, um.
    """
    found = []
    for instance, (_, cell, x, y, orientation) in zip(netlist.instances, placed, strict=True):
        if instance.name in power:
            (across, up), width = MIRRORED[orientation], areas[cell] / tech.row_um
            row, middle = round((y - bottom) / tech.row_um) - (up < 0), x + across * width / 2
            found.append(Current(row, middle, power[instance.name] * 1e-6 / tech.supply_v))
    return found


@own_style()
def picture(path: Path, at: Sequence[Point], drop: Values, straps: Rows, plan: Mapping[str, Any]) -> None:
    """Draw the cells, coloured by the sum of their drops, mV; straps as lines."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 6), layout="constrained")
    axes = figure.subplots()
    x, y = np.transpose(at)
    for _, place in straps:
        axes.axvline(place, color="0.8", linewidth=1, zorder=0)
    shown = axes.scatter(x, y, c=drop, s=max(1.0, 20000 / len(at)), cmap="inferno", marker="s")
    figure.colorbar(shown, label="IR drop of supply and ground, mV")
    axes.set(xlim=(0, plan["width_um"]), ylim=(0, plan["height_um"]), aspect="equal", xlabel="µm", ylabel="µm")
    figure.savefig(path, dpi=130, metadata={"Software": None})

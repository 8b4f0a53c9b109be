"""Voltage drop of supply and ground at every cell, from the mean current of the power step."""

import json
from dataclasses import dataclass

import numpy as np

from base.steps import Step
from platforms.coriolis import coriolis_platform

from ..netlist.netlist import Netlist
from ..power import mesh as mesh_module
from ..power.mesh import drops, metal

MIRRORED = {"6", "2"}  # orientations of Hurricane (MY, R2) in which a cell hangs from its origin
LEFTWARDS = {"4", "2"}  # ... (MX, R2) in which it extends to the left of it


@dataclass(frozen=True)
class IrDropParameters:
    """pdk: process. corner: of the power."""

    pdk: str = "sky130"
    corner: str = ""


class IrDrop(Step):
    """Rails and straps as resistors, the straps' ends held at the supply. Static: the mean over the trace, no peaks.

    ir_drop_percent: the largest sum of both drops at a cell, of the supply. current_lost: by the solver, as a share.
    """

    inputs = {
        "netlist": "place_route.netlist",
        "placement": "place_route.placement",
        "plan": "floorplan.floorplan",
        "areas": "library.areas",
    }
    outputs = {"picture": "ir_drop.png", "cells": "ir_drop.json"}
    Parameters = IrDropParameters
    metrics = {
        "supply_drop_mv": "mV",
        "ground_rise_mv": "mV",
        "ir_drop_percent": "%",
        "current_ua": "uA",
        "current_lost": "",
    }
    uses = (mesh_module,)

    def __init__(self, parameters):
        super().__init__(parameters)
        self.name = f"ir_drop_{parameters.corner}"
        self.inputs = self.inputs | {"power": f"power_{parameters.corner}.instances"}

    def run(self, inputs, outputs):
        known = coriolis_platform(self.parameters.pdk)
        netlist, plan = Netlist.read(inputs["netlist"]), json.loads(inputs["plan"].read_text())
        placed = json.loads(inputs["placement"].read_text())
        cells = drawing(
            netlist,
            placed["instances"],
            json.loads(inputs["areas"].read_text()),
            json.loads(inputs["power"].read_text()),
            known,
        )
        rows = round(plan["height_um"] / known.row_um)
        found, lost = [], []
        for net, odd in (("vdd", 1), ("vss", 0)):  # rails of even rows are ground
            rails = list(range(odd, rows + 1, 2))
            straps = [x for supply, x, _ in placed["straps"] if supply == net]
            gaps = [(x, *gap) for supply, x, cut in placed["straps"] if supply == net for gap in cut]
            taps = [(rails.index(row if row % 2 == odd else row + 1), x, current) for row, x, current in cells]
            drop, share = drops(
                [row * known.row_um for row in rails],
                straps,
                plan["height_um"],
                taps,
                metal(known),
                breaks(plan["macros"]),
                gaps,
            )
            found.append(drop * 1000)
            lost.append(share)
        total = found[0] + found[1]
        at = [(x, (row + 0.5) * known.row_um) for row, x, _ in cells]
        outputs["cells"].write_text(
            json.dumps([[round(x, 3), round(y, 3), float(mv)] for (x, y), mv in zip(at, total, strict=True)], indent=0)
            + "\n"
        )
        picture(outputs["picture"], at, total, placed["straps"], plan)
        return {
            "supply_drop_mv": float(f"{found[0].max():.4g}"),
            "ground_rise_mv": float(f"{found[1].max():.4g}"),
            "ir_drop_percent": float(f"{total.max() / known.supply_v / 10:.4g}"),
            "current_ua": round(sum(current for *_, current in cells) * 1e6, 3),
            "current_lost": float(f"{max(lost):.1e}"),
        }


def drawing(netlist, placed, areas, power, known):
    """(row, x of its middle in um, A) of every cell that draws a current. placed: of the placement, in the netlist's
    order. power: instance -> uW."""
    found = []
    for instance, (_, cell, x, y, orientation) in zip(netlist.instances, placed, strict=True):
        if instance.name in power:
            width = areas[cell] / known.row_um
            row = round(y / known.row_um) - (orientation in MIRRORED)
            middle = x + width / 2 * (-1 if orientation in LEFTWARDS else 1)
            found.append((row, middle, power[instance.name] * 1e-6 / known.supply_v))
    return found


def breaks(macros):
    """Boxes in which there are no rails: on the west and the east of the floorplan's blocks."""
    return [
        (left, m["y_um"], right, m["y_um"] + m["height_um"])
        for m in macros
        for left, right in ((m["outer"][0], m["x_um"]), (m["x_um"] + m["width_um"], m["outer"][2]))
    ]


def picture(path, at, drop, straps, plan):
    """Cells by the sum of their drops, mV; straps as lines."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 6), layout="constrained")
    axes = figure.subplots()
    x, y = np.transpose(at)
    for _, place, _ in straps:
        axes.axvline(place, color="0.8", linewidth=1, zorder=0)
    shown = axes.scatter(x, y, c=drop, s=max(1.0, 20000 / len(at)), cmap="inferno", marker="s")
    figure.colorbar(shown, label="supply's drop and ground's rise, mV")
    axes.set(xlim=(0, plan["width_um"]), ylim=(0, plan["height_um"]), aspect="equal", xlabel="um", ylabel="um")
    figure.savefig(path, dpi=130, metadata={"Software": None})

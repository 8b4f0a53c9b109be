"""The summary of a run: the figures of the contract of flow.layout, of OpenROAD's stages and of the checks."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from talbot.base.liberty.read import areas
from talbot.base.steps import Runner
from talbot.base.steps.versions import version
from talbot.flow.layout.design import Design
from talbot.flow.layout.options import Options
from talbot.flow.layout.report.metrics import RULES as LAYOUT_RULES
from talbot.flow.layout.report.metrics import Attempt
from talbot.flow.layout.report.metrics import broken as breaks
from talbot.flow.layout.report.metrics import summarize as of_steps
from talbot.flow.layout.steps.power import wire_pf
from talbot.platforms.openroad import WIRES, OpenRoadPlatform
from talbot.signoff.netlist.netlist import Netlist, is_register

ROUTE = re.compile(r"(?:\+ ROUTED|NEW) ([^+;]*?)(?=\bNEW\b|[+;])")
RULES = LAYOUT_RULES | {
    name: {"is": 0}
    for name in ("router_drc_violations", "router_antennas", "slew_violations", "capacitance_violations")
}
RULES |= {name: {"least": 0} for name in ("wns_ns", "whs_ns")}


def summarize(
    design: Design,
    tech: OpenRoadPlatform,
    found: Mapping[str, float],
    folder: Path,
    size_um: tuple[float, float],
    checked: Runner,
) -> dict[str, Any]:
    """Return the figures of a run; None for those that are not measured.

    found: figures of the stages' logs. folder: of the run. size_um: (width, height) of the die. checked: the checks.
    """
    netlist = Netlist.read(checked.paths["stream_out.netlist"])
    um2 = areas(checked.paths["library.liberty"])
    slacks = {name: worst(found, name, tech.corners) for name in ("wns_ns", "whs_ns")}
    spefs = {"placement": f"placement_{tech.corners[0]}", "global routes": f"global_{tech.corners[0]}"}
    spefs |= {wires: wires for wires in WIRES}  # estimates have a file a corner, extraction one
    wires = {name: total_pf(folder / f"{file}.spef") for name, file in spefs.items()}
    slowest = slacks["wns_ns"][tech.corners[0]]
    options = Options(pdk=tech.name, utilization=tech.utilization)
    made = of_steps(design, options, checked, [Attempt(tech.utilization, 1.0, tech.utilization)])
    by_wires = {
        name: sum(value for key, value in found.items() if key.startswith(f"{name}.")) or 0
        for name in ("slew_violations", "capacitance_violations")
    }
    return made | {
        "backend": "openroad",
        "cells": len(netlist.instances),
        "flip_flops": sum(is_register(i.cell) for i in netlist.instances),
        "cell_area_um2": round(sum(um2.get(i.cell, 0.0) for i in netlist.instances), 2),
        "area_um2": round(size_um[0] * size_um[1], 2),
        "attempts": [],
        "wire_um": wire_um((folder / "final.def").read_text(encoding="utf-8")),
        **{name: found.get(name) for name in ("open_nets", "router_drc_violations", "router_antennas")},
        "clock_buffers": sum(i.name.startswith("clkbuf") for i in netlist.instances),
        "antenna_diodes": sum(i.cell == tech.diode for i in netlist.instances),
        **by_wires,
        **slacks,
        "slacks_by_wires": {key: value for key, value in found.items() if key.startswith(("wns_ns.", "whs_ns."))},
        "estimated_ns": {name: found.get(f"estimated_{name}_ns") for name in ("setup", "hold")},
        "wire_pf": wires.get(WIRES[0]),
        "wire_pf_by_source": wires,
        "f_max_mhz": None if slowest is None else round(1000 / (design.clock.period_ns - slowest), 2),
        "placement_density": found.get("placement_density"),
        "timing_rests_on": f"{tech.library}'s Liberty; OpenRCX, with coupling, at {', '.join(WIRES)}",
        **{name: _parts(found, part) | made[name] for name, part in (("wall_s", "seconds."), ("peak_mib", "mib."))},
        "tools": made["tools"] | {"openroad": version("openroad")},
    }


def worst(found: Mapping[str, float], name: str, corners: Sequence[str]) -> dict[str, float | None]:
    """Return the least of the figure ``name`` over the wires' corners, by corner of the cells."""
    return {corner: min((v for key, v in found.items() if _of(key, name, corner)), default=None) for corner in corners}


def _parts(found: Mapping[str, float], prefix: str) -> dict[str, float]:
    return {key.removeprefix(prefix): value for key, value in found.items() if key.startswith(prefix)}


def _of(key: str, name: str, corner: str) -> bool:
    """Return whether ``key`` is 'name.<wires>.corner'."""
    return key.startswith(f"{name}.") and key.endswith(f".{corner}")


def total_pf(path: Path) -> float | None:
    """Capacitance of all nets of a SPEF, pF; None without the file."""
    return round(sum(wire_pf(path.read_text(encoding="utf-8")).values()), 3) if path.is_file() else None


def wire_um(text: str) -> float:
    """Length of all nets' routes in the DEF ``text``, um, without those of the supplies."""
    units = re.search(r"UNITS DISTANCE MICRONS (\d+)", text)
    nets = re.search(r"(?ms)^NETS .*?^END NETS", text)
    if not units or not nets:
        return 0.0
    length = 0
    for segment in ROUTE.findall(nets[0]):
        at: list[int] = []
        for point in re.findall(r"\(([^()]*)\)", segment):
            words = point.split()
            if len(words) > 3:  # a patch
                continue
            to = [at[k] if word == "*" else int(word) for k, word in enumerate(words[:2])]
            length += sum(abs(new - old) for new, old in zip(to, at or to, strict=True))
            at = to
    return round(length / int(units[1]), 3)


def broken(summary: dict[str, Any]) -> list[str]:
    """Rules that ``summary`` breaks: lines; a figure that is missing breaks its rule."""
    return breaks(summary, RULES)

"""The library's cells characterized at the process's corners: delays, slews, energies, setup and hold as Liberty."""

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from talbot.base import jobs
from talbot.base.liberty.read import read
from talbot.base.liberty.write import text
from talbot.base.steps import Files, Step, StepError
from talbot.flow.layout import tables
from talbot.platforms.extraction import ExtractionPlatform, device_models, extraction_platform

if TYPE_CHECKING:
    from talbot.cells.characterize.conditions import Conditions
    from talbot.cells.characterize.job import Source

NS = 1e-9


@dataclass(frozen=True)
class TimingParameters:
    """Corners, device models, and points of the tables' axes; constraint_slews_ns: of setup and hold.

    measured: now, although tables of these cells are shipped.

    `make cells` has seven to nine points an axis and takes four times as long.
    """

    pdk: str = "sky130"
    corners: tuple[str, ...] = ()
    models: str = "fitted"
    slews_ns: tuple[float, ...] = field(default=(0.01, 0.1, 0.4, 1.5), metadata={"unit": "ns"})
    loads: int = 4
    constraint_slews_ns: tuple[float, ...] = field(default=(0.05, 0.6), metadata={"unit": "ns"})
    measured: bool = False


class Timing(Step[TimingParameters]):
    """Each cell with its parasitics in ngspice, as in `make cells`; a cell once measured is kept by itself.

    Where the tables that are shipped are of these cells and conditions, they are taken.
    """

    name = "timing"
    inputs = {"gds": "library.gds", "areas": "library.areas", "functions": "library.liberty"}
    metrics = {"cells": "", "simulations": "", "failed": "", "key": "", "shipped": ""}
    shared = True
    tools = ("ngspice",)

    def __init__(self, parameters: TimingParameters) -> None:
        super().__init__(parameters)
        self.outputs = {corner: f"{corner}.lib" for corner in parameters.corners}

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        from talbot.cells.characterize.job import cell_of, job
        from talbot.cells.liberty import build

        p = self.parameters
        models, sources = device_models(p.pdk), sources_of(inputs, extraction_platform(p.pdk))
        conditions = conditions_of(p)
        key = tables.key(sources, conditions, models, inputs["areas"], inputs["functions"])
        metrics = {"cells": len(sources), "failed": 0, "key": key}
        if not p.measured and (found := tables.shipped(p.pdk, key)):
            for corner, written in found[0].items():
                outputs[corner].write_text(written, encoding="utf-8")
            return metrics | {"simulations": found[1], "shipped": True}
        todo = [(source, condition) for condition in conditions for source in sources]
        todo.sort(key=lambda pair: -len(pair[0].netlist))  # the longest first
        store = next(iter(outputs.values())).parents[1] / "cells"
        names = [(source.name, condition.corner.name) for source, condition in todo]
        made = jobs.run([job(source, condition, models) for source, condition in todo], store, "cells")
        measured = dict(zip(names, made, strict=True))
        failed = [f"{' '.join(n)}: {f['what']}: {f['why']}" for n, one in measured.items() for f in one["failed"]]
        if failed:
            raise StepError(f"timing: {len(failed)} measurements failed, first {failed[0]}")
        cells, areas = (
            [cell_of(source, models) for source in sources],
            json.loads(inputs["areas"].read_text(encoding="utf-8")),
        )
        constants = {}
        for cell in read(inputs["functions"]).all("cell"):
            if not cell.all("pin", direction="input"):
                levels = {pin.name: int(pin.text("function")) for pin in cell.all("pin")}
                constants[cell.name] = build.Constant(levels, areas[cell.name])
        for condition in conditions:
            corner, pairs = condition.corner.name, zip(cells, sources, strict=True)
            entries = [build.Entry(cell, measured[source.name, corner], source.area) for cell, source in pairs]
            outputs[corner].write_text(
                text(build.library(f"{p.pdk}__{corner}", condition, entries, models, constants)), encoding="utf-8"
            )
        return metrics | {"simulations": sum(one["simulations"] for one in made), "shipped": False}


def conditions_of(p: TimingParameters) -> "list[Conditions]":
    """The conditions of each corner."""
    from talbot.cells.characterize.conditions import Conditions
    from talbot.cells.corner import Corner

    slews, constraint_slews = (tuple(NS * slew for slew in ns) for ns in (p.slews_ns, p.constraint_slews_ns))
    grid = {"extra": 0, "loads": p.loads, "slews": slews, "constraint_slews": constraint_slews}
    return [Conditions(Corner.parse(corner), p.models, **grid) for corner in p.corners]


def sources_of(inputs: Files, tech: ExtractionPlatform) -> "list[Source]":
    """The cells with an input, as the library's functions name them, with their parasitics."""
    from talbot.cells.characterize.job import Source
    from talbot.cells.extract.subcircuit import extract

    areas = json.loads(inputs["areas"].read_text(encoding="utf-8"))
    cells = read(inputs["functions"]).all("cell")
    names = [cell.name for cell in cells if cell.all("pin", direction="input")]
    return [Source(name, extract(inputs["gds"], name, tech), areas[name]) for name in names]

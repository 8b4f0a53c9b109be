"""The library's cells measured at the process's corners: delays, slews, energies, setup and hold as Liberty."""

import json
import re
from dataclasses import dataclass, field

from base import jobs
from base.steps import Step, StepError
from platforms.extraction import device_models, extraction_platform

NS = 1e-9


@dataclass(frozen=True)
class TimingParameters:
    """pdk: process. corners: names. models: set of device models. slews_ns, loads: points of a table's axes;
    constraint_slews_ns: of setup's and hold's. `make cells` has seven to nine points an axis and takes four times as
    long."""

    pdk: str = "sky130"
    corners: tuple = ()
    models: str = "fitted"
    slews_ns: tuple = field(default=(0.01, 0.1, 0.4, 1.5), metadata={"unit": "ns"})
    loads: int = 4
    constraint_slews_ns: tuple = field(default=(0.05, 0.6), metadata={"unit": "ns"})


class Timing(Step):
    """Each cell with its stray capacitances in ngspice, as in `make cells`; a cell measured once is kept by itself."""

    name = "timing"
    inputs = {"gds": "library.gds", "areas": "library.areas", "functions": "library.liberty"}
    Parameters = TimingParameters
    metrics = {"cells": "", "simulations": "", "failed": ""}
    shared = True
    tools = ("ngspice",)

    def __init__(self, parameters):
        super().__init__(parameters)
        self.outputs = {corner: f"{corner}.lib" for corner in parameters.corners}

    def run(self, inputs, outputs):
        from base.liberty import write
        from cells.characterize.conditions import Conditions
        from cells.characterize.job import cell_of, job
        from cells.corner import Corner
        from cells.liberty import build

        p = self.parameters
        models, sources = device_models(p.pdk), found(inputs, extraction_platform(p.pdk))
        conditions = [
            Conditions(
                Corner.parse(corner),
                p.models,
                extra=0,
                loads=p.loads,
                slews=tuple(NS * slew for slew in p.slews_ns),
                constraint_slews=tuple(NS * slew for slew in p.constraint_slews_ns),
            )
            for corner in p.corners
        ]
        todo = [(source, condition) for condition in conditions for source in sources]
        todo.sort(key=lambda pair: -len(pair[0].netlist))  # what takes longest goes first
        store = next(iter(outputs.values())).parents[1] / "cells"
        measured = dict(
            zip(
                ((s.name, c.corner.name) for s, c in todo),
                jobs.run([job(source, condition, models) for source, condition in todo], store, "cells"),
                strict=True,
            )
        )
        failed = [
            f"{name} {corner}: {f['what']}: {f['why']}"
            for (name, corner), made in measured.items()
            for f in made["failed"]
        ]
        if failed:
            raise StepError(f"timing: {len(failed)} measurements failed, first {failed[0]}")
        cells, areas = [cell_of(source, models) for source in sources], json.loads(inputs["areas"].read_text())
        constants = {
            name: ({pin: int(level)}, areas[name])
            for name, pin, level in re.findall(
                r'cell\((\w+)\) \{[^\n]*\n +pin\((\w+)\) \{ direction : output; function : "([01])"',
                inputs["functions"].read_text(),
            )
        }
        for condition in conditions:
            corner = condition.corner.name
            tree = build.library(
                f"{p.pdk}__{corner}",
                condition,
                [
                    (cell, measured[source.name, corner], source.area)
                    for cell, source in zip(cells, sources, strict=True)
                ],
                models,
                constants,
            )
            outputs[corner].write_text(write.text(tree) + "\n")
        return {"cells": len(cells), "simulations": sum(made["simulations"] for made in measured.values()), "failed": 0}


def found(inputs, tech):
    """cells.characterize.job.Source of every cell with an input that the library's functions name."""
    from cells.characterize.job import Source
    from cells.extract import extract

    areas = json.loads(inputs["areas"].read_text())
    groups = re.split(r"(?m)^ cell\(", inputs["functions"].read_text())[1:]
    names = [group[: group.index(")")] for group in groups if "direction : input" in group]
    return [Source(name, extract(inputs["gds"], name, tech), areas[name]) for name in names]

"""Switching energy of the digital part, event by event, from frames at the gates of the chip's layout."""

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from talbot.base.cache import digest
from talbot.base.command import failures
from talbot.base.files import staged, write
from talbot.base.paths import RESULTS
from talbot.base.progress import Steps
from talbot.base.steps import Runner, Step, StepError
from talbot.flow.layout.chain import all_steps, input_files, timing_steps
from talbot.flow.layout.design import Design, design, folder_name
from talbot.flow.layout.energy.frames import EVERY, HELD_BACK, RECORDED, frame_named
from talbot.flow.layout.energy.measure import CountingBench, FrameParameters, Light, Measure, Slews, Transitions
from talbot.flow.layout.energy.report import page, text
from talbot.flow.layout.energy.result import WORST, Frame, evaluate
from talbot.flow.layout.options import Options
from talbot.flow.layout.search import lay_out_smallest
from talbot.flow.layout.steps.extraction import Extraction
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.steps.power import PowerParameters
from talbot.models.parameters import ParameterError
from talbot.platforms.processes import PROCESSES

DESIGN = "asp_chip"
WITH_DELAYS = "stimulus", "sta", "gate_delays", "power"  # what the frame with delays takes, at the first corner


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot layout-energy`."""
    add = parser.add_argument
    cells = "characterized cells at a corner (again for further corners; default: those shipped)"
    add("--liberty", type=Path, action="append", default=[], help=cells)
    add("--layouts", type=Path, default=RESULTS / "layout", help="folder of the layouts, as of make layout")
    add("--out", type=Path, default=RESULTS / "layout" / "energy", help="folder of the table and the page")


def run(options: Namespace) -> int:
    """Measure the frames, fit them and print the table; 1 where the held-back frame is off by more than WORST."""
    chosen, pdk = design(DESIGN), PROCESSES[0]
    asked = Options(pdk, chosen.utilization, tuple(options.liberty))
    corner = asked.corners[0]
    steps = energy_steps(PowerParameters(chosen.top, corner, chosen.clock.period_ns))
    names = [step.name for step in (*all_steps(chosen, asked, signoff), *steps)]
    with Steps(names, lines=True) as bar:
        folder = options.layouts / folder_name(chosen, pdk)
        files = input_files(chosen, asked, folder)
        runner = Runner(folder / "steps", files, bar.note, options.layouts / "shared")
        if lay_out_smallest(chosen, asked, runner, signoff)[-1].rules_broken != 0:
            raise StepError(f"{DESIGN}: no attempt of the layout closes")
        runner.run_all(steps)
    summary = summarize(runner.records, corner) | provenance(runner, corner)
    with staged(options.out) as part:
        write(part / "energy.json", json.dumps(summary, indent=1) + "\n")
        write(part / "energy.html", page(summary))
    print(text(summary))
    print(f"  look at {options.out / 'energy.html'}")
    off = summary["held_back"]["residual"]
    wrong = [f"residual of the held-back frame = {off:.3f}: must be at most {WORST}"] if abs(off) > WORST else []
    return failures(wrong)


def energy_steps(parameters: PowerParameters) -> list[Step]:
    """The steps after those of the layout, at the corner of ``parameters``."""
    lit = [frame_named(name) for name in dict.fromkeys(frame.lit_as for frame in EVERY)]
    return [
        CountingBench(),
        *(Light(FrameParameters(frame)) for frame in lit),
        *(Transitions(FrameParameters(frame)) for frame in EVERY),
        Slews(parameters),
        Measure(parameters),
    ]


def signoff(design: Design, options: Options) -> list[Step]:
    """The steps after a routing that the energies rest on."""
    first = options.corners[:1]
    if not first:
        raise ParameterError("liberty = none: must be characterized cells")
    wanted = {name if name == "stimulus" else f"{name}_{first[0]}" for name in WITH_DELAYS}
    timed = [step for step in timing_steps(design, options) if step.name in wanted]
    return [Extraction(PdkParameters(options.pdk)), *timed]


def summarize(records: Mapping[str, dict[str, Any]], corner: str) -> dict[str, Any]:
    """Content of energy.json but for the provenance. records: of all steps, by name."""
    metrics = {name: record["metrics"] for name, record in records.items()}
    energy = metrics[f"energy_{corner}"]
    made = {
        frame.name: Frame.of(frame, metrics[f"transitions_{frame.name}"], energy["frames"][frame.name])
        for frame in EVERY
    }
    others = made.pop(HELD_BACK.name), made.pop(RECORDED.name)
    known = {"corner": corner, "supply_v": energy["supply_v"], "leakage_uw": energy["leakage_uw"]}
    return known | evaluate(list(made.values()), *others, records[f"power_{corner}"])


def provenance(runner: Runner, corner: str) -> dict[str, Any]:
    """Design, tools, and digests of the layout's files that the energies were computed from, by name."""
    steps = CountingBench, Measure(PowerParameters(corner=corner))
    inputs = {name: source for step in steps for name, source in step.inputs.items()}
    known = {name: digest(runner.paths[source]) for name, source in inputs.items() if not source.endswith(".counts")}
    tools = {
        k: v for record in runner.records.values() for k, v in record["tools"].items() if k in ("iverilog", "openroad")
    }
    return {"design": DESIGN, "pdk": PROCESSES[0], "inputs": known, "tools": tools}

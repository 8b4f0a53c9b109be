"""Stuck-at coverage of the chip's gates by a functional test at its pins: build/verify/stuck_at.json.

A sample of the faults, or all of them. The exit status is 1 where the test itself fails without a fault.
"""

from argparse import ArgumentParser, Namespace
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from talbot.base.arguments import whole_of
from talbot.base.command import failures
from talbot.base.jobs import Job
from talbot.base.jobs import run as run_jobs
from talbot.base.records import from_json
from talbot.models.chip import golden_frame
from talbot.models.digital.pattern import PatternEnd
from talbot.models.parameters import ArrayParameters, ChipParameters, SensorParameters, check_int
from talbot.rtl.export import translate
from talbot.verif.formal.engine import version
from talbot.verif.results import OUT, BlockResults, StuckAt, seed_of, write_step
from talbot.verif.stuck_at.faults import OUTPUT, collapsed
from talbot.verif.stuck_at.netlist import OPERATORS, synthesize
from talbot.verif.stuck_at.simulate import Simulator
from talbot.verif.stuck_at.stimulus import RESET, bits, frames, functional_test

ROWS, COLS = 8, 13
SENSOR = SensorParameters(array=ArrayParameters(ROWS, COLS), chip=ChipParameters(lanes=2))
SETTLED = RESET - 2  # cycles of reset until all registers have their values


@dataclass(frozen=True)
class Place:
    """A fault of the sample. pin: 'output' or 'input 0' ... of the gate. stuck_at: 0 or 1."""

    block: str
    gate: str
    kind: str
    pin: str
    stuck_at: int
    detected: bool


@dataclass(frozen=True)
class Measured:
    """The sample of ``faults``. cycles: of the test. problem: of the test without a fault, or ''."""

    faults: int
    cycles: int
    places: list[Place]
    problem: str = ""


def measure(sample: int, seed: int) -> Measured:
    """Try ``sample`` faults, all for 0. Raises ToolError."""
    gates = synthesize(translate("AspChip", SENSOR), "AspChip")
    inputs = functional_test(SENSOR, seed)
    simulator = Simulator(gates, bits(gates.inputs, inputs), SETTLED, seed)
    sent = (simulator.output("link_val") & inputs["link_rdy"] & simulator.output("frame_sync")).astype(bool)
    golden = b"".join(golden_frame(np.zeros(0), SENSOR, f, PatternEnd(ROWS, COLS)).stream for f in frames(SENSOR))
    stream = simulator.output("link_data")[sent].astype(np.uint8).tobytes()
    every, cycles = collapsed(gates), len(simulator.stimulus)
    if not stream.startswith(golden):
        problem = f"stream = {len(stream)} bytes: must begin with the golden frames, {len(golden)} bytes"
        return Measured(len(every), cycles, [], problem)
    count = min(sample or len(every), len(every))
    chosen = np.sort(np.random.default_rng(seed).choice(len(every), count, replace=False))
    faults = [every[i] for i in chosen]
    places = [
        Place(
            gates.block(fault.gate),
            gates.names[fault.gate],
            OPERATORS[gates.kinds[fault.gate]],
            "output" if fault.pin == OUTPUT else f"input {fault.pin}",
            fault.value,
            bool(detected),
        )
        for fault, detected in zip(faults, simulator.detected(faults), strict=True)
    ]
    return Measured(len(every), cycles, places)


SEED_OPTION = seed_of("of the sample and of what is random at the pins")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot stuck-at`."""
    parser.add_argument("--sample", type=whole_of, default=500, help="faults, of all; 0: all")
    SEED_OPTION.add(parser)
    parser.add_argument("--out", type=Path, default=OUT, help="folder of stuck_at.json")


def run(options: Namespace) -> int:
    """Print the coverage by block; the kept result has every fault of the sample."""
    check_int("sample", options.sample, 0, 10**9)
    seed = SEED_OPTION.value(options)
    inputs = options.sample, seed, version("yosys")
    job = Job("stuck-at", measure, (options.sample, seed), inputs)
    measured = from_json(Measured, run_jobs([job], options.out / "stuck_at", "stuck-at", 1)[0])
    total, hit = (
        Counter(place.block for place in places)
        for places in (measured.places, [place for place in measured.places if place.detected])
    )
    result = StuckAt(measured.faults, total.total(), hit.total()) if measured.places else None
    points = [measured.problem] if measured.problem else []
    write_step("stuck_at", {"AspChip": BlockResults(stuck_at=result, open_points=points)}, options.out)
    for block in sorted(total):
        print(f"{block:10} {hit[block]:6} of {total[block]:6}  {hit[block] / total[block]:6.1%}")
    if result:
        share = f"{result.share:.1f} % +- {result.margin:.1f} %"
        print(f"{result.sample} of {result.faults} faults, {measured.cycles} cycles: {share} detected")
    return failures(points)

"""The steps of a layout, in order, for a design and a process."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from talbot.base.files import write
from talbot.base.liberty.read import plain, text_of
from talbot.base.steps import Step
from talbot.flow.layout.design import Design
from talbot.flow.layout.options import LEAST_UTILIZATION, Options, corner_of
from talbot.flow.layout.steps.antenna import Antenna
from talbot.flow.layout.steps.block_liberty import BlockLiberty, BlockLibertyParameters
from talbot.flow.layout.steps.compiled import Compiled
from talbot.flow.layout.steps.drc import Drc
from talbot.flow.layout.steps.equivalence import Equivalence, EquivalenceParameters
from talbot.flow.layout.steps.extraction import Extraction, RoutedExtraction
from talbot.flow.layout.steps.fill import Fill, RoutedFill
from talbot.flow.layout.steps.gate_delays import GateDelays, GateDelaysParameters
from talbot.flow.layout.steps.gate_frames import GateFrames, GateFramesParameters
from talbot.flow.layout.steps.gate_tests import GateTests, GateTestsParameters
from talbot.flow.layout.steps.ir_drop import IrDrop, IrDropParameters
from talbot.flow.layout.steps.leakage import Leakage, LeakageParameters
from talbot.flow.layout.steps.lef import Lef
from talbot.flow.layout.steps.library import Library
from talbot.flow.layout.steps.lvs import Lvs
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.steps.power import Power, PowerParameters
from talbot.flow.layout.steps.sta import Sta, StaParameters
from talbot.flow.layout.steps.stage import STAGES, Stage, StageParameters, called, design_tcl, scripts
from talbot.flow.layout.steps.stimulus import SMALL, Stimulus, StimulusParameters
from talbot.flow.layout.steps.stream_out import RoutedStreamOut, StreamOut, StreamOutParameters
from talbot.flow.layout.steps.synthesis import SynthesisParameters, TimedSynthesis
from talbot.flow.layout.steps.timing import Timing, TimingParameters
from talbot.flow.layout.timing.constraints import sdc
from talbot.flow.layout.variables import Floor
from talbot.flow.layout.verilog import verilog_text
from talbot.platforms.wires import wire_corner
from talbot.rtl.verilog import export_verilog
from talbot.signoff.foundry_drc import FoundryDrc, FoundryDrcParameters, MagicDrc

Signoff = Callable[[Design, Options], list[Step]]

FAN_OUT = 12  # most cells that one signal drives, where synthesis knows the cells' timing
# Of the whole chip, whose netlist with delays simulates a thousand times slower than a block's
CHIP_TILES = 1
UTILIZATION_STEP = 0.04  # between two attempts


def input_files(design: Design, options: Options, folder: Path) -> dict[str, Path]:
    """Export the design's Verilog and constraints into ``folder``; all files that the steps are given, by name.

    Raises ToolError where the export fails.
    """
    if design.verilog:
        write(folder / "rtl" / f"{design.top}.sv", verilog_text(design.verilog))
    else:
        export_verilog(folder / "rtl", [design.top], design.options)
    constraints, before = (folder / "rtl" / f"{design.top}{suffix}.sdc" for suffix in ("", ".place_and_route"))
    constraints.write_text(sdc(design), encoding="utf-8")
    before.write_text(sdc(design, propagated=False), encoding="utf-8")
    return {
        "rtl": folder / "rtl" / f"{design.top}.sv",
        "sdc": constraints,
        "place_and_route_sdc": before,
        **scripts(),
        **{f"timing.{corner_of(path)}": _plain(path, folder / "rtl") for path in options.liberty},
        **{f"foundry.{name}": path for name, path in options.decks},
    }


def _plain(path: Path, folder: Path) -> Path:
    """A copy of a Liberty file in ``folder`` that all tools read."""
    copy = folder / f"{corner_of(path)}.lib"
    write(copy, plain(text_of(path)))
    return copy


def synthesis_steps(design: Design, options: Options) -> list[Step]:
    """The steps before a floorplan."""
    timing = [] if options.liberty else [Timing(TimingParameters(options.pdk, options.corners))]
    parameters = SynthesisParameters(design.top, design.clock.port, design.clock.period_ns, FAN_OUT, design.io.load_pf)
    synthesis = TimedSynthesis(parameters, options.corners[0], slowest(options.corners))
    return [Library(PdkParameters(options.pdk)), *timing, synthesis]


def floors(design: Design, options: Options) -> Iterator[Floor]:
    """Outlines, the smallest first; a frame is one alone."""
    number = 0 if design.frame else int((options.utilization - LEAST_UTILIZATION) / UTILIZATION_STEP + 1e-9)
    for k in range(number + 1):
        yield Floor(round(options.utilization - UTILIZATION_STEP * k, 4), design.aspect)


def stages(design: Design, options: Options, floor: Floor) -> list[Step]:
    """The stages of place and route in OpenROAD, and the layout that they end in.

    Between `mend` and `thresholds` the parasitics of the routed layout.
    """
    common = options.pdk, design.top, options.corners
    own: dict[str, StageParameters] = {
        "floorplan": StageParameters(*common, "floorplan", floor, design.frame),
        "power": StageParameters(*common, "power", frame=design.frame),
        "place": StageParameters(*common, "place", frame=design.frame, closed=design.closed),
        "cts": StageParameters(*common, "cts", clock=design.clock.port),
        "thresholds": StageParameters(*common, "thresholds", clock=design.clock.port),
    }
    steps: list[Step] = [Stage(own.get(name, StageParameters(*common, name))) for name in STAGES]
    first, pdk = list(STAGES).index("thresholds"), PdkParameters(options.pdk)
    out = StreamOutParameters(options.pdk, design.frame)
    routed = RoutedStreamOut(out), RoutedFill(pdk), RoutedExtraction(pdk)
    return [*steps[:first], *routed, *steps[first:], StreamOut(out)]


def scripts_of(design: Design, options: Options, utilization: float, paths: Mapping[str, Path]) -> dict[str, str]:
    """What a user's own OpenROAD needs for the stages: texts by file name. paths: of a Runner, by its names."""
    floor, named = Floor(utilization, design.aspect), StageParameters(options.pdk, design.top, options.corners)
    whole = replace(named, floor=floor, frame=design.frame, closed=design.closed, clock=design.clock.port)
    files = {"design.tcl": design_tcl(whole)}
    for step in stages(design, options, floor):
        if isinstance(step, Stage) and step.name != "thresholds":
            files |= {
                called(whole, step.name)[name]: paths[source].read_text("utf-8")
                for name, source in step.inputs.items()
                if name not in ("database", "raised")
            }
    return files


def checks(options: Options) -> list[Step]:
    """The steps that decide whether a layout keeps the design rules."""
    return [step(PdkParameters(options.pdk)) for step in (Fill, Drc, Antenna)]


def slowest(corners: Sequence[str]) -> str:
    """That of ``corners`` with the slowest cells and wires; '' where there is none."""
    return next((corner for corner in corners if wire_corner(corner) == "max"), next(iter(corners), ""))


def signoff_steps(design: Design, options: Options) -> list[Step]:
    """The steps after a routing that keeps the design rules: all other checks, timing, power."""
    deck = FoundryDrcParameters(options.pdk, design.top)
    foundry = [{"klayout": FoundryDrc, "magic": MagicDrc}[name](deck) for name, _ in options.decks]
    return [
        Compiled(PdkParameters(options.pdk)),
        Equivalence(EquivalenceParameters(design.top, design.clock.port, design.reset)),
        *netlist_tests(design),
        *foundry,
        *(step(PdkParameters(options.pdk)) for step in (Lef, Extraction, Lvs)),
        *timing_steps(design, options),
    ]


def netlist_tests(design: Design) -> list[Step]:
    """The block's tests on both netlists, in both simulators, a wrapper's in Icarus; of the chip, whole frames.

    None of a user's Verilog, and of a block in a size that its tests do not have.
    """
    if design.is_chip:
        return [GateFrames(GateFramesParameters(design.options))]
    if not design.netlist_names:
        return []
    block = design.folder, design.netlist_names, design.top
    runs = ("synthesized", "icarus"), ("final", "icarus"), ("final", "verilator")
    if design.frame:
        runs = runs[:2]  # behind a host with a clock of its own, a bench for Icarus
    return [GateTests(GateTestsParameters(*block, netlist, simulator)) for netlist, simulator in runs]


def timing_steps(design: Design, options: Options) -> list[Step]:
    """The steps that require characterized cells, corner by corner.

    Of the chip, whose frames take minutes with delays, simulation and power run at the first corner alone; of a user's
    Verilog neither runs.
    """
    clock, io = design.clock, design.io
    parameters = StimulusParameters(design.top, design.folder, design.options, CHIP_TILES)
    if design.netlist_names:
        around = *SMALL, f"--divider={design.divider}", f"--n-frac={design.n_frac}", *design.options
        parameters = StimulusParameters(design.top, design.folder, tuple(dict.fromkeys(around)))
    steps: list[Step] = [] if design.verilog else [Stimulus(parameters)]
    steps.append(Leakage(LeakageParameters(options.corners)))
    for corner in options.corners:
        steps.append(Sta(StaParameters(design.top, corner, clock.period_ns)))
        steps.append(BlockLiberty(BlockLibertyParameters(corner, clock.port)))
    simulated = () if design.verilog else options.corners[:1] if design.is_chip else options.corners
    for corner in simulated:
        steps += [
            GateDelays(GateDelaysParameters(corner, clock.period_ns, io.input_delay, io.output_delay)),
            Power(PowerParameters(design.top, corner, clock.period_ns)),
            IrDrop(IrDropParameters(options.pdk, corner)),
        ]
    return steps


def all_steps(design: Design, options: Options, signoff: Signoff = signoff_steps) -> list[Step]:
    """All steps of a layout whose first attempt closes, in order. signoff: see `search.lay_out_smallest`."""
    first = [*synthesis_steps(design, options), *stages(design, options, next(floors(design, options)))]
    return [*first, *checks(options), *signoff(design, options)]

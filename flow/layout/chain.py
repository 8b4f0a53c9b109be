"""The steps of a layout with Coriolis, in order, for a design and a process."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from talbot.base.files import write
from talbot.base.liberty.read import plain, text_of
from talbot.base.steps import Step
from talbot.platforms.coriolis import coriolis_platform
from talbot.platforms.wires import wire_corner
from talbot.rtl.verilog import export_verilog

from .design import DESIGNS, Design, macro_modules
from .options import LEAST_UTILIZATION, Options, corner_of
from .steps.antenna import Antenna
from .steps.arrange import Arrange, ArrangeParameters
from .steps.assemble import Assemble, AssembleParameters
from .steps.block_liberty import BlockLiberty, BlockLibertyParameters
from .steps.compiled import Compiled
from .steps.drc import Drc
from .steps.equivalence import Equivalence, EquivalenceParameters
from .steps.extraction import Extraction, ExtractionBlocks
from .steps.fill import Fill
from .steps.floorplan import Floorplan, FloorplanParameters
from .steps.foundry_drc import FoundryDrc, FoundryDrcParameters, MagicDrc
from .steps.gate_delays import GateDelays, GateDelaysParameters
from .steps.gate_frames import GateFrames
from .steps.gate_tests import GateTests, GateTestsParameters
from .steps.ir_drop import IrDrop, IrDropParameters
from .steps.lef import Lef
from .steps.library import Library
from .steps.lvs import Lvs
from .steps.parameters import PdkParameters
from .steps.place import Place, PlaceParameters
from .steps.power import Power, PowerParameters
from .steps.repair import Repair, RepairParameters
from .steps.route import Route, RouteParameters
from .steps.sta import Sta, StaParameters
from .steps.sta_blocks import StaBlocks, StaBlocksParameters
from .steps.stimulus import Stimulus, StimulusParameters
from .steps.stream_out import StreamOut, StreamOutParameters
from .steps.synthesis import Synthesis, SynthesisParameters, TimedSynthesis
from .steps.timing import Timing, TimingParameters
from .timing.constraints import sdc

Signoff = Callable[[Design, Options], list[Step]]

FAN_OUT = 12  # most cells that one signal drives, where synthesis knows the cells' timing
# Of the whole chip, whose netlist with delays simulates a thousand times slower than a block's
CHIP_FRAME = {"rows": 384, "cols": 384, "tiles": 1}
# Inputs of the steps after `assemble` in a design with macros: the flat netlist and placement
ASSEMBLED = {"repair.netlist": "assemble.netlist"}
ASSEMBLED |= dict.fromkeys(("repair.placement", "route.placement"), "assemble.placement")
# The same of others: the final Verilog is known before the routing, so that what reads it alone runs beside it
BEFORE_ROUTING = {"stream_out.verilog": "repair.verilog"}
UTILIZATION_STEP = 0.04  # between two rounds of attempts
PACKED = 0.6  # spread of a round's second attempt
OBLONG = 1.25  # width by height of a round's second attempt, of the square where the first is not


def input_files(design: Design, options: Options, folder: Path) -> dict[str, Path]:
    """Export the design's Verilog and constraints into ``folder``; all files that the steps are given, by name.

    Raises ToolError where the export fails.
    """
    export_verilog(folder / "rtl", [design.top], design.options)
    constraints = folder / "rtl" / f"{design.top}.sdc"
    constraints.write_text(sdc(design), encoding="utf-8")
    return {
        "rtl": folder / "rtl" / f"{design.top}.sv",
        "sdc": constraints,
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
    library, macros, load = Library(PdkParameters(options.pdk)), macro_modules(design), design.io.load_pf
    named = design.top, design.clock.port, design.clock.period_ns
    if not options.corners:
        return [library, Synthesis(SynthesisParameters(*named, 0, load, macros))]
    timing = [] if options.liberty else [Timing(TimingParameters(options.pdk, options.corners))]
    parameters = SynthesisParameters(*named, FAN_OUT, load, macros)
    return [library, *timing, TimedSynthesis(parameters, options.corners[0], slowest(options.corners))]


def attempts(design: Design, options: Options) -> Iterator[tuple[Floorplan, Place, Arrange]]:
    """Floorplan and placement, the smallest area first; in a frame all are as large.

    At every utilization the design's spread and shape come first, then others.
    """
    places = tuple((macro.instance, DESIGNS[macro.design].top, *macro.at) for macro in design.macros)
    own, other = design.spread, OBLONG if design.aspect == 1.0 else 1.0
    place = Place(PlaceParameters(options.pdk, design.clock.port, macros=macro_modules(design)))
    begin = min(options.utilization, coriolis_platform(options.pdk).utilization_most)
    if design.frame:
        shape = FloorplanParameters(options.pdk, begin, frame=design.frame)
        for spread in (own, PACKED):
            yield Floorplan(shape), place, Arrange(ArrangeParameters(options.pdk, options.effort, spread))
        return
    for k in range(int((begin - LEAST_UTILIZATION) / UTILIZATION_STEP + 1e-9) + 1):
        for spread, aspect in ((own, design.aspect), (PACKED, other)):
            utilization = round(begin - UTILIZATION_STEP * k, 4)
            floorplan = Floorplan(FloorplanParameters(options.pdk, utilization, aspect, places))
            yield floorplan, place, Arrange(ArrangeParameters(options.pdk, options.effort, spread))


def routing_steps(design: Design, options: Options) -> list[Step]:
    """The steps after a placement that decide whether the routing keeps the design rules.

    `repair` and `route` are first.
    """
    macros, pdk = macro_modules(design), options.pdk
    assemble = [Assemble(AssembleParameters(pdk, macros))] if macros else []
    checks = [step(PdkParameters(pdk)) for step in (Fill, Drc, Antenna)]
    return [
        Repair(RepairParameters(pdk, slowest(options.corners), load_pf=design.io.load_pf)),
        Route(RouteParameters(pdk)),
        *assemble,
        StreamOut(StreamOutParameters(pdk, bool(macros))),
        *checks,
    ]


def slowest(corners: Sequence[str]) -> str:
    """That of ``corners`` with the slowest cells and wires; '' where there is none."""
    return next((corner for corner in corners if wire_corner(corner) == "max"), next(iter(corners), ""))


def signoff_steps(design: Design, options: Options) -> list[Step]:
    """The steps after a routing that keeps the design rules: all other checks, timing, power."""
    deck = FoundryDrcParameters(options.pdk, design.top)
    foundry = [{"klayout": FoundryDrc, "magic": MagicDrc}[name](deck) for name, _ in options.decks]
    steps: list[Step] = [
        Compiled(PdkParameters(options.pdk)),
        Equivalence(EquivalenceParameters(design.top, design.clock.port, design.reset)),
        *netlist_tests(design),
        *foundry,
        *(step(PdkParameters(options.pdk)) for step in (Lef, Extraction, Lvs)),
        *timing_steps(design, options),
    ]
    sources = ASSEMBLED if design.macros else BEFORE_ROUTING
    for step in steps:
        step.inputs = {name: sources.get(source, source) for name, source in step.inputs.items()}
    if not design.macros:
        return steps
    if options.corners:
        steps.append(ExtractionBlocks(PdkParameters(options.pdk)))
    for corner in options.corners:
        steps.append(StaBlocks(StaBlocksParameters(options.pdk, design.top, corner, macro_modules(design))))
    return steps


def netlist_tests(design: Design) -> list[Step]:
    """The block's tests on both netlists, in both simulators, a wrapper's in Icarus; of the chip, whole frames."""
    if not design.netlist_names:
        return [GateFrames()]
    block = design.folder, design.netlist_names, design.top
    runs = ("synthesized", "icarus"), ("final", "icarus"), ("final", "verilator")
    if design.frame:
        runs = runs[:2]  # behind a host with a clock of its own, a bench for Icarus
    return [GateTests(GateTestsParameters(*block, netlist, simulator)) for netlist, simulator in runs]


def timing_steps(design: Design, options: Options) -> list[Step]:
    """The steps that require characterized cells, corner by corner.

    Of the chip, whose frames take minutes with delays, simulation and power run at the first corner alone.
    """
    clock, io = design.clock, design.io
    size = {} if design.netlist_names else CHIP_FRAME
    parameters = StimulusParameters(design.top, design.folder, divider=design.divider, n_frac=design.n_frac, **size)
    steps: list[Step] = [Stimulus(parameters)] if options.corners else []
    for corner in options.corners:
        steps.append(Sta(StaParameters(design.top, corner, clock.period_ns)))
        steps.append(BlockLiberty(BlockLibertyParameters(corner, clock.port)))
    for corner in options.corners if design.netlist_names else options.corners[:1]:
        steps += [
            GateDelays(GateDelaysParameters(corner, clock.period_ns, io.input_delay, io.output_delay)),
            Power(PowerParameters(design.top, corner, clock.period_ns)),
            IrDrop(IrDropParameters(options.pdk, corner)),
        ]
    return steps


def all_steps(design: Design, options: Options, signoff: Signoff = signoff_steps) -> list[Step]:
    """All steps of a layout whose first attempt closes, in order. signoff: see `search.lay_out_smallest`."""
    first = synthesis_steps(design, options) + list(next(attempts(design, options)))
    return first + routing_steps(design, options) + signoff(design, options)

"""The embedded backend: its steps in order, for a design and a process."""

import sys
from dataclasses import dataclass

from base.liberty.read import is_library
from base.paths import ROOT
from base.steps.versions import version
from base.tools import ToolError, finish
from flow.simulate.verilator import FRAME
from models.parameters import ParameterError, check_int, check_real
from platforms.coriolis import process

from .design import DESIGNS, macro_modules
from .steps.antenna import Antenna, AntennaParameters
from .steps.assemble import Assemble, AssembleParameters
from .steps.block_liberty import BlockLiberty, BlockLibertyParameters
from .steps.drc import Drc, DrcParameters
from .steps.equivalence import Equivalence, EquivalenceParameters
from .steps.extraction import Extraction, ExtractionParameters
from .steps.fill import Fill, FillParameters
from .steps.floorplan import Floorplan, FloorplanParameters
from .steps.foundry_drc import FoundryDrc, FoundryDrcParameters, MagicDrc
from .steps.gate_delays import GateDelays, GateDelaysParameters
from .steps.gate_frames import GateFrames
from .steps.gate_tests import GateTests, GateTestsParameters
from .steps.ir_drop import IrDrop, IrDropParameters
from .steps.lef import Lef, LefParameters
from .steps.library import Library, LibraryParameters
from .steps.lvs import Lvs, LvsParameters
from .steps.place_route import PlaceRoute, PlaceRouteParameters
from .steps.power import Power, PowerParameters
from .steps.reroute import Reroute, RerouteParameters
from .steps.sta import Sta, StaParameters
from .steps.sta_blocks import StaBlocks, StaBlocksParameters
from .steps.stimulus import Stimulus, StimulusParameters
from .steps.stream_out import StreamOut, StreamOutParameters
from .steps.synthesis import Synthesis, SynthesisParameters, TimedSynthesis
from .steps.timing import MEASURES, Timing, TimingParameters
from .timing.constraints import sdc

FAN_OUT = 12  # most cells behind one signal, where the mapper knows how cells drive
# Of the whole chip, whose netlist with delays runs a thousand times slower than a block's
CHIP_FRAME = {"rows": 384, "cols": 384, "tiles": 1}
# What steps look at where there are blocks laid out before: these and the rest put together
ASSEMBLED = {
    "place_route.netlist": "assemble.netlist",
    "place_route.placement": "assemble.placement",
    "reroute.placement": "assemble.placement",
}
MOST_OPEN = {False: 60, True: 200}  # open nets that are rerouted after the router; around blocks it leaves more open
STEP, LEAST = 0.04, 0.20  # utilization: of one round of tries less than of the one before; of the last
EVEN, UNEVEN = 0.05, 0.3  # variations of density: a round's second try has the one that its first has not
ASPECTS = 1.0, 1.25  # width by height of a round's tries


@dataclass(frozen=True)
class Options:
    """pdk: process. utilization: cells' area by core area at which the search begins. effort: of the placer, 1..3.

    liberty: paths of characterized cells, one a corner; () for the process's corners, measured now. untimed: whether
    there is no timing at all. decks: pairs (name, path) of the foundry's own checks (`platforms.foundry`).
    """

    pdk: str = "sky130"
    utilization: float = 0.8
    liberty: tuple = ()
    untimed: bool = False
    effort: int = 2
    decks: tuple = ()

    @property
    def corners(self):
        """Names of the corners, that of synthesis first."""
        if self.untimed:
            return ()
        return tuple(path.stem for path in self.liberty) or process(self.pdk)[0].corners

    def __post_init__(self):
        for path in self.liberty:
            if not path.is_file():
                raise ParameterError(
                    f"liberty = {path}: no such file; without LIBERTY the cells are measured, "
                    "once, into build/layout/shared/timing.*/<corner>.lib"
                )
            if not is_library(path):
                raise ParameterError(f"liberty = {path}: must be a Liberty file: it does not begin with library (...)")
        if len({path.stem for path in self.liberty}) != len(self.liberty):
            raise ParameterError(f"liberty = {', '.join(map(str, self.liberty))}: must be of different corners")
        check_real("utilization", self.utilization, LEAST, 0.95)
        check_int("effort", self.effort, 1, 3)


def files(design, options, folder):
    """What the steps are given: the design's Verilog, made now, and the texts that describe the process."""
    done = finish(
        [sys.executable, "-m", "rtl.export", "--top", design.top, "--out", folder / "rtl", *design.options], cwd=ROOT
    )
    if done.returncode:
        raise ToolError(done.stderr.strip().splitlines()[-1])
    constraints = folder / "rtl" / f"{design.top}.sdc"
    constraints.write_text(sdc(design))
    given = {
        "rtl": folder / "rtl" / f"{design.top}.v",
        "tests": ROOT / "rtl" / design.folder / "test",
        "platform": ROOT / "platforms" / options.pdk.replace("-", "_") / "coriolis.py",
        "coriolis_scripts": ROOT / "flow" / "layout" / "coriolis",
        "sdc": constraints,
        "frame_bench": FRAME,
    }
    measure = {f"cells.{part}": ROOT / "cells" / part for part in MEASURES}
    return (
        given
        | measure
        | {f"timing.{path.stem}": path for path in options.liberty}
        | {f"foundry.{name}": path for name, path in options.decks}
    )


def front(design, options):
    """The steps ahead of a floorplan."""
    library, hard, load = Library(LibraryParameters(options.pdk)), macro_modules(design), design.io.load_pf
    if not options.corners:
        return [library, Synthesis(SynthesisParameters(design.top, design.clock.period_ns, 0, load, hard))]
    timing = [] if options.liberty else [Timing(TimingParameters(options.pdk, options.corners))]
    return [
        library,
        *timing,
        TimedSynthesis(
            SynthesisParameters(design.top, design.clock.period_ns, FAN_OUT, load, hard), options.corners[0]
        ),
    ]


def tries(design, options):
    """Pairs (floorplan, place and route), the smallest area first: at every utilization the design's variation of
    density in a square, then another one in another shape. Coriolis has no seed: these are what it answers to."""
    places = tuple((hard.instance, DESIGNS[hard.design].top, *hard.at) for hard in design.macros)
    own = design.density_variation
    for k in range(int((options.utilization - LEAST) / STEP + 1e-9) + 1):
        for variation, aspect in zip((own, EVEN if own > EVEN else UNEVEN), ASPECTS, strict=True):
            utilization = round(options.utilization - STEP * k, 4)
            yield (
                Floorplan(FloorplanParameters(options.pdk, utilization, aspect, places)),
                PlaceRoute(
                    PlaceRouteParameters(
                        options.pdk, design.clock.port, options.effort, variation, macros=macro_modules(design)
                    )
                ),
            )


def judged(design, options):
    """The steps behind a routing that say whether it keeps the design rules."""
    clock, hard = design.clock.port, macro_modules(design)
    assemble = [Assemble(AssembleParameters(options.pdk, hard))] if hard else []
    return [
        Reroute(RerouteParameters(options.pdk, clock, MOST_OPEN[bool(hard)])),
        *assemble,
        StreamOut(StreamOutParameters(options.pdk, clock, bool(hard))),
        Fill(FillParameters(options.pdk)),
        Drc(DrcParameters(options.pdk)),
        Antenna(AntennaParameters(options.pdk)),
    ]


def back(design, options):
    """The steps behind a routing that keeps the design rules: what else judges it."""
    told = FoundryDrcParameters(options.pdk, design.top)
    foundry = [{"klayout": FoundryDrc, "magic": MagicDrc}[name](told) for name, _ in options.decks]
    steps = [
        Equivalence(EquivalenceParameters(design.top, design.clock.port)),
        *simulations(design),
        *foundry,
        Lvs(LvsParameters(options.pdk)),
        Lef(LefParameters(options.pdk)),
        Extraction(ExtractionParameters(options.pdk)),
        *timed(design, options),
    ]
    for step in steps if design.macros else ():
        step.inputs = {name: ASSEMBLED.get(source, source) for name, source in step.inputs.items()}
    return steps + [
        StaBlocks(StaBlocksParameters(options.pdk, design.top, corner, macro_modules(design)))
        for corner in options.corners
        if design.macros
    ]


def simulations(design):
    """The block's tests on both netlists, in both simulators; of the chip, whole frames."""
    if not design.netlist_names:
        return [GateFrames()]
    return [
        GateTests(GateTestsParameters(design.folder, design.netlist_names, design.top, netlist, simulator))
        for netlist, simulator in (("synthesized", "icarus"), ("final", "icarus"), ("final", "verilator"))
    ]


def timed(design, options):
    """The steps that want characterized cells, corner by corner; of the chip, whose frames take minutes with delays,
    simulation and power at the first alone."""
    clock, io = design.clock, design.io
    size = {} if design.netlist_names else CHIP_FRAME
    watched = StimulusParameters(design.top, divider=design.divider, n_frac=design.n_frac, **size)
    steps = [Stimulus(watched)] if options.corners else []
    for corner in options.corners:
        steps += [
            Sta(StaParameters(design.top, corner, clock.period_ns)),
            BlockLiberty(BlockLibertyParameters(corner, clock.port)),
        ]
    for corner in options.corners if design.netlist_names else list(options.corners)[:1]:
        steps += [
            GateDelays(GateDelaysParameters(corner, clock.period_ns, io.input_delay, io.output_delay)),
            Power(PowerParameters(design.top, corner, clock.period_ns)),
            IrDrop(IrDropParameters(options.pdk, corner)),
        ]
    return steps


def chain(design, options, behind=back):
    """All steps of a first try that closes, in order. behind: as of `layout`."""
    return [*front(design, options), *next(tries(design, options)), *judged(design, options), *behind(design, options)]


def layout(design, options, runner, behind=back):
    """Run all steps with ``runner`` (base.steps.Runner), searching the smallest area that closes; ``behind``: function
    (design, options) -> the steps behind it.

    A try closes when every net is routed, by the router or behind it, and no rule of design or antennas broken.
    Returns the tries: list of {utilization, aspect, density_variation, open_segments (None where the router gave up, or
    blocks found no place), rules_broken (None without a layout)}. Raises ParameterError where blocks find no place.
    """
    version(f"python {process(options.pdk)[0].wheel}")
    for step in chain(design, options, behind):
        for tool in step.tools:
            version(tool)  # a tool that is missing is told before anything runs
    for step in front(design, options):
        runner.run(step)
    tried, placed, misfit = [], 0, None
    for floorplan, place_route in tries(design, options):
        tried.append(
            {
                "utilization": floorplan.parameters.utilization,
                "aspect": floorplan.parameters.aspect,
                "density_variation": place_route.parameters.density_variation,
                "open_segments": None,
                "rules_broken": None,
            }
        )
        try:
            runner.run(floorplan)
        except ParameterError as error:
            misfit = error
            continue
        placed += 1
        found = runner.run(place_route)["metrics"]
        tried[-1]["open_segments"] = found["open_segments"]
        reroute, *others = judged(design, options)
        if found["stopped"] is None and not runner.run(reroute)["metrics"]["open_nets"]:
            broken = sum(
                record["metrics"].get(f"{step.name}_violations", 0)
                for step, record in zip(others, runner.run_all(others), strict=True)
            )
            tried[-1]["rules_broken"] = broken
            if not broken:
                runner.run_all(behind(design, options))
                return tried
    if not placed:
        raise misfit
    return tried

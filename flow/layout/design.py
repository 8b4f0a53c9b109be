"""The designs: top module, clock, I/O constraints, and the tests that the netlist must pass."""

from argparse import Namespace
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from talbot.base.sensor import sensor_asked
from talbot.flow.layout.varied import CHIP, SENSOR, SIZED, varied
from talbot.models.parameters import ASYNCHRONOUS, SPI_INPUTS, ParameterError, SensorParameters, check_real
from talbot.platforms.processes import PROCESSES
from talbot.rtl.sensor_options import options_of
from talbot.rtl.tops import check_block


@dataclass(frozen=True)
class Clock:
    """The clock.

    port: its name. uncertainty_ns: of an edge, for setup: the host's jitter from edge to edge. hold_uncertainty_ns: for
    hold, which jitter does not touch: the most by which a block's Liberty may differ from its netlist (rules.json,
    model_error_ns). derate: share by which cells and wires of one chip are slower or faster than others of it (on-chip
    variation).
    """

    port: str = "clk"
    period_ns: float = field(default=20.0, metadata={"unit": "ns"})
    uncertainty_ns: float = field(default=0.25, metadata={"unit": "ns"})
    hold_uncertainty_ns: float = field(default=0.05, metadata={"unit": "ns"})
    derate: float = 0.05

    def __post_init__(self) -> None:
        check_real("period_ns", self.period_ns, 0.5, 1e4)
        check_real("uncertainty_ns", self.uncertainty_ns, 0, self.period_ns / 2)
        check_real("hold_uncertainty_ns", self.hold_uncertainty_ns, 0, self.period_ns / 2)
        check_real("derate", self.derate, 0, 0.5)


@dataclass(frozen=True)
class IoConstraints:
    """What is outside of the ports.

    input_delay, output_delay: the longest delays, as a share of the period. input_hold_ns: least time after the clock's
    edge at its port before an input changes, at every corner. A host with the same clock guarantees it; a comparator
    answers to outputs of the chip, which change later than that. output_hold_ns: least time after that edge for which
    outputs must stay. input_slew_ns: slew at inputs. load_pf: load of an output.
    """

    input_delay: float = 0.2
    output_delay: float = 0.2
    input_hold_ns: float = field(default=1.0, metadata={"unit": "ns"})
    output_hold_ns: float = field(default=0.0, metadata={"unit": "ns"})
    input_slew_ns: float = field(default=0.15, metadata={"unit": "ns"})
    load_pf: float = field(default=0.02, metadata={"unit": "pF"})


@dataclass(frozen=True)
class Design:
    """A block that can be laid out.

    top: module that rtl.export writes with ``options``. folder: of the block in rtl/. netlist_names: names under which
    the block's tests build it with these parameters, for `pytest --netlist`; () for the chip, whose test is a frame,
    and for a block in a size that its tests do not have. utilization: where the search for the smallest area begins,
    for a block that was laid out where it ended. aspect: width by height. divider, n_frac: of the chip in whose frame
    the block's stimulus is recorded. io: constraints of its ports. asynchronous: inputs that pass synchronizers, a
    false path. reset: port, active at 0 if it ends in _n. frame: a shuttle's outline, see platforms.frame; '' for the
    smallest that there is. closed: edges without pins. verilog: files of a user's design, which has no tests, and no
    frame in which power is measured; () for a block of rtl/. label: name of the sensor file that the design follows,
    part of its folder's name; '' for the standard sensor.
    """

    name: str
    top: str
    folder: str
    netlist_names: tuple[str, ...] = ()
    options: tuple[str, ...] = ()
    utilization: float = 0.8
    aspect: float = 1.0
    divider: str = "radix4"
    n_frac: int = 8
    clock: Clock = Clock()
    io: IoConstraints = IoConstraints()
    asynchronous: tuple[str, ...] = ()
    reset: str = "reset"
    frame: str = ""
    closed: tuple[str, ...] = ()
    verilog: tuple[Path, ...] = ()
    label: str = ""

    @property
    def is_chip(self) -> bool:
        """Whether this is the whole chip."""
        return self.top == "AspChip" and not self.verilog


def divider(name: str, variant: str, utilization: float, n_frac: int = 8) -> Design:
    """The Design of a variant of the divider with ``n_frac`` fraction bits."""
    top = "Cordic" if variant == "cordic" else f"QuadDivider{variant.capitalize()}"
    names, options = (f"QuadDivider_{variant}_{n_frac}_10",), (f"--n-frac={n_frac}",)
    return Design(name, top, "quad_divider", names, options, utilization, divider=variant, n_frac=n_frac)


SMALL = "--rows=7", "--cols=31", "--lanes=2"
# The parameters with which the tests of `reg_file` build it: its identity and the resets of its window
RESETS = "--rows=11", "--cols=13", "--lanes=2", "--tile-rows=4", "--tile-cols=5", "--divider=cordic"
DIE = IoConstraints(load_pf=0.25)  # of the chip on the sensor's die: the longest nets of flow.layout.sensor
tile = partial(Design, folder="tinytapeout", reset="rst_n")  # a block behind Tiny Tapeout's pins
chip = partial(Design, top="AspChip", folder="asp_chip", io=DIE, asynchronous=ASYNCHRONOUS)
DESIGNS = {
    made.name: made
    for made in (
        Design("amp_ctrl", "AmpCtrl", "amp_ctrl", ("AmpCtrl",), utilization=0.64),
        Design("readout_seq", "ReadoutSeq", "readout_seq", ("ReadoutSeq_7_31_2",), SMALL, 0.68),
        Design("edge_adc", "EdgeAdc", "edge_adc", ("EdgeAdc",)),
        Design("adc_bank", "AdcBank", "adc_bank", ("AdcBank8",), utilization=0.6),
        divider("quad_divider", "radix4", 0.8),
        divider("quad_divider_radix2", "radix2", 0.76),
        divider("quad_divider_pipelined", "pipelined", 0.72),
        divider("cordic", "cordic", 0.68),
        Design("phase_path", "PhasePath", "phase_path", ("PhasePath_8_radix4",), utilization=0.72),
        Design("run_length", "RunLength", "run_length", ("RunLength",), ("--rows=12", "--cols=36", "--lanes=4"), 0.62),
        Design("reg_file", "RegFile", "reg_file", ("RegFile",), RESETS, divider="cordic", asynchronous=SPI_INPUTS),
        Design("proc", "Proc", "proc", ("Proc",)),
        tile("tt_quad_divider", "tt_um_talbot_divider", netlist_names=("tt_um_talbot_divider",), frame="tt_1x1"),
        tile("tt_amp_ctrl", "tt_um_talbot_amp_ctrl", netlist_names=("tt_um_talbot_amp_ctrl",), frame="tt_1x2"),
        tile("tt_asp_chip", "tt_um_talbot_chip", netlist_names=("tt_um_talbot_chip",), frame="tt_4x4"),
        chip(CHIP, utilization=0.5, aspect=1.5, closed=("bottom", "top")),
    )
}


def design(name: str) -> Design:
    """Look up a Design by its name. Raises ParameterError."""
    if name not in DESIGNS:
        raise ParameterError(f"DESIGN = {name!r}: must be one of {', '.join(DESIGNS)}")
    return DESIGNS[name]


def design_asked(name: str, options: Namespace) -> Design:
    """Return the Design ``name`` for the sensor of a command line's options (`base.sensor.add_sensor`).

    That of the die is its chip's. Raises ParameterError for a field that the design cannot vary.
    """
    chosen, follows = design(CHIP if name == SENSOR else name), varied(name)
    sensor = sensor_asked(options, follows)
    return for_sensor(chosen, sensor, options.sensor.stem) if options.sensor and follows.used else chosen


def for_sensor(standard: Design, sensor: SensorParameters, label: str) -> Design:
    """Return the chip or block for ``sensor``: with its sizes and its divider, its clock no slower than the sensor's.

    Raises ParameterError for a block that the sensor does not have.
    """
    check_block(f"DESIGN = {standard.name!r}", standard.top, sensor)
    clock = replace(standard.clock, period_ns=min(standard.clock.period_ns, 1e9 / sensor.chip.f_clk))
    if standard.name not in SIZED:
        return replace(standard, clock=clock, label=label)
    variant = standard.divider if standard.folder == "quad_divider" else sensor.chip.divider
    options = options_of(replace(sensor, chip=replace(sensor.chip, divider=variant)))
    sized = replace(standard, options=options, divider=variant, n_frac=sensor.chip.n_frac, clock=clock, label=label)
    return sized if standard.is_chip else replace(sized, netlist_names=())


def check_flat(design: Design) -> None:
    """Check that a Design is without a frame. Raises ParameterError."""
    if design.frame:
        must = "must be without a frame, which only our own cells' layouts have"
        raise ParameterError(f"DESIGN = {design.name!r}: {must}")


def folder_name(design: Design, pdk: str) -> str:
    """Name of the folder of a design's results: with the process if it is not the default one, with the label."""
    return "-".join(filter(None, (design.name, pdk if pdk != PROCESSES[0] else "", design.label)))

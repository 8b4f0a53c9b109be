"""One read of the drawn chip in ngspice: strips and lines as extracted, all pixels, the board at the pins.

Transistors outside of the pixels and all nets are those of the layout (`post_layout.extract`), the pixels the drawn
ones of `make pixel-circuit`. A digital pin's edge is the controller's; an analog pin has the shuttle's switch,
pad and board.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from talbot.cells.corner import Corner
from talbot.pixels.analog_layout.cells import Cell
from talbot.pixels.layout.circuit import SIDES
from talbot.pixels.pixel_circuit.deck import analyse, pulses, subcircuit
from talbot.pixels.post_layout.extract import SUBSTRATE, Extracted, extract
from talbot.pixels.test_chip.circuit import ANALOG, BIAS, GROUND, HIGH, INPUTS, LOGIC, OUT, VDDA
from talbot.pixels.test_chip.draw import TestChip, relabelled
from talbot.pixels.test_chip.places import COLS, ROWS
from talbot.platforms.analog import AnalogMasks
from talbot.platforms.layout import layout_platform
from talbot.platforms.sky130 import analog, photodiode
from talbot.platforms.wires import wire_corner

TYPICAL = "tt_025C_1v80"
HIGH_V = 3.3
PATH_OHM, PATH_FARAD = 500.0, 5e-12  # of an analog pin's way to its pad, the shuttle's limits
BOARD_FARAD = 30e-12  # a voltmeter and its wire
# What gmin carries and the currents' tolerance are below 1 % of the least photocurrent
OPTIONS = ".option gmin=1e-16 abstol=1e-15 chgtol=1e-18 reltol=1e-4 itl1=500 itl2=300 itl4=100 method=gear"
RESET, SETTLE = 20e-6, 20e-6  # s: a reset; from its end to the first sample


@dataclass(frozen=True)
class Exposure:
    """Settings of a read. row, col: the pixel. ampere: photocurrents of its diodes. seconds: between both samples.

    others_ampere: photocurrent of every other diode. vdda: V of the pixels' supply, 1..3.3. bias: A of the current in.
    """

    row: int = 1
    col: int = 2
    ampere: tuple[float, float] = (20e-12, 10e-12)
    seconds: float = 200e-6
    others_ampere: float = 0.0
    vdda: float = 2.0
    bias: float = 5e-6


@dataclass(frozen=True)
class Read:
    """Result of a read, V at the pads, a before b. reset, dark, end: during reset, after it, after the exposure.

    nodes: V that the diodes fell between both samples. milliwatt: of the supplies and the bias.
    """

    reset: tuple[float, float]
    dark: tuple[float, float]
    end: tuple[float, float]
    nodes: tuple[float, float]
    milliwatt: float

    @property
    def gain(self) -> tuple[float, float]:
        """Volts at the pad for each volt at the diode."""
        a, b = ((dark - end) / node for dark, end, node in zip(self.dark, self.end, self.nodes, strict=True))
        return a, b


def extracted(chip: TestChip, masks: AnalogMasks) -> Extracted:
    """Return the strips' transistors with the parasitics of all nets; lines to the pixels are ports, too."""
    ports = *INPUTS, *ANALOG, LOGIC, HIGH, SUBSTRATE
    layout = relabelled(chip.layout, {GROUND: SUBSTRATE, **{port: port for port in ports}})

    def named(net: str) -> str:
        return SUBSTRATE if net == GROUND else net

    devices = tuple(
        replace(
            device,
            transistor=t._replace(drain=named(t.drain), gate=named(t.gate), source=named(t.source), bulk=named(t.bulk)),
        )
        for device, t in ((device, device.transistor) for device in chip.devices)
    )
    ends = tuple(end._replace(strap=end.strap._replace(net=named(end.strap.net))) for end in chip.terminals)
    cell = Cell(layout, layout.top_cell(), ports, devices, terminals=ends)
    wires = layout_platform(masks.base.name).wires[wire_corner(TYPICAL)]
    circuit, _ = extract(cell, masks, wires)
    inner = ["pixel_reset", *(f"read[{row}]" for row in range(ROWS))]
    inner += [f"column_{side}[{col}]" for side in SIDES for col in range(COLS)]
    return replace(circuit, ports=(*ports, *inner))


def deck(chip: TestChip, circuit: Extracted, corner: Corner, exposure: Exposure) -> list[str]:
    """Models, the chip, all pixels with their light, supplies and board; digital pins are left to be driven."""
    made = chip.array.pixels[0]
    sizes = circuit.sizes() | {("n_thick", made.w_um, made.l_um)}
    lines = [*analog.cards(corner.process, sizes), *photodiode.junction_cards(corner.process)]
    lines += [OPTIONS, f".temp {corner.temperature:g}"]
    lines += [*_plain(circuit.lines(analog)), *subcircuit(made)]
    nodes = [f"{port}" for port in circuit.ports]
    body = [f"Xchip {' '.join(nodes)} {circuit.name}"]
    for row in range(ROWS):
        for col in range(COLS):
            photo = [f"photo_{side}_{row}_{col}" for side in SIDES]
            columns = [f"column_{side}[{col}]" for side in SIDES]
            nets = "pixel_reset", f"read[{row}]", *columns, VDDA, SUBSTRATE, *photo
            body.append(f"Xpixel_{row}_{col} {' '.join(nets)} pixel")
            own = (row, col) == (exposure.row, exposure.col)
            light = exposure.ampere if own else (exposure.others_ampere, exposure.others_ampere)
            body += [f"I{node} {node} 0 {ampere:g}" for node, ampere in zip(photo, light, strict=True)]
    body += [f"Vlogic {LOGIC} 0 {corner.supply:g}", f"Vhigh {HIGH} 0 {HIGH_V:g}", f"Vground {SUBSTRATE} 0 0"]
    body += [f"Vvdda vdda_pad 0 {exposure.vdda:g}", f"Rvdda vdda_pad {VDDA} {PATH_OHM:g}"]
    body += [f"Ibias 0 bias_pad {exposure.bias:g}", f"Rbias bias_pad {BIAS} {PATH_OHM:g}"]
    for side, pin in OUT.items():
        body += [f"Rout_{side} {pin} pad_{side} {PATH_OHM:g}", f"Cpad_{side} pad_{side} 0 {PATH_FARAD + BOARD_FARAD:g}"]
    return [*lines, *_plain(body)]


def read(chip: TestChip, circuit: Extracted, corner: Corner, exposure: Exposure) -> Read:
    """Reset, release, expose, with one row and one column selected. Raises ToolError."""
    high, selected = f"{corner.supply:g}", {f"read[{exposure.row}]", f"column[{exposure.col}]"}
    first = RESET
    second = first + SETTLE
    end = second + exposure.seconds
    sources = []
    for pin, line in INPUTS.items():
        level = high if line in selected else "0"
        reset = pulses([(first, 0.0)], corner.supply)
        sources.append(f"V{pin} {pin} 0 {reset if line == 'pixel_reset' else level}")
    photo = [f"photo_{side}_{exposure.row}_{exposure.col}" for side in SIDES]
    wanted = ["time", *(f"v({node})" for node in ("pad_a", "pad_b", *photo)), "i(vhigh)", "i(vlogic)", "i(vvdda)"]
    lines = [*deck(chip, circuit, corner, exposure), *_plain(sources)]
    time, *waves = analyse(lines, [f"tran {exposure.seconds / 500:g} {end:g} 0 {exposure.seconds / 100:g}"], wanted)

    def at(seconds: float) -> list[float]:
        return [float(np.interp(seconds, time, wave)) for wave in waves]

    before, dark, last = at(first - 1e-7), at(second), at(end)
    fall = [dark[k] - last[k] for k in (2, 3)]
    milliwatt = -1e3 * (last[4] * HIGH_V + last[5] * corner.supply + last[6] * exposure.vdda)
    return Read((before[0], before[1]), (dark[0], dark[1]), (last[0], last[1]), (fall[0], fall[1]), milliwatt)


def transfer(
    chip: TestChip, circuit: Extracted, corner: Corner, exposure: Exposure, volts: Sequence[float]
) -> list[tuple[float, float, float]]:
    """Under reset (V of vdda, V of the diode, V at the pad of diode a): what a bench measures without light."""
    sources = []
    selected = {f"read[{exposure.row}]", f"column[{exposure.col}]", "pixel_reset"}
    for pin, line in INPUTS.items():
        sources.append(f"V{pin} {pin} 0 {corner.supply if line in selected else 0:g}")
    lines = [*deck(chip, circuit, corner, exposure), *_plain(sources)]
    photo = f"photo_a_{exposure.row}_{exposure.col}"
    found = analyse(
        lines,
        [f"dc vvdda {volts[0]:g} {volts[-1]:g} {(volts[-1] - volts[0]) / (len(volts) - 1):g}"],
        ["v(vdda_pad)", f"v({photo})", "v(pad_a)"],
    )
    return [(float(a), float(b), float(c)) for a, b, c in found.T]


def _plain(lines: Iterable[str]) -> list[str]:
    """Lines whose node names have no brackets, which ngspice takes for indices."""
    return [re.sub(r"\[(\d+)\]", r"_\1", line) for line in lines]

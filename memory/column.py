"""A bit of the memory as a circuit: one column with the longest word line and bit lines, and what reads and writes it.

    clk ----+--- word driver --- ladder of the word line --- cell, at the far end of both lines
            +--- delay --- sense          |  ladders of the bit lines
            precharge, read mux --- sense amplifier --- latch --- q
                       write mux --- write driver --- d

The lines have the capacitance of the extracted cell, the other columns and rows are transistors on them. While clk is
low the bit lines are precharged; we and d must be stable while it is high. The periphery has no parasitics.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from talbot.cells.netlist import spice
from talbot.memory import bitcell
from talbot.memory.array import GROUP, GROUP_PITCH
from talbot.memory.parameters import SramParameters
from talbot.pixels.circuits.gates import inverter, nand
from talbot.pixels.circuits.netlist import Capacitor, Circuit, Instance, Resistor, Transistor
from talbot.platforms.sky130 import analog as sky130
from talbot.platforms.sky130.layers import MET1, MET2

PORTS = "clk", "we", "d", "q", "wl", "bl", "br", "sense", "cell", "vdd", "vss"
LENGTH = 0.15  # um, of switches and sense amplifier
SECTIONS = 4  # of a line
DELAYS = 4  # inverters ahead of the sense amplifier
DELAY_LENGTH = 0.35  # um, of theirs
PRECHARGE, READ_MUX, WRITE_MUX = 1.68, 2.0, 3.0  # um
SENSE_P, SENSE_N, TAIL, DRIVER = 0.84, 1.68, 3.36, 5.0  # um


@dataclass(frozen=True)
class Line:
    """A line over all cells. farad: F of its metal at one cell. ohm: of all of it."""

    farad: float
    ohm: float


def lines(netlist: str, sram: SramParameters) -> tuple[Line, Line, float]:
    """Return the word line, a bit line and F of a cell's node, by the extracted cell ``netlist``."""
    pairs = spice.parse(netlist).capacitors
    word, bit, node = (sum(c.value for c in pairs if net in (c.a, c.b)) for net in ("wl", "bl", "q"))
    long = sram.columns / GROUP * GROUP_PITCH / (bitcell.WORD_METAL[1] - bitcell.WORD_METAL[0])
    high = sram.rows * bitcell.HEIGHT / bitcell.BIT_WIDTH
    return Line(word, MET1.sheet_ohm * long), Line(bit, MET2.sheet_ohm * high), node


def column(sram: SramParameters, netlist: str) -> Circuit:
    """Return the circuit of a bit with the parasitics of the extracted cell ``netlist``."""
    word, bit, node = lines(netlist, sram)
    transistors, capacitors, resistors = list[Transistor](), list[Capacitor](), list[Resistor]()
    for k, (first, last) in enumerate(_sections("word", "wl")):
        cells = sram.columns // SECTIONS
        resistors.append(Resistor(f"word{k}", first, last, word.ohm / SECTIONS))
        capacitors.append(Capacitor(f"word{k}", last, "vss", word.farad * cells))
        gates = 2 * cells - (2 if last == "wl" else 0)
        transistors.append(_many(f"word{k}", "vss", last, gates))
    for line in ("bl", "br"):
        for k, (first, last) in enumerate(_sections(line, f"{line}_far")):
            cells = sram.rows // SECTIONS
            resistors.append(Resistor(f"{line}{k}", first, last, bit.ohm / SECTIONS))
            capacitors.append(Capacitor(f"{line}{k}", last, "vss", bit.farad * cells))
            transistors.append(_many(f"{line}{k}", last, "vss", cells - (2 if last.endswith("far") else 0)))
    capacitors += [Capacitor(name, name, "vss", node) for name in ("cell", "cell_n")]
    cell = bitcell.bit_cell()
    inner = {"bl": "bl_far", "br": "br_far", "q": "cell", "qn": "cell_n"}
    transistors += [
        t._replace(name=f"cell_{t.name}", drain=inner.get(t.drain, t.drain), gate=inner.get(t.gate, t.gate))._replace(
            source=inner.get(t.source, t.source)
        )
        for t in cell.transistors
    ]
    transistors += _switches(sram.mux)
    parts = tuple(transistors), tuple(capacitors), tuple(resistors)
    return Circuit("column", PORTS, *parts, instances=tuple(_gates()))


def sense_offset() -> float:
    """Return the rms offset, V, of the sense amplifier's n pair by the process's figure for mismatch."""
    return 1e-3 * sky130.AREA["n"] / math.sqrt(SENSE_N * LENGTH)


def _sections(first: str, last: str) -> Iterator[tuple[str, str]]:
    """Pairs of nets from ``first`` to ``last``."""
    nets = [first, *(f"{first}_{k}" for k in range(1, SECTIONS)), last]
    yield from zip(nets, nets[1:])


def _many(name: str, drain: str, gate: str, count: int) -> Transistor:
    """Access transistors of as many other cells, an even number, their sources at ground."""
    return Transistor(f"{name}_others", drain, gate, "vss", "vss", "n", bitcell.ACCESS * count, LENGTH, count)


def _switches(mux: int) -> Iterator[Transistor]:
    """Yield precharge, multiplexers with those of the other columns, sense amplifier and write driver."""

    def p(name: str, drain: str, gate: str, source: str, w: float, fingers: int = 0) -> Transistor:
        return Transistor(name, drain, gate, source, "vdd", "p", w, LENGTH, fingers)

    def n(name: str, drain: str, gate: str, source: str, w: float, fingers: int = 0) -> Transistor:
        return Transistor(name, drain, gate, source, "vss", "n", w, LENGTH, fingers)

    for name, first, second in (("line", "bl", "br"), ("sense", "s", "sn")):
        for k, net in enumerate((first, second)):
            yield p(f"pre_{name}{k}", net, "pre_n", "vdd", PRECHARGE)
        yield p(f"equal_{name}", first, "pre_n", second, PRECHARGE)
    others = mux - 1 + (mux - 1) % 2  # an even number
    for k, (line, sense, write) in enumerate((("bl", "s", "w"), ("br", "sn", "wn"))):
        yield p(f"read{k}", line, "read_n", sense, READ_MUX)
        yield p(f"read_others{k}", sense, "vdd", "vdd", READ_MUX * others, others)
        yield n(f"write{k}", line, "wen", write, WRITE_MUX)
        yield n(f"write_others{k}", write, "vss", "vss", WRITE_MUX * others, others)
    yield n("driver0", "w", "d_n", "vss", DRIVER)
    yield n("driver1", "wn", "d_nn", "vss", DRIVER)
    for k, (one, other) in enumerate((("s", "sn"), ("sn", "s"))):
        yield p(f"sense_p{k}", one, other, "vdd", SENSE_P)
        yield n(f"sense_n{k}", one, other, "tail", SENSE_N)
    yield n("tail", "tail", "sense", "vss", TAIL)


def _gates() -> Iterator[Instance]:
    """Yield word driver, timing, latch and output."""

    def gate(name: str, circuit: Circuit, *nets: str) -> Instance:
        return Instance(name, circuit, (*nets, "vdd", "vss"))

    yield gate("decode", nand(2), "clk", "vdd", "word_n")
    yield gate("driver", inverter(12), "word_n", "word")
    yield gate("clock", inverter(2), "clk", "clk_n")
    yield gate("precharge", inverter(6), "clk_n", "pre_n")
    yield gate("not_we", inverter(), "we", "re")
    yield gate("reads", nand(), "clk", "re", "reads_n")
    yield gate("reading", inverter(2), "reads_n", "reading")
    chain = ["reading", *(f"late{k}" for k in range(DELAYS))]
    for k, (first, last) in enumerate(zip(chain, chain[1:])):
        yield gate(f"delay{k}", inverter(1, DELAY_LENGTH), first, last)
    yield gate("fire", nand(2), chain[-1], "reading", "sense_n")
    yield gate("sensing", inverter(4), "sense_n", "sense")
    yield gate("mux", nand(2), "reading", "sense_n", "read_n")
    yield gate("writes", nand(2), "clk", "we", "writes_n")
    yield gate("writing", inverter(4), "writes_n", "wen")
    yield gate("data", inverter(2), "d", "d_n")
    yield gate("data_n", inverter(2), "d_n", "d_nn")
    yield gate("latch", nand(), "s", "stored", "stored_n")
    yield gate("latch_n", nand(), "sn", "stored_n", "stored")
    yield gate("output", inverter(4), "stored_n", "q")

"""Residue of a column's turn at the lane's array after a cycle, behind column, lane's line and difference amplifier.

    cycle    | wake  | hold  |
    on       |_/‾‾‾‾‾|‾‾‾‾‾‾‾|‾‾‾
    reset    |‾‾‾‾‾‾‾|_______|___
    column   |_______|/‾‾‾‾‾‾|‾‾‾      it drives the lane's line, for longer than in the chip
    lane     | before|__/ out|         sampled at the end of the hold

Column and amplifier each have a settling in the datasheet, of the one with a capacitor for an amplifier,
of the other behind an ideal column. Here one is behind the other, with what the sample before left on the lane's array.
"""

from dataclasses import dataclass, replace

import numpy as np

from talbot.cells.corner import Corner
from talbot.cells.spice.wave import Wave
from talbot.pixels.circuits.amplifier import UNITS, AmplifierSizes, AmplifierSpec, amplifier
from talbot.pixels.circuits.column_sizes import ColumnSizes, ColumnSpec
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.netlist import Circuit, Instance
from talbot.pixels.datasheet import amplifier as amplifiers
from talbot.pixels.datasheet.column import GAP, Additions, bench, opened, sample, trimmed, turn_of
from talbot.pixels.datasheet.deck import Setup, settling

LIGHT = (0.2, 0.0), (0.0, 0.2), (0.9, 0.75)  # of a full well, of both diodes: differences within the converter's range
LATER = 2  # cycles after the hold's begin: the line is at rest, and has lost little


@dataclass(frozen=True)
class TurnResult:
    """At one corner. left: LSB of the converter between the end of the hold and rest, the most. settling: s from the
    hold's begin until half an LSB, the slowest."""

    left: float
    settling: float
    runs: int
    repeated: int


def measure(
    setup: Setup,
    specs: tuple[ColumnSpec, AmplifierSpec],
    sizes: tuple[ColumnSizes, AmplifierSizes],
    lane: LaneSizes,
    corner: Corner,
    *drawn: Circuit,
) -> TurnResult:
    """Measure a column that is trimmed first. drawn: circuits instead of those of ``sizes``."""
    (spec, of_amplifier), lsb = specs, setup.spec.lsb
    alone, made = bench(sizes[0], spec), joined(*sizes, spec)
    for one in drawn:
        alone, made = alone.replaced(one), made.replaced(one)
    start = trimmed(setup, spec, sizes[0], corner, alone)
    begin = turn_of(spec) - GAP
    end, rest = begin + spec.cycle, begin + LATER * spec.cycle
    load = {"lane": amplifiers.load_of(setup, lane, corner)}
    inputs = tuple(name for name in amplifiers.INPUTS if not name.startswith("column_"))
    additions = Additions(amplifiers.to_lane(corner), inputs, {"vref": of_amplifier.vref})
    more, waves = ("out", "lane"), list[Wave]()
    with opened(setup, spec, sizes[0], corner, start, more=more, circuit=made, additions=additions) as spice:
        for a, b in LIGHT:
            before = of_amplifier.vref - float(np.sign(a - b)) * amplifiers.REACH * 128 * lsb
            clocked = amplifiers.clocked(of_amplifier, corner, begin, UNITS, before)
            wells = a * spec.fall, b * spec.fall
            waves.append(sample(spice, spec, corner, *wells, cycles=LATER, more=clocked, loads=load))
        runs, repeated = spice.runs, spice.repeated

    left = max(abs(wave.at("lane", end) - wave.at("lane", rest)) for wave in waves) / lsb
    return TurnResult(left, max(settling(wave, "lane", begin, rest, 0.5 * lsb) for wave in waves), runs, repeated)


def joined(column: ColumnSizes, own: AmplifierSizes, spec: ColumnSpec) -> Circuit:
    """Return the column's bench with the amplifier, and its bias, instead of the capacitors of its inputs."""
    made, driver = bench(column, spec), amplifiers.biased(amplifier(own))
    nodes = {"column_a": "far_a", "column_b": "far_b"}
    parts = *made.instances, Instance("driver", driver, tuple(nodes.get(pin, pin) for pin in driver.ports))
    ports = *made.ports, *(pin for pin in driver.ports if pin not in (*made.ports, *nodes))
    kept = tuple(one for one in made.capacitors if not one.name.startswith("input_"))
    return replace(made, ports=ports, capacitors=kept, instances=parts)

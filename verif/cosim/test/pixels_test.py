"""A sampler leaves nothing that grows with the value; codes of a sound row name no fault, those of a fault name it."""

import numpy as np
import pytest

from talbot.cells.spice.engine import Simulator
from talbot.pixels.circuits.netlist import Circuit
from talbot.platforms.sky130 import analog
from talbot.verif.cosim import pixels
from talbot.verif.cosim.diagnose import SOUND, code_of, diagnose, dictionary, value_of
from talbot.verif.cosim.faults import Fault
from talbot.verif.cosim.lockstep import Run
from talbot.verif.cosim.row import Row, RowRequest, Sample

ngspice = pytest.mark.needs("ngspice")
VALUES = (0.3, 0.8, 1.3)  # V
EDGE_ROW = RowRequest(mode="edge", cols=12, lanes=2, types=6, pixels=False)


def held(circuit: Circuit) -> list[float]:
    """V on the capacitors of samples of VALUES after the switch has opened."""
    lines = [*analog.cards("tt", circuit.sizes()), ".param cscale=1 rscale=1", *circuit.lines(analog)]
    hold = pixels.PixelSizes().hold
    for k, volts in enumerate(VALUES):
        lines += [f"Vvalue{k} value{k} 0 {volts:g}", f"Xs{k} value{k} held{k} tap vdd 0 {circuit.name}"]
        lines.append(f"Ch{k} held{k} 0 {hold:g}")
    outputs = [f"held{k}" for k in range(len(VALUES))]
    with Simulator(lines, ("tap",), outputs, {"vdd": 1.8}, 25) as spice:
        tap = [(0.0, 1.8), (20e-9, 1.8), (20.1e-9, 0.0)]
        wave = spice.transient({"tap": tap}, {}, 40e-9, 1e-9)
    return [wave.at(name, 40e-9) for name in outputs]


@ngspice
def test_a_sampler_leaves_nothing_that_grows_with_the_value():
    """Without the transistors of half its width the slope is off by 0.2 % and more."""
    whole = pixels.sampler()
    slopes = [np.polyfit(VALUES, held(one), 1)[0] for one in (whole, whole.without("takes_n").without("takes_p"))]
    assert abs(slopes[0] - 1) < 5e-4 and slopes[1] - 1 > 1.5e-3


def row_of(fault: Fault | None, off: int = 0) -> Row:
    """What leaves the chip by charge alone; off: LSB by which every second code is off."""
    asked, samples = EDGE_ROW, []
    for n, ((column, sub), value) in enumerate(asked.values.items()):
        lane = column // 6 % asked.lanes
        made = value_of(value, column, True, fault)
        code = code_of(made, lane, False, asked.threshold, fault) + off * (n % 2)
        samples.append(Sample(column, sub, lane, value, code, code_of(value, lane, False, asked.threshold, None), None))
    empty = np.empty(0)
    return Row(asked, asked.decks(), Run(b"", None, empty, {}, {}, 1), samples, empty)  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("off", [0, 1, -1])
def test_a_sound_row_is_found_sound(off):
    """One LSB is noise, or the level's own: no capacitor of one unit is missing for that."""
    assert diagnose(row_of(None, off)).name == SOUND


def test_faults_of_more_than_a_few_units_are_named():
    for fault in dictionary(EDGE_ROW):
        if fault.kind == "comparator" or (fault.kind == "capacitor" and fault.where[1] >= 4):
            found = diagnose(row_of(fault))
            assert found.name == fault.name and found.error == 0 < found.next_error

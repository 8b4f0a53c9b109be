"""A clock gate is brought into its state by its inputs: its output does not show what its latch holds."""

import pytest

from talbot.cells.characterize.bench import REST, Bench
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.catalogue import schematics
from talbot.cells.compact.library import schematic_spice
from talbot.cells.corner import Corner
from talbot.cells.netlist.function import understand
from talbot.cells.netlist.spice import parse
from talbot.platforms.extraction import device_models

pytestmark = pytest.mark.needs("layout")


@pytest.mark.needs("ngspice")
def test_every_state_of_a_gate_is_reached_by_its_inputs():
    models = device_models("sky130")
    netlist = parse(schematic_spice(schematics()["cg_x1"], Canvas()), origin="cg_x1")
    cell = understand(netlist, models.POLARITY, models.SUPPLIES)
    held = [state for state in cell.machine.states if len(state.path) > 1]
    assert {state.outputs for state in held} >= {(0,)}  # low, whatever the latch holds
    with Bench(cell, models, Conditions(Corner.parse("ff_n40C_1v95"), "fitted")) as bench:
        pause = 1e-9
        for state in held:
            wave, start = bench.run(state, {}, 1e-9, 1e-11, {"q": 1e-15}, pause)
            assert start == pytest.approx(REST + pause * (len(state.path) - 1))
            assert wave.at("q", start) == pytest.approx(1.95 * state.outputs[0], abs=0.05)

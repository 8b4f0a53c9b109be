"""The column's circuit, and the figures of waves that are known."""

import numpy as np
import pytest

from talbot.cells.spice.wave import Wave
from talbot.memory import access
from talbot.memory.column import column, lines
from talbot.memory.parameters import SramParameters
from talbot.platforms.sky130 import analog

CELL = """.subckt bit bl br wl vdd vss q qn
X0 q wl bl vss sky130_fd_pr__nfet_01v8 w=0.42 l=0.15
C0 bl br 0.1f
C1 bl wl 0.2f
C2 q wl 0.3f
.ends
"""
HIGH, HALF = 1.8, 1e-9


@pytest.mark.parametrize("words, bits", [(128, 1), (512, 32), (1024, 64)])
def test_every_size_is_a_whole_circuit(words, bits):
    circuit = column(SramParameters(words, bits), CELL)
    circuit.check(analog)
    assert {"clk", "we", "d"} < set(circuit.ports)


@pytest.mark.parametrize("name", ["cell_access_l", "tail", "driver0", "word0"])
def test_a_missing_device_is_another_circuit(name):
    whole = column(SramParameters(), CELL)
    assert whole.without(name) != whole


def test_lines_grow_with_the_memory():
    word, bit, node = lines(CELL, SramParameters())
    assert (word.farad, bit.farad, node) == pytest.approx((0.5e-15, 0.3e-15, 0.3e-15))
    longer, higher, _ = lines(CELL, SramParameters(1024, 64))
    assert (longer.ohm / word.ohm, higher.ohm / bit.ohm) == pytest.approx((2, 2))


def waves(stored=(0, 0, 1, 1), late=0.3e-9):
    """What a column does that changes ``late`` s after clk: the bits of cell and q in each of four pulses."""
    starts = [(2 * k + 1) * HALF for k in range(4)]
    time = np.linspace(0, 9 * HALF, 9001)
    nodes = {name: np.zeros_like(time) for name in access.PROBES}
    for node, order in (("cell", (0, 2)), ("q", (1, 3))):
        nodes[node][:] = HIGH * (node == "cell" or 1 - stored[1])
        for k in order:
            nodes[node][time > starts[k] + access.EDGE / 2 + late] = HIGH * stored[k]
    for name in ("bl", "br"):
        nodes[name][:] = HIGH
    for start in starts:
        inside = (time > start + 0.1e-9) & (time < start + HALF + 0.2e-9)
        nodes["bl"][inside] = HIGH - 0.3
        nodes["sense"][(time > start + 0.2e-9) & (time < start + HALF)] = HIGH
    return Wave(time, nodes, {}), starts


def test_times_are_of_the_pulse_that_changes_a_node():
    found = access.judged(*waves(), HALF, HIGH)
    assert found.right
    assert (found.access, found.write, found.precharge) == pytest.approx((0.3e-9, 0.3e-9, 0.2e-9), abs=2e-12)
    assert found.difference == pytest.approx(0.3)
    assert found.cycle == pytest.approx(0.5e-9, abs=4e-12)


@pytest.mark.parametrize("stored", [(1, 0, 1, 1), (0, 1, 1, 1), (0, 0, 0, 1), (0, 0, 1, 0)])
def test_a_wrong_bit_is_seen(stored):
    assert not access.judged(*waves(stored), HALF, HIGH).right

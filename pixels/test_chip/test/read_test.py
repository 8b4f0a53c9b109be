"""One read of the drawn chip: both diodes, their own light alone, the reset level that a bench sets."""

import numpy as np
import pytest

from talbot.cells.corner import Corner
from talbot.pixels.test_chip import levels as levels_of
from talbot.pixels.test_chip.draw import draw_chip
from talbot.pixels.test_chip.read import TYPICAL, Exposure, extracted, read, transfer
from talbot.platforms.analog import analog_masks

pytestmark = pytest.mark.needs("layout", "ngspice")


def test_a_read_follows_the_light_and_the_reset_level():
    masks = analog_masks("sky130")
    chip = draw_chip(masks)
    circuit, corner = extracted(chip, masks), Corner.parse(TYPICAL)
    lit = read(chip, circuit, corner, Exposure())
    assert lit.nodes[0] == pytest.approx(2 * lit.nodes[1], rel=0.1)  # twice the current
    assert 0.2 < lit.nodes[0] < 0.5
    assert all(0.6 < gain < 0.75 for gain in lit.gain)
    current = np.array([20e-12, 10e-12])
    start = levels_of.FEEDTHROUGH + current * 20e-6 / levels_of.FARAD
    assert np.subtract(lit.reset, lit.dark) == pytest.approx(start * lit.gain, rel=0.1)
    collected = [x + levels_of.BEND * x**2 for x in (start, start + lit.nodes)]
    assert levels_of.FARAD * (collected[1] - collected[0]) == pytest.approx(current * 200e-6, rel=0.03)
    shaded = read(chip, circuit, corner, Exposure(ampere=(0.0, 10e-12), others_ampere=20e-12))
    assert shaded.dark[0] - shaded.end[0] < 0.01 * (lit.dark[0] - lit.end[0])
    assert shaded.gain[1] == pytest.approx(lit.gain[1], rel=0.02)
    levels = np.array(transfer(chip, circuit, corner, Exposure(), list(np.linspace(1.4, 2.2, 9))))
    assert np.abs(levels[:, 1] - levels[:, 0]).max() < 0.01  # a complete reset
    assert np.interp(levels[:, 0], levels_of.DIODE_V, levels_of.PAD_V) == pytest.approx(levels[:, 2], abs=2e-3)
    slopes = np.diff(levels[:, 2]) / np.diff(levels[:, 1])
    assert slopes == pytest.approx(np.full(8, lit.gain[0]), rel=0.06)

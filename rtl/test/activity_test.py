"""A simulation that skips idle blocks has the same signals in every cycle as one that runs all blocks."""

import random

import pytest
from pymtl3 import Component, DefaultPassGroup, InPort, OutPort, mk_bits, update, update_ff

from talbot.models.parameters import ArrayParameters, ChipParameters, SensorParameters
from talbot.rtl.harness.activity import quicken
from talbot.rtl.harness.ports import ports_of, split
from talbot.rtl.harness.reset import at
from talbot.rtl.tops import TOPS, build_top

SENSOR = SensorParameters(array=ArrayParameters(8, 13), chip=ChipParameters(lanes=2))


def simulation(top, quick):
    top.elaborate()
    top.apply(DefaultPassGroup(linetrace=False))
    if quick:
        quicken(top)
    top.sim_reset()
    return top


def signals(sim):
    return {
        repr(signal): int(kept[-1].to_bits())
        for signal, kept in sim._sim.signal_object_mapping.items()
        if repr(signal) != "s.clk"
    }


@pytest.mark.parametrize("name", sorted(TOPS.keys() - {"AspChip"}))  # which is made of the others
def test_every_signal_in_every_cycle(name):
    """Inputs hold for some cycles, change before or after the outputs were looked at; some cycles have a reset."""
    sims, pick = [simulation(build_top(name, SENSOR), quick) for quick in (False, True)], random.Random(name)
    inputs = split(ports_of(sims[0]))[0]
    for cycle in range(150):
        for port in pick.sample(inputs, pick.choice((0, 0, 1, len(inputs)))):
            value = pick.getrandbits(port.width) if port.path != "reset" else int(pick.random() < 0.1)
            for sim in sims:
                signal = at(sim, port.path)
                signal @= type(signal).from_bits(mk_bits(port.width)(value)) if port.struct else value
        if pick.random() < 0.5:
            for sim in sims:
                sim.sim_eval_combinational()
            assert signals(sims[0]) == signals(sims[1]), cycle
        for sim in sims:
            sim.sim_tick()
        assert signals(sims[0]) == signals(sims[1]), cycle


class Counting(Component):
    """A component whose state is not in signals."""

    def construct(s):
        s.step, s.count, s.doubled = InPort(4), OutPort(8), OutPort(8)
        s.number = 0

        @update_ff
        def up_number():
            s.number += 1
            s.count <<= s.number

        @update
        def up_doubled():
            s.doubled @= 2 * s.number


def test_a_block_with_a_state_of_its_own_always_runs():
    seen = []
    for quick in (False, True):
        sim = simulation(Counting(), quick)
        for _ in range(3):
            sim.sim_tick()
        seen.append((int(sim.count), int(sim.doubled)))
    assert seen[0] == seen[1] == (6, 12)

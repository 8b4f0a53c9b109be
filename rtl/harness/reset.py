"""What a block shows behind a reset, whatever was before it: the same at every level."""

import random

from pymtl3 import mk_bits

from rtl.harness.ports import ports_of, split, validity

CYCLES = 4  # that are looked at behind a reset
BEFORE = 60  # with any inputs, ahead of it


def shown_after_reset(sim, before=BEFORE):
    """Outputs in the cycles behind a reset, inputs 0: list of dict path -> value; a message counts while it is valid.

    sim: as rtl.harness.testbench.build gives it. before: cycles of any inputs ahead of the reset, 0 for a level that checks
    what it is given.
    """
    inputs, outputs = split(ports_of(sim))
    valid, pick = {msg.path: val.path for msg, val in validity(outputs).items()}, random.Random(1)

    def drive(value):
        for port in inputs:
            if port.path != "reset":
                signal = at(sim, port.path)
                number = value(port.width)
                signal @= type(signal).from_bits(mk_bits(port.width)(number)) if port.struct else number
        sim.sim_eval_combinational()

    def tick(reset, value):
        sim.reset @= reset
        drive(value)
        sim.sim_tick()

    for _ in range(before):
        tick(0, pick.getrandbits)
    tick(1, lambda width: 0)
    shown = []
    for _ in range(CYCLES):
        sim.reset @= 0
        drive(lambda width: 0)
        now = {port.path: int(at(sim, port.path).to_bits() if port.struct else at(sim, port.path)) for port in outputs}
        shown.append({path: number for path, number in now.items() if now.get(valid.get(path), 1)})
        sim.sim_tick()
    return shown


def at(component, path):
    """The port of ``component`` at 'recv.msg'."""
    for name in path.split("."):
        component = getattr(component, name)
    return component

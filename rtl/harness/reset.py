"""The outputs of a block after a reset do not depend on its past, and are the same at every level."""

import random
from collections.abc import Callable
from typing import Any

from pymtl3 import mk_bits

from talbot.rtl.harness.ports import ports_of, split, validity

CYCLES = 4  # compared after the reset
BEFORE = 60  # with random inputs, ahead of it


def outputs_after_reset(sim: Any, before: int = BEFORE) -> list[dict[str, int]]:
    """Outputs in each of the CYCLES after a reset with inputs 0, by path; a message counts while it is valid.

    sim: of rtl.harness.testbench.build. before: cycles of random inputs ahead of the reset, 0 for a level that checks
    its inputs.
    """
    inputs, outputs = split(ports_of(sim))
    valid, pick = {msg.path: val.path for msg, val in validity(outputs).items()}, random.Random(1)

    def drive(value: Callable[[int], int]) -> None:
        for port in inputs:
            if port.path != "reset":
                signal = at(sim, port.path)
                number = value(port.width)
                signal @= type(signal).from_bits(mk_bits(port.width)(number)) if port.struct else number
        sim.sim_eval_combinational()

    def tick(reset: int, value: Callable[[int], int]) -> None:
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


def at(component: Any, path: str) -> Any:
    """Return the port of ``component`` at the path 'recv.msg'."""
    for name in path.split("."):
        component = getattr(component, name)
    return component

"""Leakage power in every state."""

from talbot.cells.characterize.bench import Bench
from talbot.cells.netlist.states import Output

HOLD = 50e-6  # s, in which floating nodes between stacked transistors find their level


def leakage(bench: Bench) -> list[tuple[list[int], list[Output], float]]:
    """(inputs, outputs, W) of every pair of input and output levels, in the order of the machine's pins."""
    machine, values = bench.machine, {}
    for state in sorted(machine.states, key=lambda s: len(s.path)):
        if (state.inputs, state.outputs) in values:
            continue
        wave, _ = bench.run(state, {}, HOLD, HOLD / 50, dict.fromkeys(machine.outputs, 0.0))
        last = {node: float(current[-1]) for node, current in wave.current.items()}
        watts = sum(last[rail] for rail in bench.supplies) * bench.volts
        watts += sum(last[pin] * level * bench.volts for pin, level in zip(machine.inputs, state.inputs, strict=True))
        values[state.inputs, state.outputs] = watts
    return [(list(inputs), list(outputs), watts) for (inputs, outputs), watts in values.items()]

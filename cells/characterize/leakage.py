"""What a cell draws in every state while nothing moves."""

from cells.characterize.bench import QUICK

HOLD = 50e-6           # s, in which floating nodes between stacked transistors find their level


def leakage(bench):
    """[(inputs, outputs, W)] for every pair of input and output levels, inputs in the order of the machine's pins."""
    machine, found = bench.machine, {}
    for state in sorted(machine.states, key=lambda s: len(s.path)):
        if (state.inputs, state.outputs) in found:
            continue
        points, start = bench.stimulus(bench.path(state), bench.settling + QUICK, {})
        loads = dict.fromkeys(machine.outputs, 0.0)
        wave = bench.simulator.transient(points, loads, start + HOLD, HOLD / 50)
        watts = sum(float(wave.current[rail][-1]) for rail in bench.supplies) * bench.volts
        watts += sum(float(wave.current[pin][-1]) * level * bench.volts
                     for pin, level in zip(machine.inputs, state.inputs, strict=True))
        found[state.inputs, state.outputs] = watts
    return [(list(inputs), list(outputs), watts) for (inputs, outputs), watts in found.items()]

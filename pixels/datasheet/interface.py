"""The interface of chip and lane at one corner: strobe and sample, whatever the clock's duty cycle is."""

from dataclasses import dataclass

import numpy as np

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Points
from talbot.cells.spice.wave import Wave
from talbot.pixels.circuits.interface import CHIP, interface
from talbot.pixels.datasheet.deck import CLOCK_TO_Q, EDGE, Setup, deck, simulator

DUTIES = 0.2, 0.8  # shares of a cycle in which clk is high
LOADS = {"sample": 20e-15, "strobe": 20e-15, "reset": 0.2e-12}  # F
HOLDS, CYCLES = (1, 4), 6  # cycles of hold, of the first after a rest; number of all
CONVERT = 1e-9  # s by which the chip's `convert`, a gate behind its registers, is later than they are


@dataclass(frozen=True)
class InterfaceResult:
    """At one corner, over DUTIES.

    first, last: s from a cycle's begin to the strobe, the least and the most. sample: s from the begin of hold's cycle
    until the lane samples, the most. decided: s from the strobe until then, the least. over: s by which the sample ends
    before the reset begins, the least. energy: J of a cycle with a strobe; idle: J of one without `convert`.
    """

    first: float
    last: float
    sample: float
    decided: float
    over: float
    energy: float
    idle: float
    runs: int
    repeated: int


def measure(setup: Setup, corner: Corner) -> InterfaceResult:
    """Measure the interface; a lane is enabled, and converts from the first hold until a cycle before the end."""
    cycle, high = 1 / setup.spec.f_clk, corner.supply

    def pulses(*spans: tuple[float, float]) -> Points:
        points = [(0.0, 0.0)]
        for begin, end in spans:
            points += [(begin, 0.0), (begin + EDGE, high), (end, high), (end + EDGE, 0.0)]
        return points

    strobes, samples, decided, over, waves = [], [], [], [], list[Wave]()
    with simulator(deck(interface(), setup, corner), CHIP, tuple(LOADS), corner) as spice:
        for duty in DUTIES:
            stimulus = {
                "clk": pulses(*((k * cycle, (k + duty) * cycle) for k in range(CYCLES))),
                "hold": pulses(*((k * cycle + CLOCK_TO_Q, (k + 1) * cycle + CLOCK_TO_Q) for k in HOLDS)),
                "convert": pulses(
                    (HOLDS[0] * cycle + CLOCK_TO_Q + CONVERT, (CYCLES - 1) * cycle + CLOCK_TO_Q + CONVERT)
                ),
                "en": [(0.0, high)],
            }
            wave = spice.transient(stimulus, LOADS, CYCLES * cycle, cycle / 200)
            waves.append(wave)
            strobes += [after % cycle for after in _rises(wave, "strobe", high)]
            for begin, end in zip(_rises(wave, "sample", high), _rises(wave, "sample", high, False), strict=True):
                samples.append(begin % cycle)
                decided.append(begin - max(at for at in _rises(wave, "strobe", high) if at < begin))
                over.append(min(at for at in _rises(wave, "reset", high) if at > begin) - end)
        runs, repeated = spice.runs, spice.repeated
    energy, idle = (
        max(wave.charge("vdd", at * cycle, (at + 1) * cycle) for wave in waves) * high for at in (HOLDS[0] + 2, 0)
    )
    ends = min(strobes), max(strobes), max(samples), min(decided), min(over)
    return InterfaceResult(*ends, energy, idle, runs, repeated)


def _rises(wave: Wave, net: str, high: float, up: bool = True) -> list[float]:
    """Times (s) at which a net rises, or falls, through half of ``high``."""
    above = wave.voltage[net] > high / 2
    return [float(at) for at in wave.time[1:][(above[1:] != above[:-1]) & (above[1:] == up)]] if np.any(above) else []

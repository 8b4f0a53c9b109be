"""The same faults in Icarus, event-driven and with registers at X: every output of every cycle."""

import numpy as np
import pytest

from talbot.models.digital.host import command
from talbot.verif.faults.chip import configured, quiet, run, start
from talbot.verif.faults.waveform import PULSE_HIGH, PULSE_LOW, RDY, RESET, rest, transfer

pytestmark = [pytest.mark.needs("iverilog"), pytest.mark.slow]


def faults():
    """A waveform of every kind of fault, in the middle of frames."""
    frame = quiet("raw")
    pulses = frame.trace.wave | np.uint8(PULSE_LOW | PULSE_HIGH)
    hit = rest(150)
    hit[100] |= RESET
    broken = transfer(b"\x00" + command("start") * 3)
    broken[70] |= RESET
    ends = rest(frame.length + 20)
    return [
        pulses,
        np.concatenate([frame.before, rest(60), rest(100) & ~np.uint8(RDY), ends]),
        np.concatenate([frame.before, transfer((0x80 | 8, 0x5A, 0x33), 19), start(), ends]),
        np.concatenate([frame.before, hit, configured("raw")[8:], start(), ends]),
        np.concatenate([configured("raw"), broken, ends]),
    ]


def test_icarus_does_what_verilator_does():
    waves = faults()
    for number, (one, two) in enumerate(zip(run(waves), run(waves, icarus=True), strict=True)):
        differ = np.flatnonzero((one.out != two.out).any(1))
        assert not (differ > 0).any(), f"waveform {number}: the outputs of cycle {differ[differ > 0][0]} differ"

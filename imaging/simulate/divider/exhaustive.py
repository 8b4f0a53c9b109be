"""All 2^18 inputs through the Verilog of a divider, against the golden model.

Twice: in order, with a source and a sink that never wait; then in a scrambled order, with random waiting on both
sides and a noise floor, so that a response that depended on the one before or on back-pressure would differ.
"""

from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.imaging.simulate.divider.simulator import DividerRun, program, simulate
from talbot.models.digital.divider import QuadResult, phase_error
from talbot.models.digital.phase import divide
from talbot.models.parameters import ChipParameters, SensorParameters
from talbot.models.parameters.divider import SAMPLE_MAX, SAMPLE_MIN
from talbot.rtl.export import translate
from talbot.rtl.quad_divider import quad_divider, ratio_bits

SEED, NOISE_FLOOR = 2**62 + 5, 100  # of the second run
SCRAMBLE = 0x2545F  # odd: i -> i * SCRAMBLE mod 2^18 visits every input once
Inputs = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Divider:
    """A divider: its variant, fraction bits of the ratio (CORDIC has none), and iterations of CORDIC."""

    variant: str
    n_frac: int = 8
    iterations: int = 10

    def golden(self, x: Inputs, y: Inputs, noise_floor: int = 0) -> QuadResult:
        """Return the golden model's responses."""
        return divide(self.variant, self.n_frac, self.iterations, x, y, noise_floor)

    def verilog(self) -> tuple[str, str]:
        """Return the Verilog and the name of its top module. Raises ParameterError."""
        top = type(quad_divider(self.variant, self.n_frac, self.iterations)).__name__
        chip = ChipParameters(n_frac=self.n_frac, cordic_iterations=self.iterations)
        return translate(top, SensorParameters(chip=chip)), top


@dataclass(frozen=True)
class Figures:
    """Figures of one divider over all 2^18 inputs.

    latency, interval: cycles. worst, rms: phase error in LSB (256 = one turn). mismatches: against the golden model in
    both runs; cycles, seconds: of the first.
    """

    latency: int
    interval: int
    worst: float
    rms: float
    mismatches: int
    cycles: int
    seconds: float


def every_input() -> tuple[Inputs, Inputs]:
    """Return x and y of all 2^18 pairs."""
    samples = np.arange(SAMPLE_MIN, SAMPLE_MAX + 1)
    x, y = np.meshgrid(samples, samples, indexing="ij")
    return x.ravel(), y.ravel()


def pack(x: Inputs, y: Inputs) -> npt.NDArray[np.uint32]:
    """DivReq messages of the inputs."""
    return ((x & 0x1FF) << 9 | y & 0x1FF).astype(np.uint32)


def unpack(responses: npt.NDArray[np.uint64], bits: int) -> QuadResult:
    """Return the fields of DivResp messages with a ratio of ``bits``."""
    widths = {"amp": 8, "amp_valid": 1, "phase": 8, "zero": 1, "ratio": bits, "octant": 3}  # from bit 0 up
    found, shift = {}, 0
    for name, width in widths.items():
        found[name] = (responses >> np.uint64(shift) & np.uint64((1 << width) - 1)).astype(np.int64)
        shift += width
    return QuadResult(**found)


def count_mismatches(got: QuadResult, expected: QuadResult) -> int:
    """Inputs whose response differs in any field, or is missing (at the end)."""
    size = got.phase.size
    differs = np.zeros(size, bool)
    for field in fields(QuadResult):
        differs |= getattr(got, field.name) != getattr(expected, field.name)[:size]
    return int(differs.sum()) + expected.phase.size - size


def compare(
    bench: Path, x: Inputs, y: Inputs, divider: Divider, noise_floor: int = 0, seed: int = 0
) -> tuple[int, QuadResult, DividerRun]:
    """One run against the golden model: mismatches, the responses, and the run."""
    run = simulate(bench, pack(x, y), noise_floor, seed)
    got = unpack(run.responses, ratio_bits(divider.variant, divider.n_frac))
    return count_mismatches(got, divider.golden(x, y, noise_floor)), got, run


def errors(phase: npt.NDArray[np.integer], x: Inputs, y: Inputs) -> tuple[float, float]:
    """Worst and RMS distance of the phase from atan2 in LSB, over the inputs that have a phase."""
    error = phase_error(phase, x, y)[(x != 0) | (y != 0)]
    return float(np.abs(error).max()), float(np.sqrt((error**2).mean()))


def measure(divider: Divider) -> Figures:
    """Figures of the Verilog of ``divider``. Raises ParameterError, ToolError."""
    x, y = every_input()
    bench = program(*divider.verilog())
    mismatches, got, run = compare(bench, x, y, divider)
    scrambled = np.arange(x.size) * SCRAMBLE % x.size
    mismatches += compare(bench, x[scrambled], y[scrambled], divider, NOISE_FLOOR, SEED)[0]
    size = got.phase.size
    figures = run.latency[1], run.interval[1], *errors(got.phase, x[:size], y[:size])
    return Figures(*figures, mismatches, run.cycles, run.seconds)

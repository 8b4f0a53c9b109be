"""All 2^18 inputs through the Verilog of a divider, against the golden model.

Twice: in order, with a source and a sink that never wait; then in a scrambled order, with random waiting on both
sides and a noise floor, so that a response that depended on the one before or on back-pressure would differ.
"""

import sys
from argparse import ArgumentParser, Namespace
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from tqdm import tqdm

from talbot.imaging.simulate.divider.simulator import DividerRun, program, simulate
from talbot.models.digital.divider import QuadResult, phase_error
from talbot.models.digital.phase import divide
from talbot.models.parameters import DIVIDERS, ChipParameters, SensorParameters, check_int
from talbot.models.parameters.divider import (
    ITERATIONS_MAX,
    ITERATIONS_MIN,
    N_FRAC_MAX,
    N_FRAC_MIN,
    SAMPLE_MAX,
    SAMPLE_MIN,
)
from talbot.rtl.export import translate
from talbot.rtl.quad_divider import quad_divider, ratio_bits, timing

SEED, NOISE_FLOOR = 2**62 + 5, 100  # of the second run
SCRAMBLE = 0x2545F  # odd: i -> i * SCRAMBLE mod 2^18 visits every input once
COLUMNS: dict[str, str] = dict.fromkeys(("variant", "n_frac", "iterations", "latency", "interval", "mismatches"), "{}")
COLUMNS |= {"worst": "{:.4f}", "rms": "{:.4f}", "mega_cycles_per_s": "{:.1f}"}
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
    both runs; cycles, seconds: of the first; None without Verilog.
    """

    divider: Divider
    latency: int
    interval: int
    worst: float
    rms: float
    mismatches: int | None = None
    cycles: int | None = None
    seconds: float | None = None

    @property
    def mega_cycles_per_s(self) -> float | None:
        """Speed of the simulation."""
        return self.cycles / self.seconds / 1e6 if self.cycles and self.seconds else None


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


def measure(divider: Divider, rtl: bool = True) -> Figures:
    """Figures of the Verilog of ``divider``, or, without ``rtl``, of the golden model.

    Raises ParameterError, ToolError.
    """
    x, y = every_input()
    if not rtl:
        latency, interval = timing(divider.variant, divider.n_frac, divider.iterations)
        return Figures(divider, latency, interval, *errors(divider.golden(x, y).phase, x, y))
    bench = program(*divider.verilog())
    mismatches, got, run = compare(bench, x, y, divider)
    scrambled = np.arange(x.size) * SCRAMBLE % x.size
    mismatches += compare(bench, x[scrambled], y[scrambled], divider, NOISE_FLOOR, SEED)[0]
    size = got.phase.size
    figures = run.latency[1], run.interval[1], *errors(got.phase, x[:size], y[:size])
    return Figures(divider, *figures, mismatches, run.cycles, run.seconds)


def row(found: Figures) -> str:
    """Return a line of the table. A column without a meaning for the variant is a dash."""
    values = {name: getattr(found, name, None) for name in COLUMNS} | vars(found.divider)
    values["n_frac" if found.divider.variant == "cordic" else "iterations"] = None
    cells = ("-" if values[name] is None else COLUMNS[name].format(values[name]) for name in COLUMNS)
    return "".join(cell.rjust(max(len(name), 9) + 2) for name, cell in zip(COLUMNS, cells, strict=True))


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot divider`."""
    chip = ChipParameters()
    several: dict[str, Any] = {"nargs": "+", "type": int, "metavar": "N"}
    names: dict[str, Any] = {"nargs": "+", "choices": DIVIDERS, "metavar": "NAME"}
    parser.add_argument("--variant", default=DIVIDERS, help=f"of {', '.join(DIVIDERS)}", **names)
    parser.add_argument("--n-frac", default=[chip.n_frac], help="fraction bits of the ratio, 4..16", **several)
    parser.add_argument("--iterations", default=[chip.cordic_iterations], help="of CORDIC, 4..16", **several)
    parser.add_argument("--golden", action="store_true", help="the golden model alone, without Verilog")


def run(options: Namespace) -> int:
    """Print a line for each configuration; 1 where the Verilog and the golden model differ."""
    for n_frac in options.n_frac:
        check_int("n-frac", n_frac, N_FRAC_MIN, N_FRAC_MAX)
    for iterations in options.iterations:
        check_int("iterations", iterations, ITERATIONS_MIN, ITERATIONS_MAX)
    dividers = [
        Divider(variant, iterations=width) if variant == "cordic" else Divider(variant, width)
        for variant in options.variant
        for width in (options.iterations if variant == "cordic" else options.n_frac)
    ]
    mismatches = 0
    print("".join(name.rjust(max(len(name), 9) + 2) for name in COLUMNS))
    for divider in tqdm(dividers, file=sys.stderr, leave=False, disable=None):
        found = measure(divider, rtl=not options.golden)
        mismatches += found.mismatches or 0
        tqdm.write(row(found))
    return 1 if mismatches else 0

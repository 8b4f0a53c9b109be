"""All 2^18 inputs through the Verilog of a divider, against the golden model.

Twice: in order, with a source and a sink that never wait; then in a scrambled order, with random waiting on both
sides and a noise floor, so that a response that depended on the one before or on back-pressure would differ.
"""

import sys
from argparse import ArgumentParser, Namespace

import numpy as np
from tqdm import tqdm

from models.digital.divider import QuadResult, phase_error
from models.digital.phase import divide
from models.parameters import DIVIDERS, ChipParameters, SensorParameters, check_int
from models.parameters.divider import ITERATIONS_MAX, ITERATIONS_MIN, N_FRAC_MAX, N_FRAC_MIN, SAMPLE_MAX, SAMPLE_MIN
from rtl.export import translate
from rtl.quad_divider import quad_divider, ratio_bits, timing

from .simulator import program, simulate

SEED, NOISE_FLOOR = 2**62 + 5, 100  # of the second run
SCRAMBLE = 0x2545F  # odd: i -> i * SCRAMBLE mod 2^18 visits every input once
COLUMNS = {
    "variant": "{}",
    "n_frac": "{}",
    "iterations": "{}",
    "latency": "{}",
    "interval": "{}",
    "mismatches": "{}",
    "worst": "{:.4f}",
    "rms": "{:.4f}",
    "mega_cycles_per_s": "{:.1f}",
}


def every_input():
    """x, y: int64 of all 2^18 pairs."""
    samples = np.arange(SAMPLE_MIN, SAMPLE_MAX + 1)
    x, y = np.meshgrid(samples, samples, indexing="ij")
    return x.ravel(), y.ravel()


def pack(x, y):
    """DivReq messages: uint32."""
    return ((x & 0x1FF) << 9 | y & 0x1FF).astype(np.uint32)


def unpack(responses, bits):
    """QuadResult of DivResp messages (uint64) with a ratio of ``bits``."""
    widths = {"amp": 8, "amp_valid": 1, "phase": 8, "zero": 1, "ratio": bits, "octant": 3}  # from bit 0 up
    fields, shift = {}, 0
    for name, width in widths.items():
        fields[name] = (responses >> np.uint64(shift) & np.uint64((1 << width) - 1)).astype(np.int64)
        shift += width
    return QuadResult(**fields)


def count_mismatches(got, expected):
    """Inputs whose response differs in any field, or did not come (at the end)."""
    came = got.phase.size
    differs = np.zeros(came, bool)
    for name in QuadResult.__dataclass_fields__:
        differs |= getattr(got, name) != getattr(expected, name)[:came]
    return int(differs.sum()) + expected.phase.size - came


def verilog(variant, n_frac, iterations):
    """(text, name of the top module) of a divider. Raises ParameterError."""
    top = type(quad_divider(variant, n_frac, iterations)).__name__
    return translate(top, SensorParameters(chip=ChipParameters(n_frac=n_frac, cordic_iterations=iterations))), top


def compare(bench, x, y, config, noise_floor, seed):
    """One run against the golden model: (mismatches, QuadResult that came, what `simulate` says of the run)."""
    variant, n_frac, _ = config
    responses, run = simulate(bench, pack(x, y), noise_floor, seed)
    got = unpack(responses, ratio_bits(variant, n_frac))
    return count_mismatches(got, divide(*config, x, y, noise_floor)), got, run


def errors(phase, x, y):
    """(worst, RMS) of the phase's distance from atan2 in LSB, over the inputs that have a phase."""
    error = phase_error(phase, x, y)[(x != 0) | (y != 0)]
    return float(np.abs(error).max()), float(np.sqrt((error**2).mean()))


def measure(variant, n_frac=8, iterations=10, rtl=True):
    """Figures of one divider over all 2^18 inputs, as a dict.

    variant, n_frac, iterations; latency and interval in cycles; worst and rms: phase error in LSB (256 = one turn).
    With ``rtl`` all of these are the Verilog's, and there are mismatches (against the golden model, both runs),
    cycles, seconds and mega_cycles_per_s (of the first run); without, they are the golden model's, and these are None.
    Raises ParameterError, ToolError.
    """
    latency, interval = timing(variant, n_frac, iterations)
    x, y = every_input()
    found = {
        "variant": variant,
        "n_frac": n_frac,
        "iterations": iterations,
        "latency": latency,
        "interval": interval,
        "mismatches": None,
        "cycles": None,
        "seconds": None,
        "mega_cycles_per_s": None,
    }
    if not rtl:
        worst, rms = errors(divide(variant, n_frac, iterations, x, y).phase, x, y)
        return found | {"worst": worst, "rms": rms}
    config = variant, n_frac, iterations
    bench = program(*verilog(*config))
    mismatches, got, run = compare(bench, x, y, config, noise_floor=0, seed=0)
    scrambled = np.arange(x.size) * SCRAMBLE % x.size
    mismatches += compare(bench, x[scrambled], y[scrambled], config, NOISE_FLOOR, SEED)[0]
    came = got.phase.size
    worst, rms = errors(got.phase, x[:came], y[:came])
    return found | {
        "latency": run["latency"][1],
        "interval": run["interval"][1],
        "mismatches": mismatches,
        "worst": worst,
        "rms": rms,
        "cycles": run["cycles"],
        "seconds": run["seconds"],
        "mega_cycles_per_s": run["cycles"] / run["seconds"] / 1e6,
    }


def row(found):
    """A line of the table. A column that means nothing to the variant is a dash."""
    meaningless = "n_frac" if found["variant"] == "cordic" else "iterations"
    cells = (
        "-" if name == meaningless or found[name] is None else form.format(found[name])
        for name, form in COLUMNS.items()
    )
    return "".join(cell.rjust(max(len(name), 9) + 2) for name, cell in zip(COLUMNS, cells))


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot divider`."""
    chip = ChipParameters()
    several = {"nargs": "+", "type": int, "metavar": "N"}
    parser.add_argument(
        "--variant", nargs="+", choices=DIVIDERS, default=DIVIDERS, metavar="NAME", help=f"of {', '.join(DIVIDERS)}"
    )
    parser.add_argument("--n-frac", default=[chip.n_frac], help="fraction bits of the ratio, 4..16", **several)
    parser.add_argument("--iterations", default=[chip.cordic_iterations], help="of CORDIC, 4..16", **several)
    parser.add_argument("--golden", action="store_true", help="the golden model alone, without Verilog")


def run(options: Namespace) -> int:
    """Print a line for each configuration; 1 where the Verilog and the golden model differ."""
    for n_frac in options.n_frac:
        check_int("n-frac", n_frac, N_FRAC_MIN, N_FRAC_MAX)
    for iterations in options.iterations:
        check_int("iterations", iterations, ITERATIONS_MIN, ITERATIONS_MAX)
    configs = [
        (variant, 8, width) if variant == "cordic" else (variant, width, ChipParameters().cordic_iterations)
        for variant in options.variant
        for width in (options.iterations if variant == "cordic" else options.n_frac)
    ]
    mismatches = 0
    print("".join(name.rjust(max(len(name), 9) + 2) for name in COLUMNS))
    for config in tqdm(configs, file=sys.stderr, leave=False, disable=None):
        found = measure(*config, rtl=not options.golden)
        mismatches += found["mismatches"] or 0
        tqdm.write(row(found))
    return 1 if mismatches else 0

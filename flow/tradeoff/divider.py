"""The quadrature divider: variants at 4 to 16 fraction bits and CORDIC at 4 to 16 iterations. Worst and RMS phase
error over all 2^18 inputs against latency, cycles of a time-of-flight frame at one result a pixel, and simulation time."""

from base.charts import curves
from flow.simulate.divider.exhaustive import measure as exhaustive
from models.parameters import DIVIDERS, SensorParameters


def points(quick):
    return [(variant, width) for variant in DIVIDERS for width in ((4, 8) if quick else range(4, 17))]


def measure(point):
    variant, width = point
    found = exhaustive(variant, n_frac=8 if variant == "cordic" else width, iterations=width)
    pixels = SensorParameters().array.rows * SensorParameters().array.cols
    return {
        "variant": variant,
        "width": width,
        "latency": found["latency"],
        "interval": found["interval"],
        "worst_lsb": found["worst"],
        "rms_lsb": found["rms"],
        "cycles_a_frame": pixels * found["interval"],
        "simulation_s": found["seconds"],
        "mismatches": found["mismatches"],
    }


def plot(rows):
    return curves(
        {v: [(r["latency"], r["worst_lsb"], str(r["width"])) for r in rows if r["variant"] == v] for v in DIVIDERS},
        "latency (cycles)",
        "worst phase error (LSB of 8 bits)",
        "Divider: error against latency",
        log_y=True,
    )

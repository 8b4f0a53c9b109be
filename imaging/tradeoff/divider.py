"""The quadrature divider: variants at 4 to 16 fraction bits and CORDIC at 4 to 16 iterations. Worst and RMS phase error
over all 2^18 inputs against latency, cycles of a time-of-flight frame at one result a pixel, and simulation time."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.simulate.divider import exhaustive
from talbot.models.parameters import DIVIDERS, SensorParameters


def points(quick: bool) -> list[tuple[str, int]]:
    """Variant and width: fraction bits, of CORDIC iterations."""
    variants, widths = (DIVIDERS[::3], (4, 8)) if quick else (DIVIDERS, range(4, 17))
    return [(variant, width) for variant in variants for width in widths]


def measure(point: tuple[str, int]) -> dict[str, Any]:
    """Error, cycles and simulation time of one divider over all inputs."""
    variant, width = point
    result = exhaustive.measure(exhaustive.Divider(variant, 8 if variant == "cordic" else width, width))
    pixels = SensorParameters().array.rows * SensorParameters().array.cols
    return (
        {"variant": variant, "width": width, "latency": result.latency, "interval": result.interval}
        | {"worst_lsb": result.worst, "rms_lsb": result.rms, "cycles_a_frame": pixels * result.interval}
        | {"simulation_s": result.seconds, "mismatches": result.mismatches}
    )


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """Worst error against latency."""
    series = {v: [(r["latency"], r["worst_lsb"], str(r["width"])) for r in rows if r["variant"] == v] for v in DIVIDERS}
    labels = "latency (cycles)", "worst phase error (LSB of 8 bits)", "Divider: error against latency"
    return curves(series, *labels, log_y=True)

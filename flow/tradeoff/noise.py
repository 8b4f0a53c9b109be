"""Noise on the default scene, through the chip's Verilog: PSNR of the decoded differences against the analog values
of a noiseless exposure, and what the noise costs in conversions, bytes and cycles."""

from base.charts import curves
from flow.frame import hardware, job
from flow.frame.request import request
from flow.frame.summary import summarize

LEVELS = (0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)


def points(quick):
    return [(level, 48 if quick else 384) for level in (LEVELS[::4] if quick else LEVELS)]


def measure(point):
    level, size = point
    asked = request(rows=size, cols=size, noise=level)
    scene, todo = job.see(asked)
    result = job.read_out(asked, job.expose(asked, scene, todo), hardware.program(asked.sensor, todo.taps))
    summary = summarize(result)
    return {
        "noise": level,
        "psnr_edges_db": summary["psnr_db"],
        "conversions": summary["conversions_made"],
        "bytes": summary["stream_bytes"],
        "cycles": summary["cycles"],
        "energy_uj": summary["energy_uj"]["total"],
        "simulation_s": result.chip.seconds,
        "mismatches": summary["stream_mismatches"],
    }


def plot(rows):
    return curves(
        {"decoded differences": [(r["noise"], r["psnr_edges_db"], f"{r['bytes']:,} B") for r in rows]},
        "noise (times physical)",
        "PSNR (dB)",
        "Noise: error and what it costs",
    )

"""The drawn pixel in ngspice: full well, gain, linearity, noise and lag over corners; an EMVA 1288 style table."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.arguments import number_of
from talbot.base.jobs import worker_count
from talbot.base.progress import Steps
from talbot.base.sensor import Varied, add_sensor, labelled, sensor_asked
from talbot.pixels.drawn import DUMMIES, PIXEL_PITCH, PIXEL_STEP

# What the circuit has is measured; the written sensor file has all other fields as they are
VARIED = Varied(used=("array.rows", "array.pitch", "electrical"), limits=PIXEL_PITCH, steps=PIXEL_STEP)


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot pixel-circuit`."""
    add = parser.add_argument
    add_sensor(parser)
    add("--pdk", default="sky130", help="process, sky130")
    add("--corners", default="all", help="all (tt, ss, ff at -40, 25, 85 degrees), typical, or some: tt_25,ss_-40")
    add("--gate", type=number_of, default=5.0, help="V of an active reset line, 1..5.5; 3.3 is a soft reset")
    add("--sink", type=number_of, default=5e-6, help="A of a column's sink, 1e-7..1e-3")
    add("--workers", type=worker_count, default=-1, help="processes; -1: all cores")
    add("--table", type=Path, help="also write what `make sim AFE=circuit` takes: models/parameters/pixel.json")
    add("--out", type=Path, help="folder for the results (default: build/pixel-circuit/<pdk>)")


def run(options: Namespace) -> int:
    """Measure, write page and sensor file, print the figures; 1 where a check fails."""
    from talbot.base.paths import RESULTS

    sensor = sensor_asked(options, VARIED)
    from talbot.pixels.pixel_circuit.deck import Bench
    from talbot.pixels.pixel_circuit.job import STEPS, make

    array = sensor.array
    bench = Bench(options.sink, gate_v=options.gate, rows=array.rows + 2 * DUMMIES, pitch_um=array.pitch_um)
    out = options.out or RESULTS / "pixel-circuit" / labelled(options.pdk, options)
    with Steps(STEPS, lines=True) as steps:
        summary = make(options.pdk, options.corners, bench, out, options.table, options.workers, steps.note, sensor)
    _print(summary, out)
    return 0 if summary["passed"] else 1


def _print(s: dict[str, Any], folder: Path) -> None:
    print(f"{s['process']}, {s['supply_v']:g} V, reset line at {s['bench']['gate_v']:g} V; electrons a diode")
    print("  corner        full well  uV/e  linear %  reset  read  dark noise  lag %   dark e/s")
    for name, one in s["corners"].items():
        print(
            f"  {name:14} {one['full_well']:8,.0f} {one['gain_uv']:5.2f} {100 * one['linearity']:9.2f} "
            f"{one['reset_closed']:6.1f} {one['read_noise']:5.1f} {one['dark_noise']:11.1f} {100 * one['lag']:6.3f} "
            f"{one['dark_current'] / 1.602176634e-19:10,.0f}"
        )
    e = s["emva"]
    print(
        f"  simulated exposures: saturation {e['saturation']:,.0f} e, dark noise {e['dark_noise']:.1f} e, SNR max "
        f"{e['snr_max_db']:.1f} dB, dynamic range {e['dynamic_range_db']:.1f} dB, DSNU {e['dsnu']:.1f} e, "
        f"PRNU {100 * e['prnu']:.2f} %"
    )
    print(f"  {s['wall_s']:.0f} s; look at {folder / 'pixel_circuit.html'}; make sim SENSOR={folder / 'sensor.toml'}")

"""The commands: options -> a call of models or flow -> lines for a person. Imports what is slow only when needed."""

import argparse
import json
import sys
from pathlib import Path

from flow.simulate.verilator import ToolError
from models.parameters import LANES, MODES

from . import arguments as text

__all__ = ["ToolError", "add_decode", "add_sim", "add_stability", "add_tradeoff"]


def _command(subs, name, run, help_text):
    p = subs.add_parser(name, help=help_text, description=help_text,
                        formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    p.set_defaults(run=run)
    return p


def add_sim(subs):
    p = _command(subs, "sim", _sim, "A scene through the golden models and the Verilog of the whole chip.")
    p.add_argument("--scene", default="motorcycle", help="name of a scene (--scene list shows them) or an image file")
    p.add_argument("--depth", help="depth file for --scene: .npy/.npz in m, or an image (see models/scene/README.md)")
    p.add_argument("--focus", type=float, help="disparity of the focal plane, px a view step, -100..100")
    p.add_argument("--mode", default="edge", help="one of " + ", ".join(MODES))
    p.add_argument("--threshold", type=int, default=10, help="edge mode: |code| below this is left out, 0..127")
    p.add_argument("--rows", type=int, default=384, help="pixels, 1..1024")
    p.add_argument("--cols", type=int, default=384, help="pixels, 1..1536")
    p.add_argument("--types", default="all", help="pixel types: 0x<mask>, numbers 0..23, or groups "
                                                  + ", ".join(text.TYPE_GROUPS))
    p.add_argument("--window", default="full", help="tiles to read, inclusive: row0:row1,col0:col1")
    p.add_argument("--decimation", type=int, default=0, help="log2 of the tile step, 0..3")
    p.add_argument("--lanes", type=int, default=8, help="converters, one of " + ", ".join(map(str, LANES)))
    p.add_argument("--phase", action="store_true", help="tof mode: phase and amplitude from the chip's divider")
    p.add_argument("--noise", type=float, default=1.0, help="times the physical noise, 0..100")
    p.add_argument("--seed", type=int, default=1, help="of every random draw, 0..4294967295")
    p.add_argument("--out", help="folder for the results (default build/sim/<scene>)")
    p.add_argument("--waves", help="also write waves.vcd of these rows, first:last (1 = the first four rows)")


def _sim(a):
    from flow.frame.job import run
    from flow.frame.request import request
    from models.scene import scenes

    if a.scene == "list":
        print("\n".join(sorted(scenes)))
        return 0
    waves = (0, min(3, a.rows - 1)) if a.waves == "1" else text.span("waves", a.waves, 0, a.rows - 1) if a.waves else None
    asked = request(rows=a.rows, cols=a.cols, lanes=a.lanes, window=lambda full: text.window(a.window, full),
                    mask=text.pixel_types(a.types), scene=a.scene, depth=a.depth, focus=a.focus, mode=a.mode,
                    threshold=a.threshold, decimation=a.decimation, phase=a.phase, noise=a.noise, seed=a.seed,
                    out=a.out, waves=waves)
    summary = run(asked, note=_note)
    _tell(summary, asked.folder)
    return 1 if summary["stream_mismatches"] or summary["decoded_mismatches"] else 0


def _note(line):
    print(f"  {line} ...", file=sys.stderr, flush=True)


def _tell(s, folder):
    psnr = "exact" if s["psnr_db"] is None else f"{s['psnr_db']:.2f} dB"
    print(f"{s['scene']}, {s['mode']} mode, {s['rows']} x {s['cols']}: "
          f"{s['stream_mismatches']} stream bytes and {s['decoded_mismatches']} decoded samples differ from the model")
    print(f"  {s['stream_bytes']:,} bytes for {s['samples']:,} samples ({s['compression_ratio']:.2f}:1) at {psnr}")
    print(f"  {s['conversions_made']:,} conversions made, {s['conversions_left_out']:,} left out; "
          f"{s['cycles']:,} cycles = {1e3 * s['frame_s_at_clock']:.2f} ms; {s['energy_uj']['total']:.2f} uJ")
    print(f"  simulated at {s['rtl_cycles_per_s'] / 1e6:.1f} M cycles/s; wall clock {sum(s['wall_s'].values()):.1f} s")
    print(f"  look at {folder / 'report.html'}")


def add_decode(subs):
    p = _command(subs, "decode", _decode, "A byte stream of the chip back to samples (.npz).")
    p.add_argument("file", help="stream.bin of a run, or captured from a chip")
    p.add_argument("--out", help="the .npz to write (default: beside FILE)")


def _decode(a):
    from models.digital.stream import decode_file

    out = Path(a.out) if a.out else Path(a.file).with_suffix(".npz")
    frames = decode_file(a.file, out)
    for frame in frames:
        bad = f"bad rows {', '.join(map(str, frame.bad_rows))}" if len(frame.bad_rows) else "every row good"
        print(f"frame {frame.header.frame_number}: {frame.header.mode}, {frame.header.rows} x {frame.header.cols}, {bad}")
    print(f"written: {out}")
    return 0


def add_tradeoff(subs):
    p = _command(subs, "tradeoff", _tradeoff, "Error against run time: a table (CSV) and a plot for each thing to turn.")
    p.add_argument("--only", help="comma-separated names of sweeps (default: all)")
    p.add_argument("--out", default="build/tradeoff", help="folder for the tables and plots")


def _tradeoff(a):
    from flow.tradeoff import run

    run(Path(a.out), a.only.split(",") if a.only else None)
    print(f"look at {Path(a.out) / 'tradeoff.html'}")
    return 0


def add_stability(subs):
    p = _command(subs, "stability", _stability, "Stiff and extreme cases: case, expected bound, measured.")
    p.add_argument("--json", help="also write the table to this file")


def _stability(a):
    from flow.stability import run, table

    cases = run()
    print(table(cases))
    if a.json:
        Path(a.json).write_text(json.dumps([vars(c) for c in cases], indent=1))
    return 0 if all(c.ok for c in cases) else 1

"""The commands: options -> a call of models or flow -> lines for a person. Imports what is slow only when needed."""

import argparse
import json
from pathlib import Path

from base.progress import Steps
from models.parameters import LANES, MODES

from . import arguments as text

__all__ = ["add_decode", "add_sim", "add_stability", "add_tradeoff"]


def _command(subs, name, run, help_text):
    p = subs.add_parser(
        name, help=help_text, description=help_text, formatter_class=argparse.ArgumentDefaultsHelpFormatter
    )
    p.set_defaults(run=run)
    return p


def add_sim(subs):
    p = _command(subs, "sim", _sim, "A scene through the golden models and the Verilog of the whole chip.")
    p.add_argument("--scene", default="motorcycle", help="name of a scene (--scene list shows them) or an image file")
    p.add_argument("--depth", help="depth file for --scene: .npy/.npz in m, or an image (see models/scene/README.md)")
    p.add_argument("--focus", help="disparity of the focal plane, px a view step, -100..100")
    p.add_argument("--mode", default="edge", help="one of " + ", ".join(MODES))
    p.add_argument("--threshold", default=10, help="edge mode: |code| below this is left out, 0..127")
    p.add_argument("--rows", default=384, help="pixels, 1..1024")
    p.add_argument("--cols", default=384, help="pixels, 1..1536")
    p.add_argument(
        "--types", default="all", help="pixel types: 0x<mask>, numbers 0..23, or groups " + ", ".join(text.TYPE_GROUPS)
    )
    p.add_argument("--window", default="full", help="tiles to read, inclusive: row0:row1,col0:col1")
    p.add_argument("--decimation", default=0, help="log2 of the tile step, 0..3")
    p.add_argument("--lanes", default=8, help="converters, one of " + ", ".join(map(str, LANES)))
    p.add_argument("--phase", action="store_true", help="tof mode: phase and amplitude from the chip's divider")
    p.add_argument("--noise", default=1.0, help="times the physical noise, 0..100")
    p.add_argument("--seed", default=1, help="of every random draw, 0..4294967295")
    p.add_argument("--out", help="folder for the results (default build/sim/<scene>)")
    p.add_argument("--waves", help="also write waves.vcd of these rows, first:last (1 = the first four rows)")


def _sim(a):
    from flow.frame.job import STEPS, run
    from models.scene import scenes

    if a.scene == "list":
        print("\n".join(sorted(scenes)))
        return 0
    asked = _request(a)
    with Steps(STEPS) as steps:
        summary = run(asked, note=steps.note)
    _tell(summary, asked.folder)
    return 1 if summary["stream_mismatches"] or summary["decoded_mismatches"] else 0


def _request(a):
    """The FrameRequest of the options ``a``. Raises ParameterError."""
    from flow.frame.request import request

    rows, cols = text.integer("rows", a.rows, 1, 1024), text.integer("cols", a.cols, 1, 1536)
    waves = (0, min(3, rows - 1)) if a.waves == "1" else text.span("waves", a.waves, 0, rows - 1) if a.waves else None
    focus = None if a.focus is None else text.real("focus", a.focus, -100, 100)
    return request(
        rows=rows,
        cols=cols,
        lanes=text.integer("lanes", a.lanes, min(LANES), max(LANES)),
        window=lambda full: text.window(a.window, full),
        mask=text.pixel_types(a.types),
        scene=a.scene,
        depth=a.depth,
        focus=focus,
        mode=a.mode,
        threshold=text.integer("threshold", a.threshold, 0, 127),
        decimation=text.integer("decimation", a.decimation, 0, 3),
        phase=a.phase,
        noise=text.real("noise", a.noise, 0, 100),
        seed=text.integer("seed", a.seed, 0, 2**32 - 1),
        out=a.out,
        waves=waves,
    )


def _tell(s, folder):
    psnr = "exact" if s["psnr_db"] is None else f"{s['psnr_db']:.2f} dB"
    print(
        f"{s['scene']}, {s['mode']} mode, {s['rows']} x {s['cols']}: "
        f"{s['stream_mismatches']} stream bytes and {s['decoded_mismatches']} decoded samples differ from the model"
    )
    print(f"  {s['stream_bytes']:,} bytes for {s['samples']:,} samples ({s['compression_ratio']:.2f}:1) at {psnr}")
    print(
        f"  {s['conversions_made']:,} conversions made, {s['conversions_left_out']:,} left out; "
        f"{s['cycles']:,} cycles = {1e3 * s['frame_s_at_clock']:.2f} ms; {s['energy_uj']['total']:.2f} uJ"
    )
    print(f"  simulated at {s['rtl_cycles_per_s'] / 1e6:.1f} M cycles/s; wall clock {sum(s['wall_s'].values()):.1f} s")
    print(f"  look at {folder / 'report.html'}")


def add_decode(subs):
    p = _command(subs, "decode", _decode, "A byte stream of the chip back to samples (.npz).")
    p.add_argument("file", help="stream.bin of a run, or captured from a chip")
    p.add_argument("--out", help="the .npz to write (default: beside FILE)")


def _decode(a):
    from base.files import check_folder
    from models.digital.stream import decode_file

    out = Path(a.out) if a.out else Path(a.file).with_suffix(".npz")
    check_folder("out", out.parent)
    frames = decode_file(a.file, out)
    for frame in frames:
        h = frame.header
        bad = [f"bad rows: {ranges(frame.bad_rows)}"] if frame.bad_rows else []
        print(
            f"frame {h.frame_number}: {h.mode}, {h.rows} x {h.cols}, {'; '.join([*frame.errors, *bad]) or 'complete'}"
        )
    print(f"written: {out}")
    return 0 if all(frame.complete for frame in frames) else 1


def ranges(numbers):
    """Sorted integers in short: '3-7, 9', or 'none'."""
    runs = []
    for n in map(int, numbers):
        if runs and n == runs[-1][1] + 1:
            runs[-1][1] = n
        else:
            runs.append([n, n])
    return ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in runs) or "none"


def add_tradeoff(subs):
    p = _command(
        subs, "tradeoff", _tradeoff, "Error against run time: a table (CSV) and a plot for each thing to turn."
    )
    p.add_argument("--only", help="comma-separated names of sweeps (default: all)")
    p.add_argument("--out", default="build/tradeoff", help="folder for the tables and plots")


def _tradeoff(a):
    from base.files import check_folder
    from flow.tradeoff import run

    check_folder("out", a.out)
    run(Path(a.out), a.only.split(",") if a.only is not None else None)
    print(f"look at {Path(a.out) / 'tradeoff.html'}")
    return 0


def add_stability(subs):
    p = _command(subs, "stability", _stability, "Stiff and extreme cases: case, expected bound, measured.")
    p.add_argument("--json", help="also write the table to this file")


def _stability(a):
    from base.files import check_folder, staged
    from flow.stability import run
    from models.stability import table

    if a.json:
        check_folder("json", Path(a.json).parent)
    cases = run()
    print(table(cases))
    if a.json:
        with staged(Path(a.json).parent) as part:
            (part / Path(a.json).name).write_text(json.dumps([vars(c) for c in cases], indent=1) + "\n")
    return 0 if all(c.ok for c in cases) else 1

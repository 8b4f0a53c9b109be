"""`python -m verif.fuzz`: a million inputs for the decoder, and every byte of real frames wrong once.

Batches are jobs, each made from the seed alone; what was done before is kept. A failing input's bytes lie in
build/verify/fuzz/, and --only shows what the decoder makes of one input.
"""

import argparse
import sys
from pathlib import Path

from joblib.externals.loky.process_executor import TerminatedWorkerError

from base.jobs import Job, run
from models.parameters import ParameterError, check_int
from verif.results import OUT, write_step

from .batch import BATCH, make_input, run_batch, try_input
from .resync import AROUND, FRAMES, sweep

CHANGES = 16  # wrong values tried at each byte of a real frame
SEED = 1


def batches(inputs, seed, folder):
    """Jobs for ``inputs`` inputs: list of Job."""
    counts = [BATCH] * (inputs // BATCH) + ([inputs % BATCH] if inputs % BATCH else [])
    return [
        Job(f"batch-{seed}-{i}", run_batch, (seed, i, count, str(folder)), (count,)) for i, count in enumerate(counts)
    ]


def sweeps(count, seed):
    """Jobs of the resynchronisation: list of Job."""
    return [
        Job(f"resync-{name}-{around.replace(' ', '-')}", sweep, (name, around, count, seed), (count, seed))
        for name in FRAMES
        for around in AROUND
    ]


def summarize(seed, done, swept):
    """What the batches and sweeps found, by block."""

    def total(key):
        return sum(d[key] for d in done)

    kinds = {}
    for d in done:
        for kind, n in d["kinds"].items():
            kinds[kind] = kinds.get(kind, 0) + n
    failures = [(d["batch"], f) for d in done for f in d["failures"]]
    decoder = [
        f"batch {b}, input {f['index']} ({f['kind']}): {f['error']}" + (f": {f['file']}" if f["file"] else "")
        for b, f in failures
        if f["target"] == "decoder"
    ]
    host = [
        f"batch {b}, input {f['index']} ({f['kind']}): {f['error']}" for b, f in failures if f["target"] != "decoder"
    ]
    lost = [text for s in swept for text in s["failures"]]
    return {
        "Decoder": {
            "fuzz": {
                "inputs": total("inputs"),
                "failures": len(decoder),
                "files": total("files"),
                "seconds_max": max((d["seconds_max"] for d in done), default=0.0),
                "seed": seed,
                "kinds": kinds,
            },
            "resync": {
                "tried": sum(s["tried"] for s in swept),
                "failures": sum(s["failed"] for s in swept),
                "mended": sum(s["mended"] for s in swept),
                "frames": swept,
            },
            "open_points": decoder[:10] + lost[:10],
        },
        "Host": {"fuzz": {"inputs": total("host"), "failures": len(host), "seed": seed}, "open_points": host[:10]},
    }


def under_way(folder):
    """Inputs that were being decoded when a process ended, by the marks that batches leave: list of text."""
    return [f"batch {mark.suffix[1:]}, input {mark.read_text().strip()}" for mark in sorted(folder.glob("at.*"))]


def arguments():
    parser = argparse.ArgumentParser(
        prog="python -m verif.fuzz",
        description=__doc__.split("`: ")[1],
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--inputs", type=int, default=1_000_000, help="for the decoder; default: %(default)s")
    parser.add_argument("--seed", type=int, default=SEED, help="default: %(default)s")
    parser.add_argument(
        "--changes",
        type=int,
        default=CHANGES,
        help="wrong values at each byte of the real frames, 0..255; default: %(default)s",
    )
    parser.add_argument("--only", nargs=2, type=int, metavar=("BATCH", "INPUT"), help="one input, and what raises")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of fuzz.json; default: build/verify")
    return parser


def main(argv=None):
    """Returns 0, 1 when an input failed, 2 for a wrong argument."""
    options = arguments().parse_args(argv)
    folder = options.out / "fuzz"
    try:
        check_int("inputs", options.inputs, 0, 10**9)
        check_int("seed", options.seed, 0, 2**32 - 1)
        check_int("changes", options.changes, 0, 255)
        if options.only:
            return show(options.seed, *options.only)
        for mark in folder.glob("at.*"):
            mark.unlink(missing_ok=True)
        done = run(batches(options.inputs, options.seed, folder), folder, "fuzz")
        swept = run(sweeps(options.changes, options.seed), folder, "resync") if options.changes else []
    except (ParameterError, OSError) as error:
        print(f"verif.fuzz: {error}", file=sys.stderr)
        return 2
    except TerminatedWorkerError:
        print(
            f"verif.fuzz: a process ended (crash, or an input that takes for ever) at: "
            f"{'; '.join(under_way(folder))}; seed {options.seed}: see --only",
            file=sys.stderr,
        )
        return 1
    found = summarize(options.seed, done, swept)
    write_step("fuzz", found, options.out)
    return report(found)


def show(seed, batch, index):
    """One input by itself: its bytes on the screen, and whatever the decoder raises."""
    case = make_input(seed, batch, index)
    print(f"{case.kind}, {len(case.data)} bytes, tile {case.tile.rows} x {case.tile.cols}: {case.data.hex()}")
    outcome, seconds = try_input(case, True)
    print(f"{outcome} in {1e3 * seconds:.2f} ms")
    return 0


def report(found):
    fuzz, resync, host = found["Decoder"]["fuzz"], found["Decoder"]["resync"], found["Host"]["fuzz"]
    slowest = 1e3 * fuzz["seconds_max"]
    print(f"decoder: {fuzz['inputs']:,} inputs, {fuzz['failures']} failures, slowest {slowest:.0f} ms")
    print(f"host and registers: {host['inputs']:,} inputs, {host['failures']} failures")
    print(f"resynchronisation: {resync['tried']:,} wrong bytes, {resync['failures']} cost more than a row")
    for block in found.values():
        for point in block["open_points"]:
            print(f"  {point}", file=sys.stderr)
    return int(fuzz["failures"] + host["failures"] + resync["failures"] > 0)


if __name__ == "__main__":
    sys.exit(main())

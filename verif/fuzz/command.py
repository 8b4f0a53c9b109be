"""Inputs for the decoder, sessions at the chip's pins, and every byte of real frames changed: build/verify/fuzz.json.

An input of the decoder depends on the seed, its batch and its number alone. The bytes of a failing one are kept in
build/verify/fuzz/; --only decodes a single input. Sessions are guided by coverage: build/verify/fuzz/chip has their
corpus and those that fail; --session runs one of these.
"""

import sys
from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from joblib.externals.loky.process_executor import TerminatedWorkerError

from talbot.base.arguments import whole_of
from talbot.base.command import failures
from talbot.base.jobs import Job
from talbot.base.jobs import run as run_jobs
from talbot.base.records import from_json
from talbot.models.parameters import check_int
from talbot.rtl.contract import FILE as CONTRACT
from talbot.verif.fuzz.batch import BATCH, Batch, make_input, run_batch, try_input
from talbot.verif.fuzz.chip.guided import Search, again, search
from talbot.verif.fuzz.chip.program import CHIPS, MAIN
from talbot.verif.fuzz.resync import AROUND, FRAMES, sweep
from talbot.verif.results import OUT, BlockResults, Fuzz, Resync, Sweep, seed_of, write_step

CHANGES = 16  # wrong values tried at each byte of a real frame
CYCLES = 10_000_000  # of all chips


def batches(inputs: int, seed: int, folder: Path) -> list[Job]:
    """Return the jobs of ``inputs`` inputs."""
    counts = [BATCH] * (inputs // BATCH) + ([inputs % BATCH] if inputs % BATCH else [])
    return [Job(f"batch-{seed}-{i}", run_batch, (seed, i, count, folder), (count,)) for i, count in enumerate(counts)]


def sweeps(count: int, seed: int) -> list[Job]:
    """Return the jobs of the resynchronisation. count: changes of each byte."""
    return [
        Job(f"resync-{name}-{around.replace(' ', '-')}", sweep, (name, around, count, seed), (count, seed))
        for name in FRAMES
        for around in AROUND
    ]


def searches(cycles: int, seed: int, folder: Path) -> list[Job]:
    """Return the jobs of ``cycles`` cycles at the chip's pins."""
    share = -(-cycles // len(CHIPS))
    return [
        Job(f"chip-{number}", search, (name, share, seed, folder / "chip"), (name, share, seed, MAIN, CONTRACT))
        for number, name in enumerate(CHIPS)
    ]


def summarize_chip(seed: int, done: Sequence[Search]) -> dict[str, BlockResults]:
    """Return the results of the searches, for the block AspChip."""
    counts = {name: sum(getattr(one, name) for one in done) for name in ("cycles", "points", "corpus")}
    failures = [line for one in done for line in one.failures]
    fuzz = Fuzz(sum(one.sessions for one in done), len(failures), seed, kinds=counts)
    return {"AspChip": BlockResults(fuzz=fuzz, open_points=failures)} if done else {}


def summarize(seed: int, done: Sequence[Batch], swept: Sequence[Sweep]) -> dict[str, BlockResults]:
    """Return the results of batches and sweeps, for the blocks Decoder and Host."""
    kinds = Counter()
    decoder, host = [], []
    for batch in done:
        kinds.update(batch.kinds)
        for f in batch.failures:
            line = f"batch {batch.batch}, input {f.index} ({f.kind}): {f.error}" + (f": {f.file}" if f.file else "")
            line += f"; again: talbot fuzz --seed {seed} --only {batch.batch} {f.index}"
            (decoder if f.target == "decoder" else host).append(line)
    inputs, files = sum(d.inputs for d in done), sum(d.files for d in done)
    slowest = max((d.seconds_max for d in done), default=0.0)
    tried, failed = sum(s.tried for s in swept), sum(s.failed for s in swept)
    lost = [line for s in swept for line in s.failures]
    return {
        "Decoder": BlockResults(
            fuzz=Fuzz(inputs, len(decoder), seed, files, slowest, dict(kinds)),
            resync=Resync(tried, failed, sum(s.recovered for s in swept), list(swept)),
            open_points=decoder[:10] + lost[:10],
        ),
        "Host": BlockResults(fuzz=Fuzz(sum(d.host for d in done), len(host), seed), open_points=host[:10]),
    }


def running(folder: Path) -> list[str]:
    """Return the inputs in progress when a process ended, by the marks of the batches."""
    return [
        f"batch {mark.suffix[1:]}, input {mark.read_text(encoding='utf-8').strip()}"
        for mark in sorted(folder.glob("at.*"))
    ]


SEED_OPTION = seed_of("of what is random")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot fuzz`."""
    parser.add_argument("--inputs", type=whole_of, default=1_000_000, help="for the decoder")
    SEED_OPTION.add(parser)
    parser.add_argument(
        "--changes", type=whole_of, default=CHANGES, help="wrong values at each byte of the real frames, 0..255"
    )
    parser.add_argument("--cycles", type=whole_of, default=CYCLES, help="of sessions at the chip's pins")
    parser.add_argument(
        "--session", type=Path, metavar="FILE", help="run one session, a file of build/verify/fuzz/chip"
    )
    parser.add_argument("--only", nargs=2, type=whole_of, metavar=("BATCH", "INPUT"), help="one input by itself")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of fuzz.json")


def run(options: Namespace) -> int:
    """Return 0, 1 when an input failed."""
    folder = options.out / "fuzz"
    check_int("inputs", options.inputs, 0, 10**9)
    seed = SEED_OPTION.value(options)
    check_int("changes", options.changes, 0, 255)
    check_int("cycles", options.cycles, 0, 10**12)
    if options.session:
        return failures(again(options.session))
    if options.only:
        for number in options.only:
            check_int("only", number, 0, 10**9)
        return show(seed, *options.only)
    for mark in folder.glob("at.*"):
        mark.unlink(missing_ok=True)
    try:
        planned = batches(options.inputs, seed, folder)
        done = from_json(list[Batch], run_jobs(planned, folder, "fuzz"))
        jobs = sweeps(options.changes, seed) if options.changes else []
        swept = from_json(list[Sweep], run_jobs(jobs, folder, "resync"))
        guided = searches(options.cycles, seed, folder) if options.cycles else []
        searched = from_json(list[Search], run_jobs(guided, folder, "chip"))
    except TerminatedWorkerError:
        where = "; ".join(running(folder))
        return failures([f"a process ended (crash or timeout) at: {where}; seed {seed}: see --only"])
    every = zip((*planned, *jobs, *guided), (*done, *swept, *searched), strict=True)
    for job, result in every:
        if result.failures:
            job.file(folder).unlink(missing_ok=True)  # failures are tried again
    results = summarize(seed, done, swept) | summarize_chip(seed, searched)
    write_step("fuzz", results, options.out)
    return report(results)


def show(seed: int, batch: int, index: int) -> int:
    """Print and decode one input. Raises the decoder's exception."""
    case = make_input(seed, batch, index)
    print(f"{case.kind}, {len(case.data)} bytes, tile {case.tile.rows} x {case.tile.cols}: {case.data.hex()}")
    outcome, seconds = try_input(case, True)
    print(f"{outcome} in {1e3 * seconds:.2f} ms")
    return 0


def report(results: Mapping[str, BlockResults]) -> int:
    """Print the figures and open points; returns the exit status."""
    failures = 0
    for block, entry in results.items():
        for part in (entry.fuzz, entry.resync):
            failures += part.failures if part else 0
        if fuzz := entry.fuzz:
            slowest = f", slowest {1e3 * fuzz.seconds_max:.0f} ms" if fuzz.seconds_max else ""
            inputs = f"{fuzz.inputs:,} inputs"
            if "cycles" in (kinds := fuzz.kinds):
                inputs = f"{fuzz.inputs:,} sessions, {kinds['cycles']:,} cycles, {kinds['points']:,} points reached"
            print(f"{block}: {inputs}, {fuzz.failures} failures{slowest}, seed {fuzz.seed}")
        if resync := entry.resync:
            print(f"resynchronisation: {resync.tried:,} wrong bytes, {resync.failures} lose more than a row")
        for point in entry.open_points:
            print(f"  {point}", file=sys.stderr)
    return int(failures > 0)

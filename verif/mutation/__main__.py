"""`python -m verif.mutation`: mutants of the RTL, and what the tests make of them: build/verify/mutation.json.

A seeded sample by Yosys, spread over the modules of each block, takes the block's place in its tests. A mutant with
which they all pass is compared with the original by induction. What is left has survived: a bug of the tests. Exit
status 1 if there is one.
"""

import argparse
import json
import sys
from pathlib import Path

from base.jobs import Job, run
from base.paths import ROOT
from base.sources import code
from base.tools import ToolError
from models.parameters import ParameterError
from rtl.replay import RecordError, load
from rtl.tops import TOPS
from verif.coverage.program import compile_program
from verif.coverage.testplan import folder_of
from verif.coverage.traces import recorded
from verif.results import OUT, write_step

from .judge import EQUIVALENT, KILLED, SURVIVED, judge, try_original, try_tests
from .mutants import generate, with_mutants

SEED = 1
NUMBERS = {
    "AmpCtrl": 55,
    "ReadoutSeq": 70,
    "EdgeAdc": 40,
    "AdcBank": 40,
    "QuadDividerRadix2": 32,
    "QuadDividerRadix4": 32,
    "QuadDividerPipelined": 32,
    "Cordic": 40,
    "PhasePath": 48,
    "RunLength": 90,
    "RegFile": 55,
    "AspChip": 40,
}


def plant(block, path, store, number, seed):
    """Mutants of the trace ``path``'s component, into a folder of ``store``: (the folder, list of Mutant)."""
    trace = load(path, cycles=False)
    verilog = trace.verilog()
    mutants = generate(verilog, trace.cls, folder_of(block), number, seed)
    text = with_mutants(verilog, trace.cls, mutants)
    folder = Path(store) / block
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mutants.v").write_text(text)
    compile_program(text, trace.cls, trace.ports, mutant=True)
    return folder, mutants


def score(blocks, store, factor=1.0, seed=SEED):
    """By block: (list of Mutant, list of what `try_tests` or `judge` says of each)."""
    traces = recorded(blocks, store.parent / "traces")
    tests, judges, whole, made = [], [], [], {}
    for block in blocks:
        path = traces[block][0]
        folder, made[block] = plant(block, path, store, max(4, round(factor * NUMBERS[block])), seed)
        text = folder / "mutants.v"
        decides = path.with_suffix(".trace"), text, code(f"rtl/{folder_of(block)}/test")
        whole.append(Job(block, try_original, (str(path), str(folder)), decides))
        for mutant in made[block]:
            name, arguments = f"{block}-{mutant.number}", (str(path), str(folder), mutant)
            tests.append(Job(name, try_tests, arguments, decides))
            judges.append(
                Job(name, judge, arguments, (text, ROOT / "rtl" / folder_of(block) / "formal"))
            )  # whatever the tests are
    run(whole, store / "tests", "tests without a mutant")
    results = run(tests, store / "tests", "mutants against the tests")
    left = [i for i, result in enumerate(results) if result["result"] == SURVIVED]
    for i, result in zip(left, run([judges[i] for i in left], store / "judged", "what is left"), strict=True):
        results[i] = result
    results = iter(results)
    return {block: (mutants, [next(results) for _ in mutants]) for block, mutants in made.items()}


def summary(mutants, results):
    """What a block's entry in mutation.json says."""
    count = {name: sum(r["result"] == name for r in results) for name in (EQUIVALENT, KILLED, SURVIVED)}
    left = [
        f"mutant {mutant} = survived, difference {result['difference']}"
        for mutant, result in zip(mutants, results, strict=True)
        if result["result"] == SURVIVED
    ]
    return {"mutants": {"made": len(mutants), **count}, "open_points": left}


def arguments():
    parser = argparse.ArgumentParser(
        prog="python -m verif.mutation",
        description=__doc__.split("`: ")[1],
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--only", nargs="+", choices=TOPS, metavar="BLOCK", help=f"of {', '.join(TOPS)}")
    parser.add_argument("--seed", type=int, default=SEED, help="of the sample (%(default)s)")
    parser.add_argument("--factor", type=float, default=1.0, help="of the sample's size (%(default)s)")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of mutation.json; default: build/verify")
    return parser


def main(argv=None):
    """Returns 0, 1 with survivors, 2 where nothing could be measured."""
    options = arguments().parse_args(argv)
    try:
        if not 0 < options.factor <= 100:
            raise ParameterError(f"factor = {options.factor}: must be in 0..100")
        scores = score(options.only or list(TOPS), options.out / "mutation", options.factor, options.seed)
    except (ParameterError, ToolError, RecordError, OSError) as error:
        print(f"verif.mutation: {error}", file=sys.stderr)
        return 2
    found = {block: summary(*both) for block, both in scores.items()}
    write_step("mutation", found, options.out)
    for block, entry in found.items():
        print(f"{block}: {json.dumps(entry['mutants'])}", flush=True)
        for text in entry["open_points"]:
            print(f"  {text}")
    whole = {
        name: sum(entry["mutants"][name] for entry in found.values()) for name in ("made", EQUIVALENT, KILLED, SURVIVED)
    }
    print(f"all, seed {options.seed}: {json.dumps(whole)}")
    return int(whole[SURVIVED] > 0)


if __name__ == "__main__":
    sys.exit(main())

"""`python -m verif.formal`: every property proven, every cover point reached, every broken twin caught.

The exit status is 1 unless every property is proven by every engine named for it, every cover point of its wrapper is
reached, and every twin fails. An answer that does not come in time is not a proof.
"""

import argparse
import json
import sys
from pathlib import Path

from base import jobs as regression
from base.files import staged
from models.parameters import ParameterError
from rtl.tops import TOPS

from . import manifest
from .engine import PROVEN, UNKNOWN, FormalError, tool_or_none, version
from .plan import jobs

OUT = Path("build/verify")


def collect(proofs, store, workers=-1):
    """Run every job of ``proofs``: list of (Proof, dict engine -> result, cover result, dict label -> twin result)."""
    planned = [(proof, jobs(proof, present(proof))) for proof in proofs]
    every = [job for _, entries in planned for _, _, job in entries]
    results = iter(regression.run(every, store, "formal", workers))
    found = []
    for proof, entries in planned:
        engines, twins, covers = {}, {}, None
        for kind, name, job in entries:
            result = next(results)
            if UNKNOWN in (result.get("result"), result.get("status")):  # to be tried again next time
                (Path(store) / f"{job.name}.{job.digest}.json").unlink(missing_ok=True)
            if kind == "proof":
                engines[name] = result
            elif kind == "cover":
                covers = result
            else:
                twins[name] = result
        found.append((proof, engines, covers, twins))
    return found


def present(proof):
    """The engines of a proof that are here: its first, which must be, and others that are installed."""
    return [proof.engines[0], *(engine for engine in proof.engines[1:] if tool_or_none(engine))]


def entries(found):
    """One line a property and engine: list of dict, with the block and the wrapper's name."""
    out = []
    for proof, engines, covers, twins in found:
        for label, twin in twins.items():
            for engine, result in engines.items():
                out.append(
                    {
                        "block": proof.block,
                        "proof": proof.name,
                        "name": f"{proof.name}.{label}",
                        "engine": f"{engine} ({version(engine)}, {version('yosys')})",
                        "depth": "unbounded" if proof.method == "induction" else proof.depth,
                        "result": result["result"],
                        "twin_fails": twin["fails"],
                        "wall_s": result["wall_s"],
                        "covers_missing": covers["missing"],
                    }
                )
    return out


def problems(found):
    """What is not as it must be: list of one-line texts."""
    out = []
    for proof, engines, covers, twins in found:
        for engine, result in engines.items():
            if result["result"] != PROVEN:
                where = ", ".join(result["failing"]) or result["said"]
                out.append(f"{proof.block}.{proof.name} = {result['result']} by {engine}: must be proven ({where})")
        out += [
            f"{proof.block}.{proof.name}.{name} = not reached: every cover point must be, in {proof.cover_depth} steps"
            for name in covers["missing"]
        ]
        out += [
            f"{proof.block}.{proof.name}.{label} = {twin['status']} with its bug in the design: must fail"
            for label, twin in twins.items()
            if not twin["fails"]
        ]
    return out


def summary(found):
    """build/verify/formal.json: by block, its proofs and open points."""
    out = {}
    lines = entries(found)
    faults = problems(found)
    for block in TOPS:
        proofs = [
            {k: line[k] for k in ("name", "engine", "depth", "result", "twin_fails", "wall_s")}
            for line in lines
            if line["block"] == block
        ]
        if proofs:
            out[block] = {"proofs": proofs, "open_points": [f for f in faults if f.startswith(f"{block}.")]}
    return out


def table(found):
    """Block, property, engine, depth, seconds: text."""
    rows = [("block", "property", "engine", "depth", "result", "twin", "s")]
    for line in entries(found):
        rows.append(
            (
                line["block"],
                line["name"],
                line["engine"].split()[0],
                str(line["depth"]),
                line["result"],
                "fails" if line["twin_fails"] else "PASSES",
                f"{line['wall_s']:.1f}",
            )
        )
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def chosen(proofs, options):
    """Those of ``proofs`` that the command line asks for. Raises ParameterError where it asks for none."""
    unknown = set(options.proof or ()) - {proof.name for proof in proofs}
    if unknown:
        raise ParameterError(f"proof = {', '.join(sorted(unknown))}: must be the name of a proof")
    found = [
        proof
        for proof in proofs
        if (not options.only or proof.block in options.only) and (not options.proof or proof.name in options.proof)
    ]
    if not found:
        raise ParameterError(f"only = {', '.join(options.only or options.proof)}: must be a block with proofs")
    return found


def arguments():
    parser = argparse.ArgumentParser(prog="python -m verif.formal", description=__doc__.split("`: ")[1])
    parser.add_argument("--only", action="append", metavar="BLOCK", choices=TOPS, help="a block (may be repeated)")
    parser.add_argument("--proof", action="append", metavar="NAME", help="a proof by its name (may be repeated)")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of formal.json (%(default)s)")
    parser.add_argument("--workers", type=int, default=-1, help="processes; default: all cores")
    return parser


def main(argv=None):
    options = arguments().parse_args(argv)
    try:
        proofs = chosen(manifest.every(), options)
        found = collect(proofs, options.out / "formal", options.workers)
        with staged(options.out) as part:
            (part / "formal.json").write_text(json.dumps(summary(found), indent=1) + "\n")
        print(table(found))
        for engine in sorted({e for proof in proofs for e in proof.engines} - {"boolector"}):
            if not tool_or_none(engine):
                print(
                    f"verif.formal: {engine} = not found: second engine left out; make tools installs it",
                    file=sys.stderr,
                )
    except (ParameterError, FormalError, OSError) as error:
        print(f"verif.formal: {error}", file=sys.stderr)
        return 2
    faults = problems(found)
    for fault in faults:
        print(f"verif.formal: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

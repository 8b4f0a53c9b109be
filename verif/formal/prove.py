"""The independent pieces of a proof, as jobs: base and step with each engine, the covers, each property's twin."""

import re

from .engine import FAILED, PROVEN, UNKNOWN, Workplace, labels


def prove(proof, engine, texts, wrapper):
    """Base and, for an induction, step of all properties of a wrapper: dict result, failing, wall_s, said."""
    with Workplace(texts, wrapper, proof.top) as place:
        status, output, wall = place.check(engine, ["-t", str(proof.depth), "--presat"], proof.timeout)
        result = {"passed": PROVEN, "failed": FAILED}.get(status, UNKNOWN)
        if result == PROVEN and proof.method == "induction":
            status, output, more = place.check(engine, ["-i", "-t", str(proof.depth)], proof.timeout)
            wall += more
            result = PROVEN if status == "passed" else UNKNOWN  # a failed step is no counterexample
    failing = sorted(set(re.findall(r"Assert failed in \S+: (?:.*\()?(\w+)", output)))
    return {
        "result": result,
        "failing": failing,
        "wall_s": round(wall, 2),
        "said": "" if result == PROVEN else _last_lines(output),
    }


def cover(proof, texts, wrapper):
    """Which cover points are reached within cover_depth: dict reached, missing, wall_s."""
    engine = proof.engines[0]
    with Workplace(texts, wrapper, proof.top) as place:
        _, output, wall = place.check(engine, ["-c", "-t", str(proof.cover_depth)], proof.timeout)
    reached = set(re.findall(r"Reached cover statement(?: in step \d+)? at (?:\S+: )?(\w+)", output))
    named = labels(proof.text)[2]
    return {
        "reached": [n for n in named if n in reached],
        "missing": [n for n in named if n not in reached],
        "wall_s": round(wall, 2),
    }


def twin(proof, label, texts, wrapper):
    """Whether the broken design violates the one property: dict fails, wall_s, said."""
    engine = proof.engines[0]
    depth = proof.twins[label].depth or proof.twin_depth
    with Workplace(texts, wrapper, proof.top, only=label) as place:
        status, output, wall = place.check(engine, ["-t", str(depth)], proof.timeout)
    steps = re.findall(r"Checking assertions in step (\d+)", output)
    return {
        "fails": status == "failed" and f": {label}" in output,
        "wall_s": round(wall, 2),
        "status": status,
        "step": int(steps[-1]) if steps else None,
    }


def _last_lines(output, count=3):
    return " / ".join(line.strip() for line in output.strip().splitlines()[-count:])

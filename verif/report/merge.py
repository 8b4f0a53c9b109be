"""One summary by block from the results of all steps, and the figures that limits are set for."""

from rtl.tops import TOPS
from verif.suite.blocks import BLOCKS

COVERAGE = "line", "toggle", "branch", "fsm", "functional"
SIMULATORS = {"pymtl": "PyMTL3", "verilator": "Verilator", "icarus": "Icarus"}
MUTANTS = "made", "equivalent", "killed", "survived"
PROVEN = "proven"


def empty():
    return {
        "tests": {"passed": 0, "failed": 0},
        "proofs": [],
        "coverage": dict.fromkeys(COVERAGE),
        "mutants": dict.fromkeys(MUTANTS),
        "simulators": [],
        "open_points": [],
    }


def summarize(by_steps):
    """dict by block: tests, proofs, coverage, mutants, simulators, open_points, and whatever else a step brings.

    by_steps: list of dicts by block. Numbers of ``tests`` add up, lists follow each other, the rest is merged.
    """
    summary = {block: empty() for block in BLOCKS}
    for by_block in by_steps:
        for block, entry in by_block.items():
            _merge(summary.setdefault(block, empty()), _named(entry))
    return summary


def _named(entry):
    """An entry whose simulators are a list of names; where they came with counts, these are its ``benches``."""
    simulators = entry.get("simulators", [])
    names = [SIMULATORS.get(name, name) for name in simulators]
    benches = {"benches": dict(zip(names, simulators.values()))} if isinstance(simulators, dict) else {}
    return entry | {"simulators": names} | benches


def _merge(into, entry, adding=False):
    for key, value in entry.items():
        old = into.get(key)
        if isinstance(value, dict) and isinstance(old, dict):
            _merge(old, value, adding or key == "tests")
        elif isinstance(value, list) and isinstance(old, list):
            into[key] = old + [v for v in value if key != "simulators" or v not in old]
        elif adding and isinstance(old, (int, float)) and isinstance(value, (int, float)):
            into[key] = old + value
        else:
            into[key] = value


def figures(entry):
    """The figures of a block that limits are set for: dict name -> number, None where nothing was measured."""
    proofs, tests, mutants = entry["proofs"], entry["tests"], entry["mutants"]
    found = {
        "tests.passed": tests["passed"],
        "tests.failed": tests["failed"],
        "proofs.proven": sum(p["result"] == PROVEN and bool(p["twin_fails"]) for p in proofs),
        "proofs.unproven": sum(p["result"] != PROVEN for p in proofs),
        "proofs.twins_not_caught": sum(not p["twin_fails"] for p in proofs),
        **{f"coverage.{kind}": entry["coverage"].get(kind) for kind in COVERAGE},
        **{f"mutants.{kind}": mutants.get(kind) for kind in MUTANTS},
        "mutants.score": score(mutants),
        "open_points": len(entry["open_points"]),
    }
    for name in ("fuzz", "resync"):
        if name in entry:
            found |= {f"{name}.{key}": value for key, value in entry[name].items() if isinstance(value, int)}
    return found


def score(mutants):
    """Share of the distinguishable mutants that were killed, in %: float, None where none was made."""
    made, equivalent, killed = (mutants.get(kind) for kind in ("made", "equivalent", "killed"))
    if made is None:
        return None
    return 100.0 * killed / (made - equivalent) if made > equivalent else 100.0


def totals(summary):
    """Sums over all blocks of what can be added: dict name -> number."""
    found = {}
    for entry in summary.values():
        for name, value in figures(entry).items():
            if isinstance(value, int) and not name.startswith("coverage"):
                found[name] = found.get(name, 0) + value
    return found


def is_rtl(block):
    return block in TOPS

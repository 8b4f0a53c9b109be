"""What a design's runs came to, one line a run that changed a figure: history.jsonl beside its summary."""

import json
from datetime import UTC, datetime

# Names in summary.json; of a dict by corner the least counts, of power, its first
FIGURES = {
    "area_um2": "area, um2",
    "utilization": "utilization",
    "cells": "cells",
    "wire_um": "wires, um",
    "f_max_mhz": "MHz at most",
    "wns_ns": "setup slack, ns",
    "whs_ns": "hold slack, ns",
    "power_uw": "power, uW",
    "open_nets": "open nets",
    "drc_violations": "rules broken",
    "antenna_violations": "antennas",
    "lvs_match": "layout and netlist",
    "equivalence": "netlist = Verilog",
}


def figures(summary):
    """dict of FIGURES from the summary, a number a name."""

    def one(name, value):
        if not isinstance(value, dict):
            return value
        return next(iter(value.values()), None) if name == "power_uw" else min(value.values(), default=None)

    return {name: one(name, summary.get(name)) for name in FIGURES}


def continued(path, summary):
    """List of dicts, the runs that the file ``path`` tells of and this one, the newest last; ``when`` is UTC.

    A run with the figures of the one before is no new line. Seconds are those of all steps, also of those kept.
    """
    runs = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
    found = figures(summary)
    if not runs or {name: runs[-1].get(name) for name in FIGURES} != found:
        when = datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S")
        runs.append({"when": when, **found, "seconds": round(sum(summary["wall_s"].values()))})
    return runs


def written(runs):
    """The text of the file."""
    return "".join(f"{json.dumps(run)}\n" for run in runs)


def table(runs, most=12):
    """(names of the columns, rows of (text, whether it differs from the run before)), the newest run first."""
    rows = []
    for before, run in zip([None, *runs], runs, strict=False):
        row = [(run["when"], False)]
        row += [(_text(run.get(name)), before is not None and before.get(name) != run.get(name)) for name in FIGURES]
        rows.append([*row, (f"{run['seconds']:,}", False)])
    return ["UTC", *FIGURES.values(), "seconds"], rows[::-1][:most]


def _text(value):
    if isinstance(value, bool):
        return "match" if value else "differ"
    return "-" if value is None else f"{value:,}" if isinstance(value, (int, float)) else str(value)

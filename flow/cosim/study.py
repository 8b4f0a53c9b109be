"""Error of the lock-step against its run time, on one sample; and the faults that are planted and found."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from .accuracy import Accuracy
from .diagnose import diagnose
from .faults import Fault
from .replay import TIGHT, replay
from .row import Row, RowRequest, decision_times, read_row

ONE = RowRequest(mode="image", cols=6, lanes=1, types=1)
SETTINGS = {
    "default": Accuracy(),
    "reltol 1e-2": Accuracy(reltol=1e-2, chgtol=1e-14),
    "reltol 1e-4, chgtol 1e-16": Accuracy(reltol=1e-4, chgtol=1e-16),
    "reltol 1e-5, chgtol 1e-17": Accuracy(reltol=1e-5, chgtol=1e-17),
    "gear": Accuracy(method="gear"),
    "step 1 ns": Accuracy(step=1e-9),
}
PLANTED = (Fault("comparator", (0,)), Fault("capacitor", (1, 6)))
FAULTY = RowRequest(mode="image", cols=12, lanes=2, types=2)


def accuracy(note: Callable[[str], None], asked: RowRequest = ONE) -> list[dict[str, Any]]:
    """A line for each of SETTINGS: run time, and the decisions' times beside the reference's. Raises ToolError.

    The reference is the default's drive off-line with TIGHT; decisions of another drive are compared as long as their
    questions are the same.
    """
    done = {}
    for name, one in SETTINGS.items():
        done[name] = read_row(replace(asked, accuracy=one))
        note(f"{name}: {done[name].run.stats['seconds']:.1f} s")
    first = done["default"]
    sensor, _ = asked.frame
    off = replay(asked.deck(TIGHT), first.run, asked.lanes, sensor.tile.cols, asked.timing)
    note(f"reference: {off.stats['seconds']:.1f} s, {off.stats['accepted']} points")
    exact = decision_times(off, first.deck, asked.timing)
    lines = [_line(name, row, first, exact) for name, row in done.items()]
    return [
        *lines,
        {"name": "reference, off-line", "seconds": off.stats["seconds"], "time_points": off.stats["accepted"]},
    ]


def _line(name: str, row: Row, first: Row, exact: npt.NDArray[np.float64]) -> dict[str, Any]:
    ours, theirs = row.run.cycles, first.run.cycles
    n = min(len(ours.hold), len(theirs.hold))
    same = (ours.asked[:n] == theirs.asked[:n]).all(1) & (ours.hold[:n] == theirs.hold[:n])
    until = int(np.argmin(same)) if not same.all() else n
    off = np.abs(row.decision[:until] - exact[:until])[ours.deciding[:until]]
    off = off[np.isfinite(off)]
    return {
        "name": name,
        "seconds": row.run.stats["seconds"],
        "time_points": row.run.stats["accepted"],
        "cycles_per_s": row.run.stats["circuit_cycles"] / row.run.stats["seconds"],
        "attempts": row.run.attempts,
        "code": row.samples[0].code,
        "decisions": int(off.size),
        "largest_error_s": float(off.max()) if off.size else None,
        "rms_error_s": float(np.sqrt((off**2).mean())) if off.size else None,
    }


def faults(note: Callable[[str], None], asked: RowRequest = FAULTY) -> list[dict[str, Any]]:
    """Each of PLANTED in the circuit of ``asked``, and what its codes say. Raises ToolError."""
    lines = []
    for fault in (None, *PLANTED):
        found = diagnose(read_row(replace(asked, fault=fault)))
        lines.append({"planted": fault.name if fault else "no fault", **found._asdict()})
        note(f"{lines[-1]['planted']}: found: {found.name}")
    return lines

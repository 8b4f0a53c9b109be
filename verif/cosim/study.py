"""Error of the lock-step against its run time, on one sample; and the faults that are planted and found."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.verif.cosim.accuracy import Accuracy
from talbot.verif.cosim.diagnose import diagnose
from talbot.verif.cosim.faults import Fault
from talbot.verif.cosim.replay import TIGHT, replay
from talbot.verif.cosim.row import Row, RowRequest, decision_times, read_row

ONE = RowRequest(mode="image", cols=6, lanes=1, types=1, pixels=False)
SETTINGS = {
    "default": Accuracy(),
    "reltol 1e-2, chgtol 1e-14": Accuracy(reltol=1e-2, chgtol=1e-14),
    "reltol 1e-3, chgtol 1e-15": Accuracy(reltol=1e-3, chgtol=1e-15),
    "reltol 1e-5, chgtol 1e-17": Accuracy(reltol=1e-5, chgtol=1e-17),
    "gear": Accuracy(method="gear"),
    "step 1 ns": Accuracy(step=1e-9),
    "bodies' resistances, too": Accuracy(bodies=True),
}
PLANTED = (Fault("comparator", (0,)), Fault("capacitor", (1, 6)), Fault("diodes", (6,)), Fault("row", (1,)))
COARSE = Accuracy(reltol=1e-3, chgtol=1e-15)  # codes that a fault moves by far more
FAULTY = RowRequest(mode="edge", cols=12, lanes=2, types=2, amplifier=True, columns=True, accuracy=COARSE)


def accuracy(note: Callable[[str], None], asked: RowRequest = ONE) -> list[dict[str, Any]]:
    """Return a line for each of SETTINGS: run time, and the decisions' times next to the reference's. Raises ToolError.

    The reference is the default's drive off-line with TIGHT; decisions of another drive are compared as long as their
    questions are the same.
    """
    done = {}
    for name, one in SETTINGS.items():
        done[name] = read_row(replace(asked, accuracy=one))
        note(f"{name}: {done[name].run.stats['seconds']:.1f} s")
    first = done["default"]
    sensor, _ = asked.frame
    (deck,) = asked.decks(TIGHT)
    off = replay(deck, first.run, asked.lanes, sensor.tile.cols, asked.timing)
    note(f"reference: {off.stats['seconds']:.1f} s, {off.stats['accepted']} points")
    exact = decision_times(off, first.decks, asked.timing)
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
    """Return the diagnosis of each of PLANTED in the circuit of ``asked``. Raises ToolError."""
    lines = []
    for fault in (None, *PLANTED):
        found = diagnose(read_row(replace(asked, fault=fault)))
        lines.append({"planted": fault.name if fault else "no fault", **found._asdict()})
        note(f"{lines[-1]['planted']}: found: {found.name}")
    return lines


def leaving_out(note: Callable[[str], None]) -> list[dict[str, Any]]:
    """Return the parts that are left out, simulated for comparison.

    Cycles of an integration, a lane that is not read, what lanes share, resistances of the transistors' bodies.
    """
    light = RowRequest(mode="image", cols=6, lanes=1, types=1, t_int=100)
    narrow = RowRequest(mode="image", cols=6, lanes=2, types=1, pixels=False)
    shared = RowRequest(mode="edge", types=2, amplifier=True)
    columns = RowRequest(mode="edge", cols=6, lanes=1, types=1, amplifier=True, columns=True)
    pairs = {
        "an integration of 100 cycles": (light, replace(light, whole=True)),
        "a lane that the row does not read": (narrow, replace(narrow, everything=True)),
        "what two lanes share": (shared, replace(shared, partition=False)),
        "resistances of the transistors' bodies": (columns, replace(columns, accuracy=Accuracy(bodies=True))),
    }
    lines = []
    for name, (lean, full) in pairs.items():
        a, b = read_row(lean), read_row(full)
        lines.append(
            {
                "name": name,
                "seconds": a.run.stats["processor_seconds"],
                "seconds_with": b.run.stats["processor_seconds"],
                "cycles": a.run.stats["circuit_cycles"],
                "cycles_with": b.run.stats["circuit_cycles"],
                "transistors": a.transistors,
                "transistors_with": b.transistors,
                "error_lsb": float(np.abs(a.at_lane - b.at_lane).max()),
                "codes": [[s.code for s in row.samples] for row in (a, b)],
            }
        )
        note(f"{name}: {lines[-1]['seconds']:.1f} s instead of {lines[-1]['seconds_with']:.1f}")
    return lines

"""The rows of a `talbot cosim`, their figures and files."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from talbot.imaging.frame.hardware import program as bench
from talbot.imaging.frame.hardware import simulate
from talbot.verif.cosim import extracted, lockstep
from talbot.verif.cosim.row import Row, RowRequest, read_row

STEPS = ("build", "rows", "faults", "report")


def rows(asked: Sequence[RowRequest], note: Callable[[str], None]) -> list[Row]:
    """Each row read with the circuit in the loop. Raises ParameterError, ToolError."""
    note("build")
    programs = {}
    for one in asked:
        sensor, _ = one.frame
        key = one.cols, one.lanes
        programs[key] = programs.get(key) or lockstep.program(sensor, note)
    if any(one.extracted for one in asked):
        note("drawing and extracting the circuits")
        extracted.circuits()
    note("rows")
    done = []
    for one in asked:
        row = read_row(one, note, programs[one.cols, one.lanes])
        seconds, cycles = row.run.stats["seconds"], row.run.stats["circuit_cycles"]
        note(f"{one.name}: {len(row.samples)} samples, {cycles} cycles of the circuit in {seconds:.1f} s")
        done.append(row)
    return done


def summary(row: Row) -> dict[str, Any]:
    """Figures of one row."""
    run, off = row.run, row.differences
    times = row.decision[np.isfinite(row.decision)]
    decisions = run.cycles.deciding & np.isin(np.arange(run.cycles.answer.shape[1]), row.lanes)
    return {
        "mode": row.request.mode,
        "name": row.request.name,
        "samples": len(row.samples),
        "differing": int((off != 0).sum()),
        "largest_difference_lsb": int(np.abs(off).max(initial=0)),
        "beyond": int(row.beyond.sum()),
        "largest_error_at_lane_lsb": float(np.abs(row.at_lane).max(initial=0)),
        "largest_error_of_level_lsb": float(np.abs(row.level_off).max(initial=0)),
        "amplifier": row.request.amplifier,
        "extracted": row.request.extracted,
        "decisions": int(decisions.sum()),
        "differing_decisions": int((run.cycles.answer != run.cycles.expected)[decisions].sum()),
        "undecided": int(np.isnan(row.decision[run.cycles.deciding]).sum()),
        "slowest_decision_s": float(times.max(initial=0.0)),
        "median_decision_s": float(np.median(times)) if times.size else None,
        "transistors": row.transistors,
        "lanes": row.lanes,
        "columns": sum(len(deck.columns) for deck in row.decks),
        "chip_cycles": run.stats["cycles"],
        "circuit_cycles": run.stats["circuit_cycles"],
        "time_points": run.stats["accepted"],
        "rejected_points": run.stats["rejected"],
        "attempts": run.attempts,
        "trim_retries": row.decks[0].repeated,
        "seconds": run.stats["seconds"],
        "processor_seconds": run.stats["processor_seconds"],
        "circuit_cycles_per_s": run.stats["circuit_cycles"] / run.stats["seconds"],
        "codes": [
            {
                "column": s.column,
                "sub": s.sub,
                "lane": s.lane,
                "value": s.value,
                "code": s.code,
                "model": s.expected,
                "off_at_lane_lsb": float(off),
            }
            for s, off in zip(row.samples, row.at_lane, strict=True)
        ],
    }


def model_alone(asked: RowRequest) -> dict[str, float]:
    """Speed of the same frame with the real-number front end. Raises ToolError."""
    sensor, frame = asked.frame
    done = simulate(bench(sensor), sensor, frame, asked.samples, asked.front_end)
    return {"cycles": done.cycles, "seconds": done.seconds, "cycles_per_s": done.cycles / done.seconds}

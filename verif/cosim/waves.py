"""Waves of both sides in one file: VCD with the pins of the chip as bits and the nodes of the circuit as reals."""

from collections.abc import Iterator
from pathlib import Path
from typing import TextIO

from talbot.verif.cosim.lockstep import Run

TICK = 1e-14  # s
SMALLEST = 0.5e-3  # V, of a change that is written


def write_vcd(path: Path, run: Run, period: float) -> None:
    """Write ``path`` for any viewer of waves. period: of the clock, s."""
    lanes = run.cycles.answer.shape[1]
    pins = {"hold": 1, "group": 8, "k": 3, "sub": 2}
    of_lane = {"deciding": 1, "dac": 8, "comparator": 1, "model_comparator": 1}
    names = [("pins", name, bits) for name, bits in pins.items()]
    names += [(f"lane{i}", name, bits) for i in range(lanes) for name, bits in of_lane.items()]
    names += [(f"lane{i}", "model_held", 0) for i in range(lanes)]
    names += [("circuit", node.replace(".", "_"), 0) for node in run.waves]
    ids = {(scope, name): f"s{i}" for i, (scope, name, _) in enumerate(names)}
    with path.open("w", encoding="utf-8") as file:
        _head(file, names, ids)
        for time, changes in _merged(run, period, lanes, ids):
            file.write(f"#{round(time / TICK)}\n" + "".join(changes))


def _head(file: TextIO, names: list[tuple[str, str, int]], ids: dict[tuple[str, str], str]) -> None:
    file.write("$timescale 10 fs $end\n")
    scope = ""
    for where, name, bits in names:
        if where != scope:
            file.write(("$upscope $end\n" if scope else "") + f"$scope module {where} $end\n")
            scope = where
        kind = f"wire {bits}" if bits else "real 64"
        file.write(f"$var {kind} {ids[where, name]} {name} $end\n")
    file.write("$upscope $end\n$enddefinitions $end\n")


def _merged(run: Run, period: float, lanes: int, ids: dict[tuple[str, str], str]) -> Iterator[tuple[float, list[str]]]:
    """Changes in the order of time: the chip's at the edges of its clock, the circuit's at its time points."""
    c, last, edge = run.cycles, dict.fromkeys(run.waves, float("inf")), 0
    for j, time in enumerate(run.time):
        while edge < len(c.hold) and edge * period <= time:
            yield edge * period, list(_pins(run, edge, lanes, ids))
            edge += 1
        changes = []
        for node, volts in run.waves.items():
            if abs(volts[j] - last[node]) >= SMALLEST:
                last[node] = volts[j]
                changes.append(f"r{volts[j]:.6g} {ids['circuit', node.replace('.', '_')]}\n")
        if changes:
            yield float(time), changes


def _pins(run: Run, i: int, lanes: int, ids: dict[tuple[str, str], str]) -> Iterator[str]:
    c = run.cycles
    for name, value in (("hold", c.hold[i]), ("group", c.group[i]), ("k", c.k[i]), ("sub", c.sub[i])):
        yield f"b{int(value):b} {ids['pins', name]}\n"
    for lane in range(lanes):
        for name, values in (("deciding", c.deciding), ("dac", c.asked)):
            yield f"b{int(values[i, lane]):b} {ids[f'lane{lane}', name]}\n"
        if i and c.deciding[i - 1, lane]:  # answers are read at the end of their cycle
            yield f"b{int(c.answer[i - 1, lane]):b} {ids[f'lane{lane}', 'comparator']}\n"
            yield f"b{int(c.expected[i - 1, lane]):b} {ids[f'lane{lane}', 'model_comparator']}\n"
        yield f"r{c.held[i, lane]:.9g} {ids[f'lane{lane}', 'model_held']}\n"

"""The files of a co-simulation: page, waves, codes."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from talbot.base.charts import COLOURS, svg
from talbot.base.page import TABLES, Section, Tile, render
from talbot.verif.cosim.row import Row, Sample
from talbot.verif.cosim.waves import write_vcd

SHOWN = 12  # cycles in the picture of waves
PAGE = "cosim.html"
EXTRACTED = "-extracted"


def names(modes: Sequence[str]) -> tuple[str, ...]:
    """Files of an earlier run that a new one replaces."""
    return (PAGE, "summary.json", *(f"{mode}{part}.vcd" for mode in modes for part in ("", EXTRACTED)))


def write(folder: Path, rows: Sequence[Row], s: Mapping[str, Any]) -> None:
    """Write everything but summary.json into ``folder``, which exists."""
    for row in rows:
        write_vcd(
            folder / f"{row.request.mode}{EXTRACTED * row.request.extracted}.vcd", row.run, row.request.timing.period
        )
    sections = [
        Section("Rows", ABOUT, head=HEAD, rows=[_line(one) for one in s["rows"]]),
        *(_codes(row) for row in rows),
        *_planted(s),
        Section("Waves of the first conversion", WAVES, charts=[_waves(rows[0])]),
    ]
    text = render(
        TABLES, "The chip's Verilog and a circuit in lock-step", about=_about(s), tiles=_tiles(s), sections=sections
    )
    (folder / PAGE).write_text(text, encoding="utf-8")


HEAD = ("", "samples", "codes that differ", "largest, LSB", "at the lane, LSB", "decisions", "that differ")
HEAD += ("slowest, ns", "transistors", "cycles of the circuit", "of the chip", "time points", "attempts")
HEAD += ("retries of the trim", "s")
ABOUT = (
    "Each row leaves the chip as its stream; the codes are decoded from it. The real-number front end is asked the "
    "same questions as the circuit in the same cycle: decisions that differ are counted one by one."
)
WAVES = "Both sides are in <mode>.vcd; here, voltages between the comparator's inputs and at its outputs."


def _line(s: Mapping[str, Any]) -> tuple[str, ...]:
    codes = (f"{s['samples']:,}", f"{s['differing']:,}", f"{s['largest_difference_lsb']:,}")
    numbers = (s["decisions"], s["differing_decisions"])
    more = (s["transistors"], s["circuit_cycles"], s["chip_cycles"], s["time_points"], s["attempts"], s["trim_retries"])
    ns = f"{1e9 * s['slowest_decision_s']:.2f}"
    name = s["name"] + ", with amplifiers" * s["amplifier"]
    at_lane = f"{s['largest_error_at_lane_lsb']:.3f}"
    return (name, *codes, at_lane, *(f"{n:,}" for n in numbers), ns, *(f"{n:,}" for n in more), f"{s['seconds']:.1f}")


def _codes(row: Row) -> Section:
    head = ("column", "sub-sample", "lane", "value, LSB", "off at the lane, LSB", "circuit", "model")
    lines = [
        (f"{x.column}", f"{x.sub}", f"{x.lane}", f"{x.value:.3f}", f"{off:+.3f}", f"{x.code}", f"{x.expected}", _why(x))
        for x, off in zip(row.samples, row.at_lane, strict=True)
    ]
    return Section(f"Codes: {row.request.name}", head=(*head, "first decision that differs"), rows=lines)


def _planted(s: Mapping[str, Any]) -> list[Section]:
    """Return the section on planted faults, where they were simulated."""
    if not s["faults"]:
        return []
    head = ("planted", "found", "codes from it, LSB", "from the next", "from a sound circuit")
    errors = ("error", "next_error", "sound_error")
    lines = [(f["planted"], f["name"], *(str(f[key]) for key in errors)) for f in s["faults"]]
    return [Section("Planted faults", FAULTS, head=head, rows=lines)]


FAULTS = "Found: of all faults of the dictionary, the one whose codes, computed from charge alone, are the nearest."


def _why(x: Sample) -> str:
    return f"at DAC code {x.why[0]}, {x.why[1]:+.3f} LSB from its level" if x.why else ""


def _tiles(s: Mapping[str, Any]) -> list[Tile]:
    rows = s["rows"]
    beyond, count = sum(r["beyond"] for r in rows), sum(r["samples"] for r in rows)
    differing = sum(r["differing"] for r in rows)
    return [
        Tile(
            f"{beyond} of {count}",
            "codes farther from the real-number model's value than half an LSB and the stated noise",
            "bad" if beyond else "good",
        ),
        Tile(f"{differing} of {count}", "codes differ from the real-number model's"),
        Tile(f"{1e9 * max(r['slowest_decision_s'] for r in rows):.2f} ns", "slowest decision"),
        Tile(f"{min(r['circuit_cycles_per_s'] for r in rows):.2f}", "cycles of the circuit a second"),
    ]


def _about(s: Mapping[str, Any]) -> str:
    one = s["rows"][0]
    counts = (one["columns"], "column"), (len(one["lanes"]), "lane")
    columns, lanes = (f"{count} {name}{'s' * (count != 1)}" for count, name in counts)
    return f"{columns}, {lanes} in {one['transistors']} transistors of SKY130"


def _waves(row: Row) -> Markup:
    lane, period = row.lanes[0], row.request.timing.period
    run = row.run
    begin = int(np.flatnonzero(run.cycles.hold)[0])
    at = (run.time >= begin * period) & (run.time <= (begin + SHOWN) * period)
    micro = 1e6 * run.time[at]
    figure = Figure(figsize=(9.0, 4.2), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    nodes = row.decks[0].inside(lane)
    for axes, pair in ((above, nodes[:2]), (below, nodes[2:])):
        for colour, node in zip(COLOURS, pair, strict=False):
            label = node.partition(".")[2]
            axes.plot(micro, run.waves[node][at], color=colour, linewidth=0.9, label=label)
        axes.legend(fontsize=8, frameon=False, loc="lower right", bbox_to_anchor=(1, 1), ncols=2)
        axes.set_ylabel("V", fontsize=9)
        axes.tick_params(labelsize=8)
    below.set_xlabel("µs of the circuit", fontsize=9)
    return svg(figure)

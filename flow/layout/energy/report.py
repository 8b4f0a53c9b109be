"""The table of events' energies, as a page and as text."""

from typing import Any

from talbot.base.page import TABLES, Section, Tile, render

ABOUT = (
    "Transitions of every net of the laid-out chip through whole frames in Icarus, at zero delay; power of the "
    "cells by their Liberty and the layout's extracted wires. Without the loads of the chip's outputs."
)
FITTED = (
    "Least squares, not negative, of relative residuals. Left out: the frame as predicted by the fit of all others. "
    "The last two frames are in no fit: another scene, window and mask; and the frame that make layout simulates with "
    "delays."
)
NAMES = {"cycles": "cycle while busy", "rows": "row read", "samples": "sample converted", "decisions": "decision of a "
         "comparator", "bytes": "byte of the stream", "divisions": "division for a phase"}  # fmt: skip


def rows(summary: dict[str, Any]) -> list[dict[str, Any]]:
    """All frames, those of no fit last."""
    return [*summary["frames"], summary["held_back"], summary["recorded"]]


def page(summary: dict[str, Any]) -> str:
    """The page."""
    off, glitches = summary["held_back"]["residual"], summary["glitches"]
    head = ("frame", "varies", *summary["pj"], "pJ", "pJ a cycle", "fit", "left out")
    body = [
        (frame["name"], frame["varies"], *(f"{count:,}" for count in frame["events"].values()))
        + (f"{frame['pj']:,.0f}", f"{frame['pj_cycle']:.2f}", _percent(frame["residual"]), _percent(frame["left_out"]))
        for frame in rows(summary)
    ]
    blocks = list(summary["recorded"]["by_block"])
    split = [(f["name"], *(f"{f['by_block'][name]:,.0f}" for name in blocks)) for f in rows(summary)]
    known = [(name, value) for name, value in summary["inputs"].items()]
    known += [(name, str(summary[name])) for name in ("design", "pdk", "corner", "supply_v")]
    known += list(summary["tools"].items())
    return render(
        TABLES,
        "Switching energy of the digital part",
        about=ABOUT,
        tiles=[
            Tile(f"{summary['pj']['cycles']:.1f} pJ", "a cycle in which nothing is converted or sent"),
            Tile(_percent(off), "the held-back frame, fit against measured", "good"),
            Tile(f"{glitches['ratio']:.3f}", "energy with delays over that without: glitches"),
            Tile(f"{summary['leakage_uw']:.2f} uW", "leakage"),
        ],
        sections=[
            Section("Events", head=("event", "pJ"), rows=_events(summary)),
            Section("Frames", FITTED, head=head, rows=body),
            Section("By block, pJ", "While the chip is busy.", head=("frame", *blocks), rows=split),
            Section("Computed from", "Digests of the files.", head=("", ""), rows=known, numbers=False),
        ],
    )


def text(summary: dict[str, Any]) -> str:
    """The lines that the command prints."""
    lines = [f"switching energy at {summary['corner']}, {summary['supply_v']:g} V:"]
    lines += [f"  {name:<28}{pj:>10} pJ" for name, pj in _events(summary)]
    lines.append(
        f"  leakage {summary['leakage_uw']:.2f} uW; {summary['host_pj_cycle']:.2f} pJ a cycle while a host writes"
    )
    lines += [
        f"  {f['name']:<12}{f['pj']:>12,.0f} pJ{f['pj_cycle']:>8.2f} a cycle, fit {_percent(f['residual'])}"
        + (f", left out {_percent(f['left_out'])}" if f["left_out"] is not None else ", in no fit")
        for f in rows(summary)
    ]
    g = summary["glitches"]
    lines.append(
        f"  with delays {g['pj_cycle']:.2f} pJ a cycle, without {g['settled_pj_cycle']:.2f}: {g['ratio']:.3f} times"
    )
    return "\n".join(lines)


def _events(summary: dict[str, Any]) -> list[tuple[str, str]]:
    return [(NAMES[name], f"{pj:,.3f}") for name, pj in summary["pj"].items()]


def _percent(share: float | None) -> str:
    return "" if share is None else f"{100 * share:+.1f} %"

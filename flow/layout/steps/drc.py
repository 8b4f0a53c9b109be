"""Design rules: the deck that PDKMaster exports for the process, in KLayout."""

import json
import re
from dataclasses import dataclass

from base.steps import Step, StepError
from platforms.coriolis import coriolis_platform

from . import klayout_decks
from .klayout_decks import run_deck, violations

WARNING = "[Warning]"


@dataclass(frozen=True)
class DrcParameters:
    """pdk: process."""

    pdk: str = "sky130"


class Drc(Step):
    """Every rule of the deck over the whole layout; the report opens in KLayout.

    What the deck calls a warning (wide wires nearer than long ones may be) is in the report and no violation: the rule
    itself, with the length, stands beside it.
    """

    name = "drc"
    inputs = {"gds": "fill.gds", "deck": "library.drc"}
    outputs = {"report": "drc.lyrdb", "summary": "drc.json", "deck": "spaces.drc"}
    Parameters = DrcParameters
    metrics = {"drc_violations": ""}
    uses = (klayout_decks,)
    tools = ("klayout",)

    def run(self, inputs, outputs):
        log = outputs["report"].with_suffix(".log")
        deck = with_flat_spaces(inputs["deck"].read_text())
        outputs["deck"].write_text("\n".join([deck, *holes(coriolis_platform(self.parameters.pdk))]) + "\n")
        status = run_deck(
            outputs["deck"],
            {"SOURCE_FILE": inputs["gds"].resolve(), "CELL_NAME": "", "REPORT_FILE": outputs["report"].resolve()},
            log,
        )
        if status:
            told = log.read_text().strip().splitlines()
            raise StepError(
                f"drc: KLayout failed with status {status}: "
                f"{next((line for line in told if 'ERROR' in line), told[-1:])}"
            )
        found = violations(outputs["report"])
        outputs["summary"].write_text(json.dumps(found, indent=1) + "\n")
        return {"drc_violations": sum(count for rule, count in found.items() if not rule.startswith(WARNING))}


def with_flat_spaces(deck):
    """The deck with the spaces of drawn layers checked behind all else and without cells.

    Wells, implants and rails go on from cell to cell through whole rows; to check those cell by cell takes two thirds
    of the deck's time, without cells a tenth of that. Raises StepError when the deck has no such rules.
    """
    drawn = dict(re.findall(r"^(\w+) = (input\(\d+, \d+\))$", deck, re.M))
    rules = [m for m in re.finditer(r"^(\w+)\.space\([\d.]+\)\.output\(\n(?:.*\n)*?\)\n", deck, re.M) if m[1] in drawn]
    if not rules:
        raise StepError("drc: the deck has no rule of a space that could be checked without cells")
    for rule in rules:
        deck = deck.replace(rule[0], "", 1)
    layers = dict.fromkeys(rule[1] for rule in rules)
    return "\n".join([deck, "flat", *(f"{name} = {drawn[name]}" for name in layers), *(rule[0] for rule in rules)])


def holes(known):
    """Lines for a deck: the least areas of holes that ``known`` (CoriolisPlatform) has beyond PDKMaster's rules."""
    for wire in known.metals:
        if wire.min_hole_um2:
            yield f"{wire.name} = input({wire.layer}, {wire.datatype})"
            yield (
                f'{wire.name}.holes.with_area(nil, {wire.min_hole_um2}).output("{wire.name} hole", '
                f'"{wire.name} minimum area of a hole")'
            )

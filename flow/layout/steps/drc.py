"""Design rules: the deck that PDKMaster exports for the process, in KLayout."""

import json
from typing import Any

from talbot.base.steps import Files, Step, StepError
from talbot.platforms.coriolis import coriolis_platform

from ..geometry.decks import hole_rules, run_exported, via_rules, violations, with_flat_spaces
from .parameters import PdkParameters

WARNING = "[Warning]"


class Drc(Step[PdkParameters]):
    """Every rule of the deck over the whole layout; the report opens in KLayout.

    What the deck calls a warning (wide metal nearer than long parallel runs may be) is in the report and no violation:
    the rule itself, with the length, is checked too.
    """

    name = "drc"
    inputs = {"gds": "fill.gds", "deck": "library.drc"}
    outputs = {"report": "drc.lyrdb", "summary": "drc.json", "deck": "spaces.drc"}
    metrics = {"drc_violations": ""}
    tools = ("klayout",)

    def exported(self, deck: str) -> str:
        """What is checked of the exported deck."""
        return deck

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        deck = with_flat_spaces(self.exported(inputs["deck"].read_text()))
        tech = coriolis_platform(self.parameters.pdk)
        masks = [tech.masks.read_text()] if tech.masks else []
        outputs["deck"].write_text("\n".join([deck, *hole_rules(tech), *via_rules(tech), *masks]) + "\n")
        status, output = run_exported(outputs["deck"], inputs["gds"], outputs["report"])
        if status:
            lines = output.strip().splitlines()
            error = next((line for line in lines if "ERROR" in line), lines[-1:])
            raise StepError(f"drc: KLayout failed with status {status}: {error}")
        found = violations(outputs["report"])
        outputs["summary"].write_text(json.dumps(found, indent=1) + "\n")
        return {"drc_violations": sum(count for rule, count in found.items() if not rule.startswith(WARNING))}

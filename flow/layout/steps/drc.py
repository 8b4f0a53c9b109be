"""Design rules: the deck that PDKMaster exports for the process, in KLayout."""

from typing import Any

from talbot.base.steps import Files, Step
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.layout import layout_platform
from talbot.signoff.geometry.decks import check_rules, hole_rules, via_rules

WARNING = "[Warning]"


class Drc(Step[PdkParameters]):
    """Every rule of the deck over the whole layout; the report opens in KLayout.

    What the deck calls a warning (wide metal nearer than long parallel runs may be) is in the report and no violation:
    the rule itself, with the length, is checked too.
    """

    name = "drc"
    inputs = {"gds": "fill.gds", "deck": "library.drc"}
    outputs = {"report": "drc.lyrdb", "summary": "drc.json", "deep": "deep.drc", "flat": "flat.drc"}
    metrics = {"drc_violations": ""}
    tools = ("klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        tech = layout_platform(self.parameters.pdk)
        masks = [tech.masks.read_text(encoding="utf-8")] if tech.masks else []
        deck, flat = inputs["deck"].read_text(encoding="utf-8"), (*hole_rules(tech), *masks)
        found = check_rules(deck, via_rules(tech), flat, inputs["gds"], outputs)
        return {"drc_violations": sum(count for rule, count in found.items() if not rule.startswith(WARNING))}

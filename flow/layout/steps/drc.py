"""Design rules: the deck that PDKMaster exports for the process, in KLayout."""

import json

from flow.steps import Step, StepError

from . import klayout_decks
from .klayout_decks import run_deck, violations


WARNING = "[Warning]"


class Drc(Step):
    """Every rule of the deck over the whole layout; the report opens in KLayout.

    What the deck calls a warning (wide wires nearer than long ones may be) is in the report and no violation: the rule
    itself, with the length, stands beside it.
    """

    name = "drc"
    inputs = {"gds": "fill.gds", "deck": "library.drc"}
    outputs = {"report": "drc.lyrdb", "summary": "drc.json"}
    metrics = {"drc_violations": ""}
    uses = (klayout_decks,)
    tools = ("klayout",)

    def run(self, inputs, outputs):
        log = outputs["report"].with_suffix(".log")
        status = run_deck(inputs["deck"], {"SOURCE_FILE": inputs["gds"].resolve(), "CELL_NAME": "",
                                           "REPORT_FILE": outputs["report"].resolve()}, log)
        if status:
            told = log.read_text().strip().splitlines()
            raise StepError(f"drc: KLayout failed with status {status}: "
                            f"{next((line for line in told if 'ERROR' in line), told[-1:])}")
        found = violations(outputs["report"])
        outputs["summary"].write_text(json.dumps(found, indent=1) + "\n")
        return {"drc_violations": sum(count for rule, count in found.items() if not rule.startswith(WARNING))}

"""Design rules by the decks of the foundry's PDK, where it is installed: in KLayout and in Magic."""

import json
import re
from dataclasses import dataclass
from typing import Any

from talbot.base.steps import Files, Step, StepError
from talbot.base.tools import finish
from talbot.platforms.foundry import FoundryChecks, foundry_checks
from talbot.signoff.geometry.decks import run_deck, violations

# A line for every broken rule: how often, a tabulator, Magic's message
MAGIC = """
if {{"drc(full)" ni [drc listall style]}} {{
  puts "error: the technology [tech name] has no style drc(full)"
  quit -noprompt
}}
drc off
gds read {gds}
load {top}
select top cell
drc euclidean on
drc style drc(full)
drc check
drc catchup
set out [open {report} w]
foreach {{rule places}} [drc listall why] {{ puts $out "[llength $places]\\t$rule" }}
puts $out "end"
close $out
quit -noprompt
"""


@dataclass(frozen=True)
class FoundryDrcParameters:
    """Parameters of `FoundryDrc`. pdk: process. top: cell."""

    pdk: str = "sky130"
    top: str = ""


class FoundryDrc(Step[FoundryDrcParameters]):
    """The KLayout deck over the whole layout, with all of its rules for blocks."""

    name = "foundry_drc"
    inputs = {"gds": "fill.gds", "deck": "foundry.klayout"}
    outputs = {"report": "foundry.lyrdb", "summary": "foundry_drc.json"}
    metrics = {"foundry_drc_violations": ""}
    tools = ("klayout",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        gds, report, top = inputs["gds"].resolve(), outputs["report"].resolve(), self.parameters.top
        variables = {"input": gds, "topcell": top, "report": report, **dict(_checks(self.parameters.pdk).defines)}
        status, output = run_deck(inputs["deck"].resolve(), outputs["report"], variables)
        if status:
            raise StepError(f"foundry_drc: {inputs['deck'].name} failed: {_error_line(output)}")
        found = violations(outputs["report"])
        outputs["summary"].write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        return {"foundry_drc_violations": sum(found.values())}


class MagicDrc(Step[FoundryDrcParameters]):
    """Magic's own rules, over the layout as Magic reads it."""

    name = "magic_drc"
    inputs = {"gds": "fill.gds", "magic": "foundry.magic"}
    outputs = {"report": "magic_drc.txt"}
    metrics = {"magic_drc_violations": ""}
    tools = ("magic",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        folder, deck = outputs["report"].parent.resolve(), _checks(self.parameters.pdk)
        magic, gds, report = inputs["magic"].resolve(), inputs["gds"].resolve(), outputs["report"].resolve()
        script = folder / "drc.tcl"
        script.write_text(MAGIC.format(gds=gds, top=self.parameters.top, report=report), encoding="utf-8")
        env = {"PDK_ROOT": str(magic).removesuffix(deck.magic)}
        done = finish(["magic", *["-dnull", "-noconsole", "-rcfile"], magic / deck.rc, script], env, folder)
        lines = outputs["report"].read_text(encoding="utf-8").splitlines() if outputs["report"].exists() else []
        if done.returncode or lines[-1:] != ["end"]:
            raise StepError(f"magic_drc: Magic failed: {_error_line(done.stdout + done.stderr)}")
        script.unlink()
        return {"magic_drc_violations": sum(int(line.split("\t")[0]) for line in lines[:-1])}


def _checks(pdk: str) -> FoundryChecks:
    """The foundry's checks of ``pdk``. Raises StepError for a process without."""
    found = foundry_checks(pdk)
    if found is None:
        raise StepError(f"foundry_drc: {pdk} has no foundry checks")
    return found


def _error_line(output: str) -> str:
    """The line of a tool's ``output`` with the error, else the last."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    errors = [line for line in lines if re.search(r"(?i)^error|undefined|ERROR:", line)]
    return (errors or lines[-1:] or ["it ended with no message"])[0]

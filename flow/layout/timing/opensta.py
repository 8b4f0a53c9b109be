"""OpenSTA run on a script."""

import re
from pathlib import Path

from talbot.base.steps import StepError
from talbot.base.tools import ToolError, finish

LINK = """
read_liberty {liberty}
read_verilog {verilog}
link_design {top}
"""
TIMED = f"{LINK}source {{sdc}}\nread_spef {{spef}}\n"  # of a netlist with its constraints and parasitics


def worst_slack(report: str, kind: str) -> float:
    """Slack (ns) that a script printed as "WORST kind ns". Raises StepError without one."""
    found = re.search(rf"WORST {kind} (\S+)", report)
    if not found:
        raise StepError(f"OpenSTA: no slack of {kind}")
    return float(found[1])


def opensta(path: Path, script: str) -> str:
    """Write ``script`` to the file ``path`` and run it; OpenSTA's output.

    Raises ToolError when it fails; StepError where it reports an error, or a name of the SPEF that it does not
    know, whose parasitics would be missing from every figure.
    """
    path.write_text(f"{script}\nexit\n", encoding="utf-8")
    done = finish(["sta", "-no_splash", "-no_init", "-exit", path])
    output = (done.stdout + done.stderr).strip().splitlines()
    if wrong := next((line for line in output if "Error" in line), None):
        raise StepError(f"{path.stem}: OpenSTA: {wrong}")
    if done.returncode:
        raise ToolError(f"{path.stem}: sta failed with status {done.returncode}: {' '.join(output[-3:])}")
    if lost := next((line for line in output if re.search(r"spef.*not found", line)), None):
        raise StepError(f"{path.stem}: OpenSTA does not know a name of the SPEF: {lost}")
    return done.stdout

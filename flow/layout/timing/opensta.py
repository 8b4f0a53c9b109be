"""OpenSTA run on a script."""

import re
from pathlib import Path

from base.steps import StepError
from base.tools import ToolError, finish


def opensta(path: Path, script: str) -> str:
    """Write ``script`` to the file ``path`` and run it; OpenSTA's output.

    Raises ToolError when it fails; StepError where it reports an error, or a name of the SPEF that it does not
    know, whose parasitics would be missing from every figure.
    """
    path.write_text(f"{script}\nexit\n")
    done = finish(["sta", "-no_splash", "-no_init", "-exit", path])
    output = (done.stdout + done.stderr).strip().splitlines()
    if wrong := next((line for line in output if "Error" in line), None):
        raise StepError(f"{path.stem}: OpenSTA: {wrong}")
    if done.returncode:
        raise ToolError(f"{path.stem}: sta failed with status {done.returncode}: {' '.join(output[-3:])}")
    if lost := next((line for line in output if re.search(r"spef.*not found", line)), None):
        raise StepError(f"{path.stem}: OpenSTA does not know a name of the SPEF: {lost}")
    return done.stdout

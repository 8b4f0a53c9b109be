"""OpenSTA run on a script: what it printed, once it told of nothing wrong."""

import re

from base.steps import StepError
from base.tools import ToolError, finish


def opensta(path, script):
    """Write ``script`` (text) to the file ``path`` and run it: what OpenSTA printed.

    Raises ToolError when it fails; StepError where it tells of an error, or of a name of the SPEF that it does not know:
    what that stands for would be missing from every figure.
    """
    path.write_text(f"{script}\nexit\n")
    done = finish(["sta", "-no_splash", "-no_init", "-exit", path])
    told = (done.stdout + done.stderr).strip().splitlines()
    if wrong := next((line for line in told if "Error" in line), None):
        raise StepError(f"{path.stem}: OpenSTA: {wrong}")
    if done.returncode:
        raise ToolError(f"{path.stem}: sta failed with status {done.returncode}: {' '.join(told[-3:])}")
    if lost := next((line for line in told if re.search(r"spef.*not found", line)), None):
        raise StepError(f"{path.stem}: OpenSTA does not know a name of the SPEF: {lost}")
    return done.stdout

"""Steps from files to files, run in order: none is run again whose inputs did not change."""

from talbot.base.steps.runner import Runner
from talbot.base.steps.step import Files, Step, StepError

__all__ = ["Files", "Runner", "Step", "StepError"]

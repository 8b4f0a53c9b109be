"""Steps from files to files, run in order: none is run again whose inputs did not change."""

from .runner import Runner
from .step import Files, Step, StepError

__all__ = ["Files", "Runner", "Step", "StepError"]

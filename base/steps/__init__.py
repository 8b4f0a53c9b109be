"""Steps from files to files, run in order: none is run again whose inputs did not change."""

from .runner import Runner
from .step import Step, StepError

__all__ = ["Runner", "Step", "StepError"]

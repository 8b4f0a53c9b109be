"""What a step declares: its inputs, outputs, parameters, metrics and tools."""

import inspect
import sys
from dataclasses import dataclass, fields

from base.tools import ToolError
from models.parameters import ParameterError


class StepError(ToolError):
    """A step broke its declaration, or a tool's result is not usable; the message says what and where."""


@dataclass(frozen=True)
class NoParameters:
    """Of a step that has none."""


class Step:
    """One step: a subclass declares what it takes and gives and has `run`.

    name: of its folder and record. inputs: dict name -> 'step.output' or the name of a file given to the Runner.
    outputs: dict name -> file name. Parameters: a frozen dataclass whose fields have a unit in their metadata.
    metrics: dict name -> unit, of what `run` returns. tools: programs whose versions belong to the result. uses:
    modules whose text does, beside that of the subclass. shared: whether its folder is that of all runs.
    """

    name = ""
    inputs = {}
    outputs = {}
    Parameters = NoParameters
    metrics = {}
    tools = ()
    uses = ()
    shared = False

    def __init__(self, parameters=None):
        self.parameters = parameters or self.Parameters()
        if not isinstance(self.parameters, self.Parameters):
            raise ParameterError(f"{self.name} parameters = {parameters!r}: must be a {self.Parameters.__name__}")

    def run(self, inputs, outputs):
        """Make the files ``outputs`` (dict name -> Path) from ``inputs`` (the same); returns dict metric -> value."""
        raise NotImplementedError

    @classmethod
    def source(cls):
        """The text of the modules that define the step: another text is another step."""
        return "".join(map(inspect.getsource, (sys.modules[cls.__module__], *cls.uses)))

    def units(self):
        """Units of the parameters: dict name -> str, '' without one."""
        return {field.name: field.metadata.get("unit", "") for field in fields(self.parameters)}

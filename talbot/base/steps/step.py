"""The declaration of a step: inputs, outputs, parameters, metrics and tools."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeVar, get_args

from talbot.base.tools import ToolError
from talbot.models.parameters import ParameterError


class StepError(ToolError):
    """A step broke its declaration, or a tool's result is not usable; the message says what and where."""


@dataclass(frozen=True)
class NoParameters:
    """The parameters of a step that has none."""


P = TypeVar("P", bound=Any)
Files = Mapping[str, Path]  # by the name of an input or output


class Step(Generic[P]):
    """A step: a subclass of ``Step[P]`` declares what it reads and writes and implements `run`.

    P is a frozen dataclass whose fields have a unit in their metadata (NoParameters for none). name: of the step's
    folder and record. inputs: name -> 'step.output' or the name of a file given to the Runner. outputs: name -> file
    name. metrics: name -> unit, of what `run` returns. tools: programs whose versions belong to the result. shared:
    whether all runs share its folder.
    """

    name: str = ""
    inputs: Mapping[str, str] = {}
    outputs: Mapping[str, str] = {}
    metrics: Mapping[str, str] = {}
    tools: tuple[str, ...] = ()
    shared: bool = False
    Parameters: ClassVar[type] = NoParameters

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        for base in cls.__dict__.get("__orig_bases__", ()):
            if arguments := [found for found in get_args(base) if isinstance(found, type)]:
                cls.Parameters = arguments[0]

    def __init__(self, parameters: P | None = None) -> None:
        self.parameters: P = self.Parameters() if parameters is None else parameters
        if not isinstance(self.parameters, self.Parameters):
            raise ParameterError(f"{self.name} parameters = {parameters!r}: must be a {self.Parameters.__name__}")

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        """Write the files ``outputs`` from the files ``inputs`` (name -> path); returns metric -> value."""
        raise NotImplementedError

    def starts(self) -> Iterable[str]:
        """Modules and files of the repository that a process started by `run` reads and that no text of it names.

        Modules and paths that stand in the code are found without this (`base.sources`).
        """
        return ()

    def units(self) -> dict[str, str]:
        """Unit of each parameter by name, '' without one."""
        return {field.name: field.metadata.get("unit", "") for field in fields(self.parameters)}

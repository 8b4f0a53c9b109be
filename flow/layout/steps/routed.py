"""Steps that run twice: on the routed layout, from which `thresholds` chooses its cells, and on the final one."""

from dataclasses import dataclass
from typing import TypeVar

from talbot.base.steps import Step
from talbot.flow.layout.steps.parameters import PdkParameters

PREFIX = "routed_"
TWICE = "stream_out", "fill", "extraction"
SOURCES = {"finish.def": "mend.def"}  # of the final layout: of the routed one


@dataclass(frozen=True)
class RoutedParameters(PdkParameters):
    """A process. routed: whether the step runs on the routed layout, under a name with PREFIX."""

    routed: bool = False


P = TypeVar("P", bound=RoutedParameters)


class RoutedStep(Step[P]):
    """A step of TWICE."""

    def __init__(self, parameters: P | None = None) -> None:
        super().__init__(parameters)
        if self.parameters.routed:
            self.inputs = {name: of_routed(source) for name, source in self.inputs.items()}
            self.name = f"{PREFIX}{self.name}"


def of_routed(source: str) -> str:
    """The input of the routed layout's step where that of the final one has ``source``."""
    return f"{PREFIX}{source}" if source.partition(".")[0] in TWICE else SOURCES.get(source, source)

"""Steps that run once a corner."""

from talbot.base.steps.step import P, Step
from talbot.platforms.wires import wire_corner


class CornerStep(Step[P]):
    """A step whose parameters have a corner: ``{corner}`` in its name and inputs, ``{wires}`` that of the wires."""

    def __init__(self, parameters: P) -> None:
        super().__init__(parameters)
        corner = self.parameters.corner
        self.name = self.name.format(corner=corner)
        self.inputs = {
            name: source.format(corner=corner, wires=wire_corner(corner)) for name, source in self.inputs.items()
        }

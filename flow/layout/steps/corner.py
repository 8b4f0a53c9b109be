"""Steps that run once a corner."""

from base.steps.step import P, Step


class CornerStep(Step[P]):
    """A step whose parameters have a corner, which is ``{corner}`` in the step's name and inputs."""

    def __init__(self, parameters: P) -> None:
        super().__init__(parameters)
        corner = self.parameters.corner
        self.name = self.name.format(corner=corner)
        self.inputs = {name: source.format(corner=corner) for name, source in self.inputs.items()}

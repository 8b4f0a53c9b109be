"""The optical stack of a process: heights and materials of its metals and films."""

from dataclasses import dataclass
from importlib import import_module

from talbot.models.parameters import ParameterError, check_choice
from talbot.platforms.processes import package


@dataclass(frozen=True)
class Metal:
    """A metal that gratings can be made of.

    name: its LEF name. bottom_um: height above the silicon. material: of `materials`. width_um, space_um: minimum.
    """

    name: str
    bottom_um: float
    thickness_um: float
    material: str
    width_um: float
    space_um: float

    @property
    def top_um(self) -> float:
        """Height of its upper face above the silicon."""
        return self.bottom_um + self.thickness_um


@dataclass(frozen=True)
class Film:
    """A film of one material; it ends ``top_um`` above the silicon."""

    top_um: float
    material: str


@dataclass(frozen=True)
class OpticalStack:
    """A process above its photodiodes, where no metal is drawn; light comes through air.

    metals: from the lowest. films: of the dielectrics, from the silicon below the field oxide up, which is height 0;
    metals lie inside them. surface_um: height of the silicon of active areas, where photodiodes are. finger_um: minimum
    width of a diffusion, and space between two. gate: polysilicon over active areas, where it is inside
    one film. grid_um: of what is drawn. heights: name of the table of heights.
    """

    process: str
    heights: str
    metals: tuple[Metal, ...]
    films: tuple[Film, ...]
    surface_um: float
    finger_um: tuple[float, float]
    gate: Metal | None = None
    grid_um: float = 0.005

    def metal(self, field: str, name: str) -> Metal:
        """Return the metal ``name``. Raises ParameterError, which calls it ``field``, for one that is not there."""
        for metal in (*self.metals, *([self.gate] if self.gate else [])):
            if metal.name == name:
                return metal
        raise ParameterError(
            f"{field} = {name!r}: must be one of {', '.join(m.name for m in self.metals)}, metals of {self.process}"
        )


def optical_stack(pdk: str, heights: str | None = None) -> OpticalStack:
    """Optical stack of ``pdk``. heights: one of its published tables, None: the first. Raises ParameterError."""
    stacks = _stacks(pdk)
    heights = next(iter(stacks)) if heights is None else heights
    check_choice("heights", heights, stacks)
    return stacks[heights]


def tables(pdk: str) -> list[str]:
    """Names of the published tables of heights of ``pdk``, the first is the default. Raises ParameterError."""
    return [*_stacks(pdk)]


def _stacks(pdk: str) -> dict[str, OpticalStack]:
    return import_module(f"talbot.platforms.{package(pdk)}.optics").STACKS

"""A pixel's gratings: the object that the optics solves, the fit describes and a layout draws."""

from dataclasses import dataclass

from talbot.models.parameters import ArrayParameters, ParameterError, check_choice, check_real
from talbot.platforms.materials import refractive_index
from talbot.platforms.optics import Metal, OpticalStack, optical_stack

KINDS = "amplitude", "interleaved", "photogate"
PITCHES_UM = 1.0, 100.0
QUADRATURE = 0.0, 0.25, 0.5, 0.75  # of a period: alpha = 0, pi/2, pi and 3 pi/2


@dataclass(frozen=True)
class Slab:
    """A layer of the stack.

    medium: permittivity.
    thickness_um: thickness.
    line: permittivity of lines, None without lines.
    fill: share of the period that is lines.
    lines: number of equal lines in a period.
    spans: lines of any width at any place instead, (left, right) in periods.
    """

    medium: complex
    thickness_um: float
    line: complex | None = None
    fill: float = 0.0
    lines: int = 1
    spans: tuple[tuple[float, float], ...] | None = None


@dataclass(frozen=True)
class PixelGeometry:
    """Two photodiodes under gratings of a process's metal.

    Raises ParameterError for what the process cannot make.

    Attributes
    ----------
    process, heights : str
        See `platforms.optics.optical_stack`.
    kind : str
        "amplitude": a grating over a second one of metal (the analyzer), half of the pixel for each diode, analyzers
        half a period apart. "interleaved": fingers of the two diodes, half a period wide, alternate under one grating.
        "photogate": the same with a gate of polysilicon over each finger (Angle Sensitive Photogate, [Jayasuriya2017],
        Sec. 5.4.2).
    diffraction : str
        LEF name of the upper metal.
    analyzer : str or None
        LEF name of the lower metal, or of the gates; None for an interleaved pixel.
    period_um : float
        Of both gratings.
    fill, analyzer_fill : float
        Share of metal, or of gates.
    shift : float
        Of the analyzer and of the first diode's fingers relative to the lines above, -1..1 periods.
    pitch_um : float
        Of pixels.
    """

    process: str = "sky130"
    kind: str = "amplitude"
    diffraction: str = "met4"
    analyzer: str | None = "met1"
    period_um: float = 0.7
    fill: float = 0.5
    analyzer_fill: float = 0.5
    shift: float = 0.0
    pitch_um: float = 1e6 * ArrayParameters.pitch
    heights: str | None = None

    def __post_init__(self) -> None:
        check_choice("kind", self.kind, KINDS)
        stack = self.stack
        check_real("pitch_um", self.pitch_um, *PITCHES_UM)
        check_real("period_um", self.period_um, 0.1, self.pitch_um / 2)
        check_real("shift", self.shift, -1, 1)
        upper = stack.metal("diffraction", self.diffraction)
        _check_lines("fill", upper, self.period_um, self.fill, stack)
        if self.kind == "interleaved":
            if self.analyzer is not None:
                raise ParameterError(f"analyzer = {self.analyzer!r}: must be None for an interleaved pixel")
            _check_period(2 * sum(stack.finger_um), "two diffusions' width and space", self.period_um, stack)
            return
        if self.analyzer is None:
            raise ParameterError(f"analyzer = None: must be a name for kind = {self.kind!r}")
        lower, gate = stack.metal("analyzer", self.analyzer), stack.gate.name if stack.gate else None
        if (self.analyzer == gate) != (self.kind == "photogate"):
            raise ParameterError(f"analyzer = {self.analyzer!r}: must be {gate}, the gates, for a photogate alone")
        _check_lines("analyzer_fill", lower, self.period_um / self.lines, self.analyzer_fill, stack)
        if self.gap_um <= 0:
            raise ParameterError(
                f"analyzer = {self.analyzer!r}: must be below diffraction = {self.diffraction!r} "
                f"(gap {self.gap_um:.3f} um)"
            )

    @property
    def lines(self) -> int:
        """Lines of the analyzer, or gates, in a period."""
        return 2 if self.kind == "photogate" else 1

    @property
    def shared(self) -> bool:
        """Return whether fingers of the two diodes share the light of the whole pixel."""
        return self.kind != "amplitude"

    @property
    def stack(self) -> OpticalStack:
        """The process's optical stack. Raises ParameterError."""
        return optical_stack(self.process, self.heights)

    @property
    def gap_um(self) -> float:
        """Return the distance from the upper lines' lower face to the analyzer's upper face, or to the silicon."""
        stack = self.stack
        upper = stack.metal("diffraction", self.diffraction).bottom_um
        return upper - (stack.metal("analyzer", self.analyzer).top_um if self.analyzer else stack.surface_um)

    def layers(self, wavelength_um: float) -> tuple[list[Slab], list[Slab]]:
        """Layers from the air down, cut above the analyzer; without one all are in the first. Raises ParameterError."""
        cut = Cutter(self.stack, wavelength_um)
        upper = cut.grating("diffraction", self.diffraction, self.fill)
        if self.analyzer is None:
            return upper + cut.down_to(cut.stack.surface_um), []
        upper += cut.down_to(self.stack.metal("analyzer", self.analyzer).top_um)
        return upper, cut.grating("analyzer", self.analyzer, self.analyzer_fill, self.lines) + cut.down_to(
            cut.stack.surface_um
        )


class Cutter:
    """The stack from the top down, cut at the faces of gratings."""

    def __init__(self, stack: OpticalStack, wavelength_um: float) -> None:
        self.stack, self.wavelength_um = stack, wavelength_um
        self.at = stack.films[-1].top_um

    def down_to(self, height_um: float) -> list[Slab]:
        """Films between here and ``height_um``."""
        out = []
        bottoms = [0.0, *(film.top_um for film in self.stack.films[:-1])]
        for film, bottom in [*zip(self.stack.films, bottoms, strict=True)][::-1]:
            low, high = max(bottom, height_um), min(film.top_um, self.at)
            if high > low:
                out.append(Slab(self._permittivity(film.material), high - low))
        self.at = min(self.at, height_um)
        return out

    def grating(
        self, field: str, name: str, fill: float, lines: int = 1, spans: tuple[tuple[float, float], ...] | None = None
    ) -> list[Slab]:
        """Films above a metal, and its lines. Raises ParameterError for one that is not inside one film."""
        metal = self.stack.metal(field, name)
        bottoms = [0.0, *(film.top_um for film in self.stack.films[:-1])]
        around = [
            film.material
            for film, bottom in zip(self.stack.films, bottoms, strict=True)
            if bottom <= metal.bottom_um and metal.top_um <= film.top_um
        ]
        if not around:
            raise ParameterError(f"{field} = {name!r}: must be a metal inside one film, which {name} is not")
        out = self.down_to(metal.top_um)
        line, medium = self._permittivity(metal.material), self._permittivity(around[0])
        self.at = metal.bottom_um
        return [*out, Slab(medium, metal.thickness_um, line, fill, lines, spans)]

    def _permittivity(self, material: str) -> complex:
        return complex(refractive_index(material, self.wavelength_um) ** 2)


def _check_lines(field: str, metal: Metal, period_um: float, fill: float, stack: OpticalStack) -> None:
    check_real(field, fill, 0, 1)
    _check_period(metal.width_um + metal.space_um, f"{metal.name}'s width and space", period_um, stack)
    low, high = metal.width_um / period_um, 1 - metal.space_um / period_um
    if not low - 1e-9 <= fill <= high + 1e-9:
        raise ParameterError(
            f"{field} = {fill:g}: must be in [{low:.3f}, {high:.3f}], lines of {metal.width_um:g} and spaces of "
            f"{metal.space_um:g} um of {metal.name}"
        )


def _check_period(least_um: float, of: str, period_um: float, stack: OpticalStack) -> None:
    if period_um < least_um - 1e-9:
        raise ParameterError(f"period_um = {period_um:g}: must be at least {least_um:g}, {of} in {stack.process}")

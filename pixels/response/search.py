"""The search: every candidate of a process, then steps around the best for each angular frequency of the tile.

All types of a sensor see the same light and are of one kind: the search is for a kind and a wavelength at which the
worst of them is best.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from talbot.base.jobs import Job, run
from talbot.base.records import from_json
from talbot.models.parameters import ParameterError
from talbot.pixels.optics.design import REACHED, WAVELENGTHS_UM, Design, candidates, front, measure, neighbours, phased
from talbot.pixels.optics.geometry import PixelGeometry
from talbot.pixels.optics.solve import Floats, SolverError
from talbot.platforms.optics import OpticalStack

# Refined: designs for a beta, wavelengths of a kind; how often, each with half the steps
STARTS, LIGHTS, ROUNDS = 2, 2, 2
CLEAR = 0.5  # of the differences' variance that the formula may leave in a design for the front
Point = tuple[PixelGeometry, float]  # with a wavelength in um


@dataclass(frozen=True)
class Plan:
    """A sensor's gratings: for each beta that is asked for the best design, or the nearest where none reaches it."""

    kind: str
    wavelength_um: float
    designs: dict[float, Design]

    def reached(self, beta: float) -> bool:
        """Return whether the design for ``beta`` has it."""
        return self.designs[beta].off(beta) <= REACHED

    def rank(self) -> tuple[int, bool, float]:
        """Return the key by which plans are sorted."""
        count, worst = self.score
        return count, self.kind == "amplitude", worst

    @property
    def score(self) -> tuple[int, float]:
        """Number of betas that are reached, and the figure of the worst."""
        figures = [design.fit.figure for beta, design in self.designs.items() if self.reached(beta)]
        return len(figures), min(figures, default=0.0)


@dataclass(frozen=True)
class Found:
    """Result of a search. tried: all designs. plans: the best of each kind, by their scores.

    Fingers of interleaved diodes are taken as collecting all that falls on them and nothing of their neighbours',
    which carriers that diffuse do not do: where both kinds reach as many betas, amplitude gratings are first.
    """

    tried: tuple[Design, ...]
    plans: tuple[Plan, ...]

    @cached_property
    def front(self) -> list[tuple[Design, float]]:
        """Designs of any beta that no other beats in modulation depth, quantum efficiency and bandwidth; that in um.

        Of gratings that were solved at most of the search's wavelengths.
        """
        found = [
            (design, wide)
            for same in self._lights.values()
            if len(same) > len(WAVELENGTHS_UM) // 2  # others were solved at their own wavelength alone
            for design, wide in same
        ]
        return front([(design, wide) for design, wide in found if design.fit.unexplained < CLEAR])

    def bandwidth_um(self, design: Design) -> float:
        """Bandwidth of a design that was tried, in steps of the wavelengths at which its gratings were."""
        return next(wide for one, wide in self._lights[_gratings(design)] if one.wavelength_um == design.wavelength_um)

    @cached_property
    def _lights(self) -> dict[PixelGeometry, list[tuple[Design, float]]]:
        """Designs of the same gratings by wavelength, and the bandwidth of each."""
        lights: dict[PixelGeometry, list[Design]] = {}
        for design in sorted(self.tried, key=lambda d: d.wavelength_um):
            lights.setdefault(_gratings(design), []).append(design)
        return {geometry: [*zip(same, _bandwidths(same), strict=True)] for geometry, same in lights.items()}


def _gratings(design: Design) -> PixelGeometry:
    """Return the fields common to designs that differ in the analyzer's place."""
    return replace(design.geometry, shift=0.0)


def _bandwidths(same: Sequence[Design]) -> list[float]:
    wavelengths, depths = [d.wavelength_um for d in same], [d.fit.m for d in same]
    return [bandwidth(wavelengths, depths, at) for at in range(len(same))]


def bandwidth(wavelengths_um: Sequence[float] | Floats, depths: Sequence[float], at: int) -> float:
    """Width in um of the wavelengths around that of place ``at`` at which m, ``depths``, is at least half as great."""
    ends = []
    for step in (-1, 1):
        end = at
        while 0 <= end + step < len(depths) and depths[end + step] >= depths[at] / 2:
            end += step
        ends.append(wavelengths_um[end])
    return float(ends[1] - ends[0])


def offered(stack: OpticalStack, kinds: Sequence[str], pitch_um: float) -> list[str]:
    """Those of ``kinds`` that the process can make. Raises ParameterError where there is none."""
    found = [kind for kind in kinds if next(candidates(stack, [kind], pitch_um), None)]
    if not found:
        raise ParameterError(f"kind = {', '.join(kinds)}: must be one that {stack.process} can make")
    return found


def search(
    stack: OpticalStack,
    betas: Sequence[float],
    kinds: Sequence[str],
    store: Path,
    note: Callable[[str], None],
    pitch_um: float = PixelGeometry.pitch_um,
) -> Found:
    """Search the metals of ``stack`` for ``betas``; solutions are kept in ``store``. kinds: `offered`."""
    note("candidates")
    grid = [*candidates(stack, kinds, pitch_um)]
    tried = _solve(((geometry, w) for geometry in grid for w in WAVELENGTHS_UM), len(WAVELENGTHS_UM), store)
    note("refine")
    for turn in range(ROUNDS):
        starts = [start for kind in kinds for start in _starts(tried, kind, betas)]
        known = {(design.geometry, design.wavelength_um) for design in tried}
        fresh = dict.fromkeys(
            (geometry, start.wavelength_um) for start in starts for geometry in neighbours(start, 0.5**turn)
        )
        tried += _solve((point for point in fresh if point not in known), 4, store)
    plans = [max(_plans(tried, kind, betas), key=lambda plan: plan.score) for kind in kinds]
    chosen = {_gratings(design): None for plan in plans for design in plan.designs.values()}
    known = {(_gratings(design), design.wavelength_um) for design in tried}
    rest = [(geometry, w) for geometry in chosen for w in WAVELENGTHS_UM if (geometry, w) not in known]
    tried += _solve(rest, len(WAVELENGTHS_UM), store)
    return Found(tuple(tried), tuple(sorted(plans, key=Plan.rank, reverse=True)))


def evaluate(points: Iterable[Point]) -> list[Design]:
    """Designs of geometries and wavelengths, those that the solver can answer for."""
    out = []
    for geometry, wavelength in points:
        try:
            out.append(phased(measure(geometry, wavelength)))
        except SolverError:  # a resonance: no pixel for this light
            continue
    return out


def _solve(points: Iterable[Point], together: int, store: Path) -> list[Design]:
    listed = [*points]
    parts = [listed[k : k + together] for k in range(0, len(listed), together)]
    jobs = [Job(f"{part[0][0].diffraction}-{k}", evaluate, (part,), (part,)) for k, part in enumerate(parts)]
    results = run(jobs, store, "gratings")
    return [design for result in results for design in from_json(list[Design], result)]


def _starts(tried: Sequence[Design], kind: str, betas: Sequence[float]) -> list[Design]:
    """Return the best designs for each beta, at the wavelengths that are best for all."""
    lights = sorted(_plans(tried, kind, betas), key=_promise, reverse=True)[:LIGHTS]
    return [
        start
        for plan in lights
        for beta in betas
        for start in sorted(_of(tried, kind, plan.wavelength_um), key=lambda d: -_worth(d, beta))[:STARTS]
    ]


def _promise(plan: Plan) -> float:
    return min(_worth(design, beta) for beta, design in plan.designs.items())


def _worth(design: Design, beta: float) -> float:
    """Return a design's figure, less the farther its beta is from the one that is asked for."""
    return design.fit.figure / (1 + (design.off(beta) / REACHED) ** 2)


def _plans(tried: Sequence[Design], kind: str, betas: Sequence[float]) -> list[Plan]:
    lights = sorted({design.wavelength_um for design in tried if design.geometry.kind == kind})
    return [Plan(kind, w, {beta: _best(_of(tried, kind, w), beta) for beta in betas}) for w in lights]


def _of(tried: Sequence[Design], kind: str, wavelength_um: float) -> list[Design]:
    return [d for d in tried if d.geometry.kind == kind and d.wavelength_um == wavelength_um]


def _best(tried: Sequence[Design], beta: float) -> Design:
    reaching = [design for design in tried if design.off(beta) <= REACHED]
    return max(reaching or tried, key=lambda design: _worth(design, beta))

"""Four taps through the chip's Verilog: as sums, as phases and as both diodes."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.progress import each
from talbot.imaging.frame import hardware
from talbot.imaging.frame.job import Clock, expose, read_golden, read_out, see
from talbot.imaging.frame.reading import about
from talbot.imaging.frame.request import FrameRequest
from talbot.imaging.frame.result import Exposed, GoldenResult
from talbot.models.capture import Region, Views
from talbot.models.parameters import ElectricalParameters, ParameterError
from talbot.models.plan import plan
from talbot.models.scene.rendered import RENDERED

VIEWS = 9  # of the capture along the pupil's diameter
TAPS = 4


@dataclass(frozen=True, eq=False)
class DepthFrames:
    """The same four exposures, read out six times.

    sums: the taps' sums, in tof mode. phases: phase and amplitude by the chip's divider, None of a chip without.
    pairs: both diodes, a raw frame for each tap, ahead of which the light's phase is set. coded: sums, and pairs,
    of four more exposures, in the light of a code. straight: sums without noise and converter of the light that
    comes straight from the surfaces, (4, rows, cols) in LSB, of a scene that has other light.
    """

    sums: GoldenResult
    phases: GoldenResult | None
    pairs: tuple[GoldenResult, ...]
    coded: tuple[GoldenResult, ...] = ()
    straight: npt.NDArray[np.float64] | None = None

    @property
    def all(self) -> tuple[GoldenResult, ...]:
        """Every frame."""
        return (self.sums, *([self.phases] if self.phases else []), *self.pairs, *self.coded)

    def about(self) -> dict[str, Any]:
        """Return figures of the frames, differences of all together."""
        every = [about(frame) for frame in self.all]
        wrong = {name: sum(part[name] for part in every) for name in ("stream_mismatches", "decoded_mismatches")}
        return every[0] | wrong

    def diodes(self, noisy: bool = True, coded: bool = False) -> npt.NDArray[np.float64]:
        """Both diodes of every tap in LSB, (4, 2, rows, cols); not noisy: ahead of the converters, without noise."""
        pairs = self.coded[1:] if coded else self.pairs
        frames = (frame.decoded.samples if noisy else frame.exposed.ideal for frame in pairs)
        return np.stack([np.moveaxis(np.asarray(samples, float), 2, 0) for samples in frames])


def capture(
    request: FrameRequest,
    note: Callable[[str], None] = lambda text: None,
    golden: bool = False,
    code: ElectricalParameters | None = None,
    direct: bool = False,
) -> DepthFrames:
    """Return the frames of ``request``, which is in tof mode.

    code: instead of the sensor's, of more frames. direct: of a scene whose light comes straight from the surfaces, all
    of it. Raises ParameterError, ToolError.
    """
    clock = Clock(note=note)
    with clock.step("setup"):
        scene, todo = see(request)
        if scene.depth is None:
            hint = "; a rendered scene has one at its own size and lens" if request.scene in RENDERED else ""
            raise ParameterError(f"scene = {request.name!r}: must have a depth, for time of flight{hint}")
        if direct and scene.echo is not None:
            scene = replace(scene, echo=None)
    with clock.step("capture"):
        count = 1 if not scene.angular else scene.views if scene.render is None else VIEWS
        views = Views((Region(count, np.ones(scene.shape, bool)),), count, None)
        exposed, straight = expose(request, scene, todo, views=views), None
        if scene.echo is not None:
            straight = expose(replace(request, noise=0.0), replace(scene, echo=None), todo, views=views).ideal
        by_code = None
        if code is not None:
            chip = replace(request, sensor=replace(request.sensor, electrical=code))
            by_code = chip, expose(chip, scene, plan(scene, chip.sensor, chip.frame), views=views)
    exposures = [(request, exposed), *_raw(request, exposed)]
    count = len(exposures)
    if by_code is not None:
        exposures += [by_code, *_raw(*by_code)]
    if has_divider := request.sensor.chip.has_phase_path:
        exposures.append((replace(request, frame=replace(request.frame, phase=True)), exposed))
    if golden:
        with clock.step("frames"):
            read = [read_golden(*frame) for frame in each(exposures, "frame")]
    else:
        with clock.step("build"):
            program = hardware.program(request.sensor, note=note)
        with clock.step("frames"):
            read = [read_out(*frame, program) for frame in each(exposures, "frame")]
    still = None if straight is None else np.moveaxis(straight, 2, 0)
    phases = read.pop() if has_divider else None
    return DepthFrames(read[0], phases, tuple(read[1:count]), tuple(read[count:]), still)


def _raw(request: FrameRequest, exposed: Exposed) -> list[tuple[FrameRequest, Exposed]]:
    """Every tap as a raw frame."""
    raw = replace(request, frame=replace(request.frame, mode="raw"))
    return [(raw, _tap(exposed, tap)) for tap in range(TAPS)]


def _tap(exposed: Exposed, tap: int) -> Exposed:
    """Return one tap of an exposure as a separate frame, for raw mode."""
    samples, clean = exposed.samples[tap : tap + 1], exposed.clean[tap : tap + 1]
    ideal = np.moveaxis(exposed.front_end.values(clean, "raw"), 0, 2)
    return replace(exposed, plan=replace(exposed.plan, taps=1), samples=samples, clean=clean, ideal=ideal)

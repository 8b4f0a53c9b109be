"""Frames of a sequence through one running simulation: exposed, read out by the chip and by the golden model, decoded.

The simulator works on a frame while Python computes the golden one, what is asked of the frame before, and the next
exposure. What is the same in all frames is made once: trims, plan, weights of the views, fixed pattern, simulator.
"""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from talbot.imaging.frame import hardware
from talbot.imaging.frame.job import Clock, expose, trimmed
from talbot.imaging.frame.request import FrameRequest
from talbot.imaging.frame.result import Exposed, FrameResult
from talbot.models.capture import Region, Views, choose_views
from talbot.models.capture.views import SAFETY
from talbot.models.chip import GoldenFrame, golden_frame
from talbot.models.digital.stream import decode_stream
from talbot.models.parameters import ParameterError
from talbot.models.plan import plan
from talbot.models.scene import Clip, Sampling, Scene, scene_of

NUMBERS = 1 << 16  # of the register frame_number


class Shown(NamedTuple):
    """A frame and how long it is shown, s."""

    result: FrameResult
    seconds: float


class _Pending(NamedTuple):
    """A frame in the simulator."""

    request: FrameRequest
    exposed: Exposed
    golden: GoldenFrame
    seconds: float
    chip: Callable[[], hardware.HardwareFrame]


def results(
    request: FrameRequest, clip: Clip, clock: Clock, note: Callable[[str], None] = lambda text: None
) -> Iterator[Shown]:
    """Yield the frames of ``clip`` one after another, registers and state of the chip kept between them.

    request: of every frame; its scene is not used, and frame_number counts on from its own. clock: gets the wall clock
    of the steps setup, capture, build, golden, rtl (waiting for the simulator) and decode. note: called with a line
    before each long part. Raises ParameterError, ToolError.
    """
    sensor, first = request.sensor, request.frame.frame_number
    sampling, choose = Sampling.of(sensor), _Chooser(request)
    with ExitStack() as stack:
        chip = program = todo = front_end = before = None
        for number, (luminance, seconds) in enumerate(_timed(clip, clock)):
            with clock.step("capture"):
                scene = scene_of(clip.name, luminance, sampling)
            if todo is None:
                with clock.step("setup"):
                    todo, front_end = plan(scene, sensor, request.frame), trimmed(request)
            with clock.step("capture"):
                views = choose(scene)
                numbered = replace(request, frame=replace(request.frame, frame_number=(first + number) % NUMBERS))
                exposed = expose(numbered, scene, todo, front_end, views, number)
            if chip is None or program is None:
                with clock.step("build"):
                    program = hardware.program(sensor, note=note)
                    chip = stack.enter_context(hardware.chip(program, exposed.front_end, todo.taps))
            with clock.step("send"):
                coming = chip.frame(numbered.frame, exposed.samples, exposed.front_end.trim)
            with clock.step("golden"):
                golden = golden_frame(exposed.samples, sensor, numbered.frame, exposed.front_end)
                _ = golden.stream
            if before:
                yield _ended(before, program, clock)
            before = _Pending(numbered, exposed, golden, seconds, coming)
        if before is None or program is None:
            raise ParameterError("frames = none: must be one or more")
        yield _ended(before, program, clock)


def _timed(clip: Clip, clock: Clock) -> Iterator[tuple[np.ndarray, float]]:
    """Yield the frames; the time that reading them takes is that of a step."""
    frames = iter(clip)
    while True:
        with clock.step("read"):
            frame = next(frames, None)
        if frame is None:
            return
        yield frame


def _ended(frame: _Pending, program: Path, clock: Clock) -> Shown:
    with clock.step("rtl"):
        chip = frame.chip()
    with clock.step("decode"):
        decoded = decode_stream(chip.stream, frame.request.sensor.tile)[0]
    return Shown(FrameResult(frame.request, frame.exposed, frame.golden, decoded, chip, program), frame.seconds)


class _Chooser:
    """The views of each frame: those of an earlier one, and chosen again where the picture has stronger gradients.

    The error in codes grows with the light's differences over the pupil, and these with its gradients: what SAFETY
    keeps below the bound is how far they may grow.
    """

    def __init__(self, request: FrameRequest) -> None:
        self._request = request
        self._views: Views | None = None
        self._limit = -1.0

    def __call__(self, scene: Scene) -> Views:
        if self._views and (self._request.views or not scene.angular):
            return self._views
        strength = _gradients(scene)
        if self._views is None or strength > self._limit:
            sensor, timing = self._request.lit, self._request.frame.exposing
            views = choose_views(scene, sensor, timing, self._request.views)
            if self._views is None or views.most >= self._views.most:
                self._views = _everywhere(views)
            self._limit = strength / SAFETY
        return self._views


def _gradients(scene: Scene) -> float:
    """RMS of the differences of neighbours, in one row of four."""
    here, below = scene.image[:-1:4], scene.image[1::4]
    steps = np.concatenate([(below - here).ravel(), np.diff(here).ravel()])
    return float(np.sqrt(np.square(steps).sum() / max(steps.size, 1)))


def _everywhere(views: Views) -> Views:
    """As many views of all pixels: tiles that are quiet in one frame are not in the next."""
    if len(views.regions) == 1:
        return views
    errors = {count: error for count, error, _ in views.tried}
    everywhere = np.ones(views.regions[0].pixels.shape, bool)
    return views._replace(regions=(Region(views.most, everywhere),), error=errors.get(views.most), left_out=())

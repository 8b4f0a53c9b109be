"""Depth from the frames of time of flight by every method, with baselines."""

from collections.abc import Callable, Container, Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.imaging.depth.capture import DepthFrames
from talbot.imaging.frame.light_field import estimator_of, full
from talbot.imaging.frame.reading import rms
from talbot.imaging.frame.result import PHASE_TURN, GoldenResult
from talbot.models.digital.phase import phase_samples
from talbot.models.pixel.time_of_flight import SPEED_OF_LIGHT, demodulate
from talbot.models.reconstruct import white_sum
from talbot.models.reconstruct.bad_pixels import dead_pixels, dilated
from talbot.models.reconstruct.bayes import Estimate, FieldEstimator, FieldPrior
from talbot.models.reconstruct.coded import Coded, coded_depth
from talbot.models.reconstruct.depth_field import DepthField, depth_field, foreground, refocused, still, unwrap
from talbot.models.scene import Sampling, camera

Values = npt.NDArray[np.floating]
Bools = npt.NDArray[np.bool_]
Complexes = npt.NDArray[np.complexfloating]
SINE, CODED = "field", "code"  # methods that lead: in the light of a sine, and of a code
FAINT = 3.0  # codes: what has a smaller amplitude has no phase
LOOSE = 0.2  # px per view step: no disparity is surer
# Of the prior: enough for turns, and smooth textures, whose phases are the less noisy
COARSE: dict[str, Any] = {"between": 0, "slants": 0, "fineness": 1.0}
EDGE = 2  # steps of the disparities that are tried from their ends: what is nearer may be beyond
CODES = 255
PLANES = 9  # of focus behind an occluder
CLEAR = (2, 1)  # px from the occluder's rays
APART = 0.01  # turns, standard deviation between the rays that pass it, from which on they end on two surfaces
NOISE = 1.0  # codes, of a tap: of the converter and the light, not less


@dataclass(frozen=True, eq=False)
class Depth:
    """Depths of the frames. depth: by method, in m, (rows, cols), the leading one first; sure: where it is known."""

    frames: DepthFrames
    field: DepthField
    coarse: Values
    depth: dict[str, Values]
    sure: dict[str, Bools]
    behind: Values | None
    summary: dict[str, Any]

    @property
    def lead(self) -> str:
        """The method whose depth leads: coded light where there is some."""
        return leading(self.depth)

    @property
    def truth(self) -> Values:
        """Depth of the scene in m."""
        return np.asarray(self.frames.sums.exposed.scene.depth)


def leading(methods: Container[str]) -> str:
    """Return the method whose depth leads."""
    return CODED if CODED in methods else SINE


def read_depth(frames: DepthFrames, prior: FieldPrior, note: Callable[[str], None] = lambda text: None) -> Depth:
    """Depth by every method, the leading one first: its figures are the summary's own."""
    result = frames.sums
    sensor, scene = result.sensor, result.exposed.scene
    truth, ambiguity = np.asarray(scene.depth), SPEED_OF_LIGHT / (2 * sensor.electrical.f_mod)
    note("field")
    white = white_sum(result.request.lit, result.request.frame.exposing)
    diodes = frames.diodes()
    dead = dead_pixels(diodes.sum(0) / (2 * white))
    over = dilated(full(diodes, (0, 1)) | dead, prior.margin)
    estimator = estimator_of(result, replace(prior, **COARSE))
    estimator.prepare(mixture=True)  # what is done once a sensor
    start = perf_counter()
    field = depth_field(estimator, diodes / white)
    seconds = perf_counter() - start
    ideal = depth_field(estimator, frames.diodes(noisy=False) / white)
    note("unwrap")
    coarse, doubt = by_disparity(result, field, prior)
    depth, sure = {}, {}
    for name, phase in _phases(frames, field, ideal, white).items():
        unwrapped = unwrap(np.where(over, np.nan, phase), coarse / ambiguity, doubt / ambiguity)
        depth[name], sure[name] = unwrapped.turns * ambiguity, unwrapped.sure
    for name, got in _coded(frames, estimator, white).items():
        depth[name], sure[name] = got.depth, got.sure & ~over
    left_out = _three(estimator, diodes, white) if still(diodes, NOISE) else None
    if left_out is not None:
        phase, amplitude = demodulate(left_out[0].centre * white)
        phase = np.where(over | (amplitude < FAINT), np.nan, phase)
        unwrapped = unwrap(phase, coarse / ambiguity, doubt / ambiguity)
        depth["three"], sure["three"] = unwrapped.turns * ambiguity, unwrapped.sure
    lead = leading(depth)
    depth = {lead: depth[lead]} | depth
    methods = {name: figures(depth[name], truth, sure[name], ambiguity) for name in depth}
    once = sure[lead]
    baselines = {
        "constant": figures(np.full_like(truth, truth.mean()), truth, once, ambiguity),
        "light_field": figures(coarse, truth, once, ambiguity),
        "wrapped": figures(depth[SINE] % ambiguity, truth, once, ambiguity),
    }
    behind, past = _behind(field, coarse, ambiguity, result)
    summary = frames.about() | {
        "range_m": float(np.ptp(truth)),
        "ambiguity_m": ambiguity,
        "depth_method": lead,
        "depth_rms_m": methods[lead]["rms_m"],
        "depth_sure": methods[lead]["sure"],
        "methods": methods,
        "baselines": baselines,
        "multipath": _multipath(frames),
        "behind": past,
        "seconds": seconds,
        "left_out": {"taps": 1, "seconds": left_out[1]} if left_out else None,
    }
    return Depth(frames, field, coarse, depth, sure, behind, summary)


def _phases(frames: DepthFrames, field: DepthField, ideal: DepthField, white: float) -> dict[str, Values]:
    """Phase by every method in rad, NaN where the amplitude is too small for one.

    divider: the chip's own, of the sums. sums: atan2 of the same sums. field: of the depth field's centre view, divider
    and float; from samples without noise and converter. Those of a divider are missing where the chip has none.
    """
    chip = frames.sums.request.sensor.chip
    centre = np.moveaxis(field.centre, 0, -1) * white
    codes = np.rint(np.clip(centre, 0, CODES)).astype(int)
    by_divider = {}
    if frames.phases:
        sent = np.asarray(frames.phases.decoded.samples, float)
        turns, strength = phase_samples(codes, chip)
        by_divider = {
            "divider": (sent[..., 0] * PHASE_TURN, sent[..., 1]),
            "field_divider": (turns * PHASE_TURN, strength),
        }
    out = by_divider | {
        "sums": demodulate(np.moveaxis(frames.sums.decoded.samples.astype(float), 2, 0)),
        "field": demodulate(np.moveaxis(centre, -1, 0)),
        "field_float": demodulate(ideal.centre * white),
    }
    return {name: np.where(amplitude < FAINT, np.nan, phase) for name, (phase, amplitude) in out.items()}


def _three(estimator: FieldEstimator, diodes: Values, white: float) -> tuple[DepthField, float]:
    """Return the depth field without the last tap, and the seconds that it takes."""
    start = perf_counter()
    return depth_field(estimator, diodes[:3] / white), perf_counter() - start


def _coded(frames: DepthFrames, estimator: FieldEstimator, white: float) -> dict[str, Coded]:
    """Return the depth of coded light: by the taps' sums, and by the middle view of their depth field."""
    if not frames.coded:
        return {}
    electrical = frames.coded[0].sensor.electrical
    sums = np.moveaxis(frames.coded[0].decoded.samples.astype(float), 2, 0)
    centre = depth_field(estimator, frames.diodes(coded=True) / white).centre * white
    return {name: coded_depth(taps, electrical, NOISE) for name, taps in (("code", sums), ("code_field", centre))}


def _multipath(frames: DepthFrames) -> dict[str, float] | None:
    """Return the errors (m) of the depth of the sums' phase by multipath, without noise."""
    if frames.straight is None:
        return None
    phase, straight = (demodulate(taps)[0] for taps in (np.moveaxis(frames.sums.exposed.ideal, 2, 0), frames.straight))
    turn = SPEED_OF_LIGHT / (2 * frames.sums.sensor.electrical.f_mod)
    moved = ((phase - straight) / (2 * np.pi) + 0.5) % 1 - 0.5
    return {"median_m": float(np.median(moved)) * turn, "rms_m": float(np.sqrt(np.mean(moved**2))) * turn}


def by_disparity(result: GoldenResult, field: DepthField | Estimate, prior: FieldPrior) -> tuple[Values, Values]:
    """Depth of the light field in m, and its standard deviation; infinite at the ends of what was tried.

    What the prior knew is taken out of both, so that a disparity that no sample tells has no weight.
    """
    sampling = Sampling.of(result.sensor)
    middle, width = (prior.near + prior.far) / 2, (prior.near - prior.far) / np.sqrt(12)
    spread = np.hypot(field.spread, LOOSE)
    information = np.maximum(1 / spread**2 - 1 / max(width, LOOSE) ** 2, 0)
    known = information > 0
    information = np.where(known, information, 1)
    disparity = middle + (field.disparity - middle) / spread**2 / information
    step = (prior.near - prior.far) / max(prior.disparities - 1, 1)
    room = np.minimum(field.disparity - prior.far, prior.near - field.disparity)
    ends = room < EDGE * step + field.spread
    depth = camera.depth(np.clip(disparity, prior.far, prior.near), sampling)
    doubt = depth**2 / camera.per_inverse_metre(sampling) / np.sqrt(information)
    return depth, np.where(known & ~ends, doubt, np.inf)


def figures(depth: Values, truth: Values, sure: Bools, ambiguity: float) -> dict[str, float | None]:
    """Errors of a depth in m: RMS where it is sure and everywhere, and modulo a turn; share of wrong turns."""
    error = depth - truth
    modulo = (error + ambiguity / 2) % ambiguity - ambiguity / 2
    return {
        "rms_m": rms(error[sure]),
        "rms_all_m": rms(error),
        "rms_modulo_m": rms(modulo[sure]),
        "sure": float(sure.mean()),
        "wrong_turns": float((np.abs(error[sure]) > ambiguity / 2).mean()) if sure.any() else None,
    }


def _behind(
    field: DepthField, coarse: Values, ambiguity: float, result: GoldenResult
) -> tuple[Values | None, dict[str, Any] | None]:
    """Depth of what an occluder hides in m, NaN where no ray passes, and its errors; of a scene that has one.

    The whole turns are the fewest that put it behind the occluder: its own disparity is not seen through the gaps.
    Where the rays that pass do not agree they end on two surfaces, and there is no depth either.
    """
    scene = result.exposed.scene
    near = None if scene.behind is None else foreground(field, coarse / ambiguity)
    if near is None or scene.behind is None:
        return None, None
    middle = scene.views // 2
    limit = float(np.median(coarse[near[middle, middle]]))
    phasors, sampling = field.phasors, Sampling.of(result.sensor)
    rough = _beyond(np.angle(phasors[middle, middle]), limit, ambiguity)[~near[middle, middle]]
    ends = camera.disparity(np.quantile(rough, (0.98, 0.02)), sampling)
    # Rays next to the occluder's are mixtures: those farther from it go first
    clear = [~dilated(near, width) for width in CLEAR]
    depth, mixed, apart = np.zeros((3, *scene.shape))
    off, seen = np.full(scene.shape, np.inf), np.zeros(scene.shape, bool)
    # Each pixel from where its own depth is in focus
    for disparity in np.linspace(float(ends[0]), float(ends[1]), PLANES):
        passed, strength = _passing(phasors, disparity, clear)
        behind, all_rays = (
            _beyond(np.angle(p), limit, ambiguity) for p in (passed, refocused(phasors, disparity, None))
        )
        here = np.abs(passed) > 0
        agreed = np.where(here, np.abs(passed) / np.where(here, strength, 1), 1)
        between = np.sqrt(-2 * np.log(np.minimum(agreed, 1))) / (2 * np.pi)
        away = np.where(here, np.abs(camera.disparity(behind, sampling) - disparity), np.inf)
        better = (away < off) | ~seen
        pairs = (behind, depth), (all_rays, mixed), (between, apart), (away, off)
        depth, mixed, apart, off = (np.where(better, *pair) for pair in pairs)
        seen |= here
    seen &= apart < APART
    past = {
        "rms_m": rms((depth - scene.behind)[seen]),
        "rms_all_rays_m": rms(mixed - scene.behind),
        "rms_constant_m": float(np.std(scene.behind)),
        "seen": float(seen.mean()),
        "occluded": float(near[middle, middle].mean()),
        "range_m": float(scene.behind.max() - np.min(np.asarray(scene.depth))),
    }
    return np.where(seen, depth, np.nan), past


def _passing(phasors: Complexes, disparity: float, clear: Sequence[Bools]) -> tuple[Complexes, Values]:
    """Mean phasor of the rays that pass, and mean of their amplitudes: of the first of ``clear`` that has some."""
    out = []
    for values in (phasors, np.abs(phasors).astype(complex)):
        depth = refocused(values, disparity, clear[0])
        for rays in clear[1:]:
            depth = np.where(np.abs(depth) > 0, depth, refocused(values, disparity, rays))
        out.append(depth)
    return out[0], np.abs(out[1])


def _beyond(phase: Values, limit: float, ambiguity: float) -> Values:
    """Return the least depth in m behind ``limit`` that has this phase."""
    fine = phase / (2 * np.pi) % 1 * ambiguity
    return fine + np.maximum(np.ceil((limit - fine) / ambiguity), 0) * ambiguity

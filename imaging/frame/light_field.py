"""The light field of a raw frame: the part that is read, its prior, and its estimate by a method's name."""

from dataclasses import replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from talbot.imaging.frame.request import FrameRequest
from talbot.models.capture import CaptureOperator, cells
from talbot.models.digital.stream.frame import DecodedFrame
from talbot.models.parameters import ParameterError, SensorParameters
from talbot.models.reconstruct import FULL, diode_noise, light_field_estimate, white_sum
from talbot.models.reconstruct.bad_pixels import dead_pixels, repaired
from talbot.models.reconstruct.bayes import FieldEstimator, FieldPrior
from talbot.models.reconstruct.bayes.prior import NOISE_MAX
from talbot.models.reconstruct.methods import ANY_TYPES, DEFAULT, Found, check_method, measure
from talbot.models.scene import Scene

Values = npt.NDArray[np.floating]
PUPIL = 7  # points across the pupil at which the estimators take a scene that can be seen from anywhere
SURE = 0.5  # px per view step: a disparity of a larger standard deviation is none
SHIFT = 12.5  # px by which disparity moves a point across the pupil, at most: 2.5 a step of 5 views
HEADROOM = 5.0  # LSB below a full code, for noise and bow of the converters: what is above counts as full
MOST_VIEWS = 17  # along the pupil, for which the filters of `linear` have 2 GB; they grow with the square


class Seen(Protocol):
    """An exposure's scene."""

    @property
    def scene(self) -> Scene:
        """Before the sensor."""
        ...


class Readout(Protocol):
    """Parts of a frame from which light fields are estimated: `result.GoldenResult`."""

    @property
    def request(self) -> FrameRequest:
        """Parameters of the frame."""
        ...

    @property
    def exposed(self) -> Seen:
        """Scene, of which the number of views counts."""
        ...

    @property
    def decoded(self) -> DecodedFrame:
        """Decoded samples."""
        ...

    @cached_property
    def sensor(self) -> SensorParameters:
        """The sensor as it is known."""
        ...


class Part(NamedTuple):
    """Part of the array that is read: a rectangle of whole tiles, (rows, cols), of pixel types, bool (types,)."""

    box: tuple[slice, slice]
    types: tuple[bool, ...]


def part_of(result: Readout) -> Part | None:
    """Return the region that is read; None where it is not every tile of a window (decimation, lost rows)."""
    frame, (rows, cols) = result.request.frame, result.sensor.shape
    tile, window = result.sensor.tile, frame.window
    types = np.array([bool(frame.mask >> kind & 1) for kind in range(tile.n_types)])
    box = (
        slice(window.row0 * tile.rows, min((window.row1 + 1) * tile.rows, rows)),
        slice(window.col0 * tile.cols, min((window.col1 + 1) * tile.cols, cols)),
    )
    read = np.zeros((rows, cols), bool)
    read[box] = types[tile.type_map(rows, cols)[box]]
    return Part(box, tuple(types.tolist())) if (read == result.decoded.read).all() else None


def method_of(result: Readout) -> str:
    """The method for a frame where none is said: `DEFAULT`, or direct, which a decimated frame or many views leave."""
    return DEFAULT if part_of(result) and result.exposed.scene.views <= MOST_VIEWS else "direct"


def estimate(result: Readout, method: str = DEFAULT, prior: FieldPrior | None = None) -> Found:
    """The light field of a raw frame by one of `methods.METHODS`; 0 where no tile is read, and no disparity there.

    prior: by default `prior_of` the frame. Raises ParameterError for an unknown method, one that is not for frames of
    this size, and a part of the array that it does not take.
    """
    sensor, (sent, bad) = result.sensor, sent_pair(result)
    operator = CaptureOperator(sensor, read=result.decoded.read)
    check_method(method, operator)
    if method == "direct":
        return Found(light_field_estimate(operator, sent) * reached(result))
    part = whole_tiles(result)
    if not all(part.types) and method not in ANY_TYPES:
        raise ParameterError(f"method = {method!r}: must be one of {', '.join(ANY_TYPES)} for a part of the types")
    sent, bad = sent[:, *part.box], bad[part.box]
    operator = CaptureOperator(_cut(sensor, part))
    check_method(method, operator)
    estimator = estimator_of(result, prior or prior_of(result))
    got = unsure(measure(method, estimator, operator, sent)[0], bad, estimator)
    return Found(
        _placed(got.light_field * reached(result), sensor, part, 0.0),
        None if got.disparity is None else _placed(got.disparity, sensor, part, 0.0),
        None if got.spread is None else _placed(got.spread, sensor, part, np.inf),
        got.plain,
    )


def whole_tiles(result: Readout) -> Part:
    """Return the region that is read. Raises ParameterError where it is not every tile of a window."""
    part = part_of(result)
    if part is None:
        name, step = "decimation", result.request.frame.decimation
        raise ParameterError(f"{name} = {step}: must be 0, and every row must be there, for another method than direct")
    return part


def tried(views: int, near: float | None, far: float | None) -> dict[str, float]:
    """Ends of the disparities that are tried in a scene of ``views``, near and far. Raises ParameterError."""
    reach = SHIFT / views
    near, far = reach if near is None else near, -reach if far is None else far
    FieldPrior(near=near, far=far)
    return {"near": near, "far": far}


def prior_of(result: Readout, near: float | None = None, far: float | None = None, **rest: Any) -> FieldPrior:
    """Return the prior of a frame: the noise of its sensor in its mean light, its contrast. rest: other of its fields.

    near, far: by default a disparity of `SHIFT` between the views at the pupil's ends, however many are between.
    """
    request = result.request
    rest |= tried(result.exposed.scene.views, near, far)
    timing, read = request.frame.exposing, result.decoded.read
    light = result.decoded.samples[read].mean() / white_sum(request.lit, timing)
    noise = float(diode_noise(light, request.lit, timing, request.noise))
    # A scene is never as even as the prior's planes.
    prior = FieldPrior(noise=min(max(noise, FieldPrior.noise), NOISE_MAX), **rest)
    part = part_of(result)
    if part is None or not all(part.types):
        return prior
    return replace(prior, contrast=prior.contrast_of(pair_of(result, result.decoded.samples).mean(0)[part.box], noise))


def estimator_of(result: Readout, prior: FieldPrior) -> FieldEstimator:
    """Return the estimator for the part that is read. Raises ParameterError unless it is whole tiles of a window."""
    scene, part = result.exposed.scene, whole_tiles(result)
    pupil = scene.views if scene.render is None else PUPIL
    return _estimator(_cut(result.sensor, part), scene.views, prior, pupil, part.types)


@lru_cache(maxsize=1)  # with what it makes once a sensor, for the next method or frame
def _estimator(
    sensor: SensorParameters, views: int, prior: FieldPrior, pupil: int, types: tuple[bool, ...]
) -> FieldEstimator:
    return FieldEstimator(sensor, views, prior, pupil, np.array(types))


def sent_pair(result: Readout) -> tuple[Values, npt.NDArray[np.bool_]]:
    """Samples of a raw frame as `pair_of`, dead pixels repaired, and the pixels that are dead or full."""
    samples = result.decoded.samples
    pair = pair_of(result, samples)
    dead = dead_pixels(pair) & result.decoded.read
    return repaired(pair, dead), dead | full(np.asarray(samples, float), (2,))


def full(samples: npt.NDArray[np.floating], axes: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """Return where any of the samples along ``axes``, in LSB, is full, so that its light is not known."""
    return np.asarray((samples > FULL - HEADROOM).any(axes))


def unsure(found: Found, bad: npt.NDArray[np.bool_], estimator: FieldEstimator) -> Found:
    """``found`` without a disparity wherever a window holds a bad pixel."""
    if found.spread is None or not bad.any():
        return found
    return found._replace(spread=np.where(estimator.told_by(bad), np.inf, found.spread))


def pair_of(result: Readout, samples: npt.NDArray[Any]) -> Values:
    """Samples (rows, cols, 2) as (2, rows, cols), 1 = the average diode in a flat white scene."""
    white = white_sum(result.request.lit, result.request.frame.exposing)
    return np.moveaxis(np.asarray(samples, float), 2, 0) / white


def reached(result: Readout) -> npt.NDArray[np.bool_]:
    """Corners that the round pupil does not reach have no light."""
    return cells(result.exposed.scene.views)[..., None, None]


def _cut(sensor: SensorParameters, part: Part) -> SensorParameters:
    """Return the sensor of the part alone: its tiles are whole, so that its types lie as in the array."""
    rows, cols = (side.stop - side.start for side in part.box)
    return replace(sensor, array=replace(sensor.array, rows=rows, cols=cols))


def _placed(values: Values, sensor: SensorParameters, part: Part, rest: float) -> Values:
    """Values of a part in the array, ``rest`` elsewhere."""
    if values.shape[-2:] == sensor.shape:
        return values
    out = np.full((*values.shape[:-2], *sensor.shape), rest, values.dtype)
    out[..., *part.box] = values
    return out

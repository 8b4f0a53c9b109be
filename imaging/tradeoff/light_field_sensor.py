"""Light fields by `linear` and `mixture` over parameters of the sensor, of the motorcycle: bits of the
converters (the chip has 8; others are the analog values of the same exposure, rounded), the threshold of edge mode
(sums of an image frame with the differences of an edge frame, those below it 0, by the golden chip), views that are
given back, and layouts [Jayasuriya2017, Fig. 3.4, 3.5]: the prototype's tile, its types in another order, types of
random beta, gamma and alpha, and responses that are random over the pupil, which no grating has."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from talbot.base.charts import curves
from talbot.imaging.frame.job import golden_result
from talbot.imaging.frame.light_field import estimator_of, pair_of, prior_of, reached
from talbot.imaging.frame.request import STANDARD, request
from talbot.imaging.frame.result import GoldenResult
from talbot.imaging.lightfield.figures import figures
from talbot.models.afe import trim_gain
from talbot.models.capture import CaptureOperator
from talbot.models.parameters import PixelType, TileParameters
from talbot.models.pixel.response import aperture
from talbot.models.reconstruct import methods, psnr_db, white_sum

BITS = (3, 4, 5, 6, 7, 8, 10, 12)
THRESHOLDS = (0, 2, 4, 8, 16, 32)  # LSB of a difference
VIEWS = (3, 5, 7)
LAYOUTS = "prototype", "another order", "random types", "random responses"
DISPARITIES = 11
SEED = 1  # of layouts
FULL_CODE = 256  # LSB of the chip's 8 bits

Floats = npt.NDArray[np.float64]
Point = tuple[str, int | str, int]


def points(quick: bool) -> list[Point]:
    """Return the changed field, its value, and the rows of the array."""
    if quick:
        return [("bits", 3, 24), ("bits", 8, 24), ("threshold", 32, 24)]
    every = {"bits": BITS, "threshold": THRESHOLDS, "views": VIEWS, "layout": LAYOUTS}
    return [(what, value, 96) for what, values in every.items() for value in values]


@lru_cache(maxsize=1)
def _frame(size: int, views: int, layout: str) -> GoldenResult:
    sensor = replace(STANDARD, tile=tile(layout), optics=replace(STANDARD.optics, views=views))
    return golden_result(request(rows=size, cols=size, mode="raw", sensor=sensor))


def tile(layout: str) -> TileParameters:
    """Return the tile of one of `LAYOUTS`."""
    standard, rng = STANDARD.tile, np.random.default_rng(SEED)
    if layout == "another order":
        return replace(standard, order=tuple(rng.permutation(standard.n_types).tolist()))
    if layout == "random types":
        draws = rng.uniform((6, -90, 0), (24, 90, np.pi), (standard.n_types, 3))
        return replace(standard, types=tuple(PixelType(*draw) for draw in draws.tolist()))
    if layout == "random responses":
        return replace(standard, types=tuple(_dense(seed) for seed in range(standard.n_types)))
    return standard


def _dense(seed: int) -> PixelType:
    """Two diodes that share the light of each of 7 x 7 cells of the pupil at random."""
    share = np.random.default_rng((SEED, seed)).random((7, 7))
    edge = np.arctan(STANDARD.optics.camera.nu_max)

    def response(theta_x: npt.NDArray[np.floating], theta_y: npt.NDArray[np.floating]) -> Floats:
        place = (np.clip((np.stack([theta_y, theta_x]) / edge + 1) / 2, 0, 1 - 1e-9) * len(share)).astype(int)
        envelope = aperture(theta_x, theta_y, STANDARD.optics.aperture_sigma)
        return np.stack([2 * envelope * share[*place], 2 * envelope * (1 - share[*place])])

    return PixelType(50.0, 0.0, 0.0, response=response)


def quantized(result: GoldenResult, bits: int) -> Floats:
    """Return the diodes of a frame through ideal converters of ``bits`` bits, (rows, cols, 2) in LSB of the chip's."""
    step = FULL_CODE / 2**bits
    values = result.exposed.front_end.values(result.exposed.samples, "raw")
    return np.moveaxis(np.clip(np.rint(values / step), 0, 2**bits - 1) * step, 0, 2)


def gated(result: GoldenResult, threshold: int) -> tuple[Floats, float]:
    """The diodes from the codes of an image and of an edge frame of one exposure, and the share of edges converted."""
    chip, samples = result.exposed.front_end, result.exposed.samples
    total = chip.convert(samples, "image").codes[0].astype(float)
    edges = chip.convert(samples, "edge", threshold).codes[0].astype(float)
    g = trim_gain(chip.trim)[chip.tile.type_map(*total.shape)]
    first = (edges / chip.gain + g * total) / (1 + g)
    return 2 * np.stack([first, total - first], 2), float((edges != 0).mean())


def measure(point: Point) -> dict[str, Any]:
    """Quality of both methods with one parameter of the sensor changed."""
    what, value, size = point
    result = _frame(size, int(value) if what == "views" else 5, str(value) if what == "layout" else LAYOUTS[0])
    samples, spread, share = result.decoded.samples.astype(float), 0.0, 1.0
    if what == "bits":
        samples, spread = quantized(result, int(value)), FULL_CODE / 2 ** int(value) / np.sqrt(12)
    elif what == "threshold":
        samples, share = gated(result, int(value))
        spread = int(value) / result.exposed.front_end.gain / np.sqrt(3)
    white = white_sum(result.request.lit, result.request.frame.exposing)
    prior = prior_of(result, disparities=DISPARITIES)
    prior = replace(prior, noise=float(np.hypot(prior.noise, spread / white)))
    pair, corners = pair_of(result, samples), reached(result)
    truth = result.exposed.scene.full_light_field * corners
    free = psnr_db(np.broadcast_to(result.image, truth.shape) * corners, truth)
    estimator, operator = estimator_of(result, prior), CaptureOperator(result.sensor)
    row: dict[str, Any] = {"what": what, "value": value, "sent": share, "sum_image_psnr_db": free}
    for name in ("linear", "mixture"):
        quality = figures(methods.METHODS[name](estimator, operator, pair).light_field * corners, truth, free)
        row |= {f"{name}_{key}": quality[key] for key in ("psnr_db", "gain_db", "slope")}
    return row


def plot(rows: Sequence[dict[str, Any]]) -> Figure:
    """PSNR of the mixture and the sum image, one place for each change."""
    series: dict[str, list[tuple[float, float, str]]] = {}
    for place, r in enumerate(rows):
        series.setdefault(str(r["what"]), []).append((place, r["mixture_psnr_db"], str(r["value"])))
        series.setdefault("sum image in every view", []).append((place, r["sum_image_psnr_db"], ""))
    return curves(
        series, "what is changed, and to what", "PSNR of the mixture (dB)", "Light fields: the sensor's share"
    )

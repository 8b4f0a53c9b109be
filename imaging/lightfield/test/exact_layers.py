"""Scenes of layers that are known in every view, and what methods gain on them: a table of docs/results/light_field.md.

python -m talbot.imaging.lightfield.test.exact_layers planes:1 holes:1 warped:1 prints a row for each scene, kind:seed.
"""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.ndimage import map_coordinates, spline_filter
from skimage import color, data
from skimage.transform import resize

from talbot.imaging.frame.job import expose, read_golden
from talbot.imaging.frame.light_field import estimator_of, pair_of, prior_of, reached, sent_pair
from talbot.imaging.frame.request import request
from talbot.models.capture import CaptureOperator, Region, Views
from talbot.models.parameters import SensorParameters
from talbot.models.plan import plan
from talbot.models.reconstruct import psnr_db
from talbot.models.reconstruct.layers import fit_textures, layered
from talbot.models.reconstruct.stack import Stack
from talbot.models.scene import Scene

Floats = npt.NDArray[np.floating]
Mask = Callable[[Floats, Floats], npt.NDArray[np.bool_]]
SIZE, VIEWS = 128, 5
CAPTURE = 11  # views along the pupil
FINE = 3  # points a pixel, along each side, at which a mask is taken
MARGIN = 32  # px of texture around the array
MIDDLE = SIZE / 2
PHOTOGRAPHS = (
    "astronaut",
    "camera",
    "chelsea",
    "coffee",
    "coins",
    "brick",
    "grass",
    "gravel",
    "moon",
    "rocket",
    "page",
)
Waves = Sequence[tuple[float, float, float, float]]  # amplitude (px per view step), rad a px down and across, phase


@dataclass(frozen=True, eq=False)
class Layer:
    """A surface. plane: disparity in the middle and its slopes down and across. mask: None is everywhere."""

    texture: Floats
    plane: tuple[float, float, float]
    mask: Mask | None = None
    waves: Waves = ()

    def disparity(self, y: Floats, x: Floats) -> Floats:
        """Disparity at places of the middle view, px per view step."""
        middle = (SIZE - 1) / 2
        flat = self.plane[0] + self.plane[1] * (y - middle) + self.plane[2] * (x - middle)
        return flat + sum(a * np.sin(p * y + q * x + phase) for a, p, q, phase in self.waves)

    def place(self, y: Floats, x: Floats, dv: float, du: float) -> tuple[Floats, Floats, Floats]:
        """Place in the middle view of what a view shows at (y, x), and its disparity."""
        down, across = y, x
        for _ in range(12):
            disparity = self.disparity(down, across)
            down, across = y + dv * disparity, x + du * disparity
        return down, across, self.disparity(down, across)

    def light(self, y: Floats, x: Floats) -> Floats:
        """Radiance at places of the middle view."""
        return np.clip(map_coordinates(self.texture, [y + MARGIN, x + MARGIN], order=3, prefilter=False), 0, 16)


def view(layers: Sequence[Layer], dv: float, du: float) -> tuple[Floats, Floats]:
    """A view of layers, the nearest first, and the disparity of what it shows."""
    fine = np.meshgrid(*[(np.arange(SIZE * FINE) + 0.5) / FINE - 0.5] * 2, indexing="ij")
    y, x = np.indices((SIZE, SIZE), float)
    out, shown, left = np.zeros((SIZE, SIZE)), np.full((SIZE, SIZE), np.nan), np.ones(fine[0].shape)
    for layer in layers:
        down, across, disparity = layer.place(y, x, dv, du)
        here = 1.0 if layer.mask is None else layer.mask(*layer.place(*fine, dv, du)[:2]).astype(float)
        share = (left * here).reshape(SIZE, FINE, SIZE, FINE).mean((1, 3))
        left = left * (1 - here)
        out += share * layer.light(down, across)
        shown = np.where(np.isnan(shown) & (share > 0.5), disparity, shown)
    return out, np.where(np.isnan(shown), disparity, shown)


def photograph(name: str, rng: np.random.Generator) -> Floats:
    """Part of a photograph of scikit-image, in linear light."""
    codes = np.asarray(getattr(data, name)(), float) / 255
    linear = (color.rgb2gray(codes) if codes.ndim == 3 else codes) ** 2.2
    side = int(rng.uniform(0.6, 1.0) * min(linear.shape))
    top, first = (int(rng.integers(0, size - side + 1)) for size in linear.shape)
    part = linear[top : top + side, first : first + side]
    part = part[:, ::-1] if rng.random() < 0.5 else part
    part = resize(part, (SIZE + 2 * MARGIN,) * 2, order=3, anti_aliasing=True)
    return spline_filter(np.clip(part * rng.uniform(0.7, 1.1) + 0.03, 0.02, 1.5))


def grain(rng: np.random.Generator) -> Floats:
    """A random texture whose amplitude falls with the frequency."""
    size = SIZE + 2 * MARGIN
    k = np.hypot(np.fft.fftfreq(size)[:, None], np.fft.rfftfreq(size))
    k[0, 0] = 1
    waves = np.fft.rfft2(rng.standard_normal((size, size))) * k**-1.4 * np.exp(-((k / 0.3) ** 2))
    values = np.fft.irfft2(waves, (size, size))
    return spline_filter(np.clip(0.5 + 0.18 * (values - values.mean()) / values.std(), 0.02, 1.2))


def _texture(rng: np.random.Generator) -> Floats:
    return grain(rng) if rng.random() < 0.35 else photograph(PHOTOGRAPHS[rng.integers(len(PHOTOGRAPHS))], rng)


def _slopes(rng: np.random.Generator, down: float) -> tuple[float, float]:
    return float(rng.uniform(-down, down)), float(rng.uniform(-down, down))


def planes(seed: int) -> list[Layer]:
    """A slanted plane with a bent edge before another."""
    rng = np.random.default_rng([1, seed])
    angle, offset, bend = rng.uniform(0, 6.28), rng.uniform(-20, 20), rng.uniform(-0.002, 0.002)

    def mask(y: Floats, x: Floats) -> npt.NDArray[np.bool_]:
        along = -(y - MIDDLE) * np.sin(angle) + (x - MIDDLE) * np.cos(angle)
        return (y - MIDDLE) * np.cos(angle) + (x - MIDDLE) * np.sin(angle) + bend * along**2 > offset

    near = Layer(_texture(rng), (rng.uniform(0.3, 1.4), *_slopes(rng, 0.004)), mask)
    return [near, Layer(_texture(rng), (rng.uniform(-1.6, -0.6), *_slopes(rng, 0.005)))]


def holes(seed: int) -> list[Layer]:
    """A plane with round holes before a slanted one."""
    rng = np.random.default_rng([2, seed])
    count = rng.integers(6, 14)
    rounds = [(rng.uniform(0, SIZE), rng.uniform(0, SIZE), rng.uniform(8, 26)) for _ in range(count)]

    def mask(y: Floats, x: Floats) -> npt.NDArray[np.bool_]:
        return np.all([(y - a) ** 2 + (x - b) ** 2 > r**2 for a, b, r in rounds], 0)

    near = Layer(_texture(rng), (rng.uniform(0.6, 1.5), 0.0, 0.0), mask)
    return [near, Layer(_texture(rng), (rng.uniform(-1.6, -0.8), *_slopes(rng, 0.005)))]


def warped(seed: int) -> list[Layer]:
    """Photographs on three bent surfaces, the nearer two in blobs."""
    rng = np.random.default_rng([3, seed])

    def layer(low: float, high: float, slope: float, blob: tuple[float, float] | None) -> Layer:
        texture = photograph(PHOTOGRAPHS[rng.integers(len(PHOTOGRAPHS))], rng)
        plane = rng.uniform(low, high), *_slopes(rng, slope)
        mask = None if blob is None else _blob(rng, *blob)
        waves = [
            (rng.uniform(0.05, 0.15), rng.normal(0, 0.04), rng.normal(0, 0.04), rng.uniform(0, 6.28)) for _ in range(2)
        ]
        return Layer(texture, plane, mask, waves)

    return [layer(1.0, 1.7, 0.003, (0.8, 1.5)), layer(-0.2, 0.4, 0.003, (0.3, 1.0)), layer(-1.7, -1.0, 0.004, None)]


def _blob(rng: np.random.Generator, low: float, high: float) -> Mask:
    waves = [(rng.normal(0, 0.05), rng.normal(0, 0.05), rng.uniform(0, 6.28), rng.uniform(0.5, 1)) for _ in range(5)]
    level = rng.uniform(low, high)
    return lambda y, x: np.asarray(sum(a * np.sin(p * y + q * x + phase) for p, q, phase, a in waves) > level)


KINDS = {"planes": planes, "holes": holes, "warped": warped}


def gains(name: str) -> list[float]:
    """PSNR of the copied sum image in dB, then the gains of linear, mixture, layers, and layers that are known."""
    kind, seed = name.split(":")
    layers, asked = KINDS[kind](int(seed)), request(rows=SIZE, cols=SIZE, mode="raw")
    steps = np.arange(VIEWS) - (VIEWS - 1) / 2
    seen = [[view(layers, dv, du) for du in steps] for dv in steps]
    field = np.array([[light for light, _ in row] for row in seen])
    image, disparity = seen[VIEWS // 2][VIEWS // 2]
    scene = Scene(name, VIEWS, field, image, disparity, render=lambda mask: lambda dv, du: view(layers, dv, du))
    views = Views((Region(CAPTURE, np.ones(scene.shape, bool)),), CAPTURE, None)
    result = read_golden(asked, expose(asked, scene, plan(scene, asked.sensor, asked.frame), views=views))
    prior, pair, corners = prior_of(result), sent_pair(result)[0], reached(result)
    estimator, truth = estimator_of(result, prior), field * corners
    mixture = estimator.mixture(pair)
    fields = {
        "linear": estimator.linear(pair),
        "mixture": mixture.light_field,
        "layers": layered(mixture, result.sensor, estimator.pupil, prior.noise, pair),
        "known": known(layers, result.sensor, pair_of(result, result.decoded.samples), mixture.light_field),
    }
    copied = psnr_db(np.broadcast_to(result.image, truth.shape) * corners, truth)
    assert copied is not None
    return [copied, *((psnr_db(values * corners, truth) or np.inf) - copied for values in fields.values())]


def known(layers: Sequence[Layer], sensor: SensorParameters, pair: Floats, start: Floats) -> Floats:
    """The light field of the true surfaces and masks, its textures from the samples: an oracle."""
    margin, pupil = 10, 7
    operator = CaptureOperator(replace(sensor, optics=replace(sensor.optics, views=pupil)), "float32")
    size = SIZE + 2 * margin
    y, x = np.indices((size, size), float) - margin
    surfaces = [layer.disparity(y, x).astype(np.float32) for layer in layers]
    fine = np.meshgrid(*[(np.arange(size * FINE) + 0.5) / FINE - 0.5 - margin] * 2, indexing="ij")
    covers = [layer.mask(*fine) for layer in layers if layer.mask is not None]
    masks = [cover.reshape(size, FINE, size, FINE).mean((1, 3)).astype(np.float32) for cover in covers]
    steps = (np.arange(pupil) - (pupil - 1) / 2) * VIEWS / pupil
    stack, shown = Stack(surfaces, steps, margin), Stack(surfaces, np.arange(VIEWS) - 2.0, margin)
    middle = np.pad(start[VIEWS // 2, VIEWS // 2], margin, mode="edge")
    textures = np.stack([middle] * len(layers)).astype(np.float32)
    for _ in range(6):
        textures = fit_textures(stack, operator, pair.astype(np.float32), masks, textures, 0.003)
    return shown.field(textures, shown.seen(masks))


if __name__ == "__main__":
    for scene_name in sys.argv[1:]:
        free, *gained = gains(scene_name)
        print(f"| `{scene_name}` | {free:.1f} dB |", " | ".join(f"{gain:.1f}" for gain in gained), "|", flush=True)

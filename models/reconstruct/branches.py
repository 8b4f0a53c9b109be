"""The two-branch network of the thesis, smaller: from samples to a light field, by NumPy [Jayasuriya2017, Sec. 3.7].

One branch is an autoencoder of fully connected layers on patches of 9 x 9 pixels and two 4-D convolutions, the other
five 4-D convolutions on Phi' i; their mean is what is added to the sum image. The weights are files:
each branch was trained alone first, then both together.
"""

from collections.abc import Mapping
from functools import cache, cached_property
from itertools import pairwise
from pathlib import Path
from typing import Self

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from talbot.models.parameters import ParameterError, SensorParameters
from talbot.models.pixel.weights import view_weights

Floats = npt.NDArray[np.floating]
WEIGHTS = Path(__file__).with_name("branches.npz")
VIEWS = 5  # of the light fields that it was trained with
NOISE = 0.006, 0.2  # of white: range of the training; the input for the noise is 0 at the lower end
STRIP = 16  # rows of a matrix product: the copy of the pixels' neighbours stays in the cache
PATCH = 9  # px, as the thesis's
DENSE = (2 * PATCH**2 + 1, 200, 100, 200, 100, 200, PATCH**2 * VIEWS**2)  # widths; the thesis has 4050 and 2025
AFTER = (1, 8, 1)  # channels of the convolutions behind
CHANNELS = (3, 8, 8, 8, 8, 1)  # of the other branch; the thesis has 32 and 16
KINDS = "autoencoder", "convolutions", "both"
STRETCH = 4.0  # of the differences that the autoencoder sees: they are smaller than the sums
UNLIKE = 0.2  # greatest rms of what other optics weigh the views with, relative to those of the training


def shapes() -> dict[str, tuple[int, ...]]:
    """List the weights of a network, of one kind or both.

    Returns shape by name: dense layers (out, in), convolutions (out, in, 3, 3, 3, 3) over view and pixel, biases
    (out,).
    """
    out: dict[str, tuple[int, ...]] = {}
    for name, widths, kernel in (("dense", DENSE, ()), ("after", AFTER, (3,) * 4), ("conv", CHANNELS, (3,) * 4)):
        for number, (inside, outside) in enumerate(pairwise(widths)):
            out[f"{name}_{number}"] = outside, inside, *kernel
            out[f"{name}_{number}_bias"] = (outside,)
    return out


class Seen:
    """The input of both branches.

    pair: (2, rows, cols), both diodes of every pixel, 1 = the average diode in a flat white scene; the array begins
        with a tile.
    sensor: tile and optics.
    noise: standard deviation of a sample, 1 = white; outside of `NOISE` its nearer end.
    total, difference: (rows, cols), the sum image, and the differences less a uniform scene's.
    """

    def __init__(self, pair: Floats, sensor: SensorParameters, noise: float) -> None:
        a, b = np.asarray(pair, np.float32)
        kinds = sensor.tile.type_map(*a.shape)
        weights = view_weights(sensor.tile, sensor.optics)
        self._across, self._kinds = (weights[:, 0] - weights[:, 1]) / 2, kinds  # of a light field with the difference
        self.level = float(np.log10(np.clip(noise, *NOISE) / NOISE[0]))
        self.total = (a + b) / 2
        self.difference = (a - b) / 2 - self._across.sum((1, 2)).astype(np.float32)[kinds] * self.total

    @cached_property
    def back(self) -> Floats:
        """The input of the convolutions.

        Returns (3, 5, 5, rows, cols), the sum image in every view, Phi' of the differences, the noise's logarithm.
        """
        across = self._across - self._across.mean((1, 2), keepdims=True)
        across /= np.square(across).sum((1, 2), keepdims=True) + 1e-9
        turned = across.astype(np.float32)[self._kinds].transpose(2, 3, 0, 1) * self.difference
        copied = np.broadcast_to(self.total - 0.5, turned.shape)
        return np.stack([copied, turned, np.full_like(turned, self.level)])

    def patches(self, rows: npt.NDArray[np.int64], cols: npt.NDArray[np.int64]) -> Floats:
        """Take the samples of patches.

        rows, cols: (n,), where they begin. Returns (n * m, 163), sums less the patch's mean, STRETCH times the
        differences, the noise's logarithm.
        """
        both = np.stack([self.total, np.float32(STRETCH) * self.difference])
        windows = sliding_window_view(both, (PATCH, PATCH), (1, 2))[:, rows[:, None], cols]
        flat = windows.transpose(1, 2, 0, 3, 4).reshape(len(rows) * len(cols), 2, -1)
        flat = flat - flat.mean(2, keepdims=True) * np.array([[1], [0]], np.float32)
        return np.concatenate([flat.reshape(len(flat), -1), np.full((len(flat), 1), self.level, np.float32)], 1)


class Branches:
    """The network with its weights.

    weights: ``<kind>/<name>`` of `KINDS` and `shapes`, each branch as it was taught alone and both as they were
        together; ``phi``, the weights of all diodes over the views (types, 2, 5, 5) in the training.
    """

    def __init__(self, weights: Mapping[str, Floats]) -> None:
        self.phi = np.asarray(weights["phi"], np.float32)
        self.layers = {key: np.asarray(value, np.float32) for key, value in weights.items() if "/" in key}
        for key, value in self.layers.items():
            shape = shapes()[key.partition("/")[2]]
            if value.shape != shape:
                raise ParameterError(f"{key} = weights of shape {value.shape}: must be {shape}")

    @classmethod
    @cache
    def shipped(cls) -> Self:
        """Load the weights that are shipped.

        Returns Branches: of `WEIGHTS`.
        """
        with np.load(WEIGHTS) as weights:
            return cls(dict(weights))

    def knows(self, sensor: SensorParameters) -> bool:
        """Return whether it was trained with such a sensor.

        sensor: any one. Returns True for its tile and about its optics, and an array of 9 x 9 pixels or more.
        """
        if min(sensor.shape) < PATCH or sensor.optics.views != VIEWS:
            return False
        other = view_weights(sensor.tile, sensor.optics)
        return other.shape == self.phi.shape and bool(
            np.square(other - self.phi).mean() < UNLIKE**2 * np.square(self.phi).mean()
        )

    def estimate(self, pair: Floats, sensor: SensorParameters, noise: float, kind: str = "both") -> Floats:
        """Light field from samples.

        pair, sensor, noise: as of `Seen`. kind: of `KINDS`. Returns (5, 5, rows, cols), l[v, u, y, x], 1 = white.
        Raises ParameterError for a sensor of another kind or a wrong shape.
        """
        if pair.shape != (2, *sensor.shape):
            raise ParameterError(f"pair shape = {pair.shape}: must be {(2, *sensor.shape)}")
        if not self.knows(sensor):
            raise ParameterError("sensor = another tile, optics or number of views: must be those of the training")
        seen, parts = Seen(pair, sensor, noise), []
        if kind != "convolutions":
            parts.append(self._encoded(pair, sensor, noise, kind))
        if kind != "autoencoder":
            values = seen.back
            for number in range(len(CHANNELS) - 1):
                values = self._convolved(values, f"{kind}/conv_{number}", number < len(CHANNELS) - 2)
            parts.append(values[0])
        return seen.total + sum(parts[1:], parts[0]) / np.float32(len(parts))

    def _encoded(self, pair: Floats, sensor: SensorParameters, noise: float, kind: str) -> Floats:
        """Return the output of the autoencoder and of the convolutions after it, (5, 5, rows, cols)."""
        tile, (rows, cols) = sensor.tile, sensor.shape
        firsts, places = [], []
        for length, period in ((rows, tile.rows), (cols, tile.cols)):
            count = -(-(length - PATCH) // period) + 1
            firsts.append(np.arange(count) * period)
            place = np.arange((count - 1) * period + PATCH)
            places.append(place - np.maximum(-(-(place - length + 1) // period), 0) * period)  # on, a tile before
        seen = Seen(pair[:, places[0][:, None], places[1]], sensor, noise)
        values = seen.patches(*firsts)
        for number in range(len(DENSE) - 1):
            values = values @ self.layers[f"{kind}/dense_{number}"].T + self.layers[f"{kind}/dense_{number}_bias"]
            if number < len(DENSE) - 2:
                np.maximum(values, 0, out=values)
        patches = values.reshape(len(firsts[0]), len(firsts[1]), VIEWS, VIEWS, PATCH, PATCH)
        out = np.zeros((VIEWS, VIEWS, *seen.total.shape), np.float32)
        count = np.zeros(seen.total.shape, np.float32)
        for y, x in np.ndindex(PATCH, PATCH):
            at = firsts[0][:, None] + y, firsts[1] + x
            out[:, :, *at] += patches[..., y, x].transpose(2, 3, 0, 1)
            count[at] += 1
        out = (out / count)[:, :, :rows, :cols]
        return out + self._convolved(self._convolved(out[None], f"{kind}/after_0"), f"{kind}/after_1", False)[0]

    def _convolved(self, values: Floats, name: str, positive: bool = True) -> Floats:
        """Return a 4-D convolution of (channels, 5, 5, rows, cols), and what is negative left out."""
        kernel, bias = self.layers[name], self.layers[f"{name}_bias"][:, None]
        padded = np.pad(values, ((0, 0), *((1, 1),) * 4))
        out = np.empty((len(kernel), *values.shape[1:]), np.float32)
        flat = kernel.reshape(len(kernel), -1)
        for v, u in np.ndindex(*values.shape[1:3]):
            near = sliding_window_view(padded[:, v : v + 3, u : u + 3], (3, 3), (3, 4))
            for top in range(0, values.shape[3], STRIP):
                part = near[:, :, :, top : top + STRIP].transpose(0, 1, 2, 5, 6, 3, 4)
                out[:, v, u, top : top + STRIP] = (flat @ part.reshape(flat.shape[1], -1) + bias).reshape(
                    len(kernel), *part.shape[5:]
                )
        return np.maximum(out, 0, out=out) if positive else out

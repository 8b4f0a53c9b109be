"""A small convolutional network that corrects the Bayes estimates: what a scene is and the prior's planes are not.

It sees the linear estimate, the mixture with its disparity, and the noise, and adds what it has learned to the mixture:
edges where one surface hides another, above all. Its three levels are a U-Net's [Ronneberger2015]. Learned by `talbot
learn`, with PyTorch; here it is a chain of matrix products in NumPy.
"""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Self

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from talbot.models.parameters import ParameterError

from .bayes import Estimate

Floats = npt.NDArray[np.floating]
WEIGHTS = Path(__file__).with_name("network.npz")
VIEWS = 5  # of the light fields that it was taught with
INPUTS = 2 * VIEWS**2 + 4
# Layer -> channels in and out, in their order: two at full, two at half, two at a quarter of the size, and back up
LAYERS: Mapping[str, tuple[int, int]] = {
    "full_1": (INPUTS, 32),
    "full_2": (32, 32),
    "half_1": (32, 48),
    "half_2": (48, 48),
    "quarter_1": (48, 56),
    "quarter_2": (56, 48),
    "half_3": (48, 48),
    "half_4": (48, 32),
    "full_3": (32, 32),
    "full_4": (32, VIEWS**2),
}
STEP = 4  # px: sizes that two halvings divide
STRIP = 16  # rows of a matrix product: its copy of the pixels' surroundings stays in the cache
NOISE = 0.006, 0.2  # of white: the least, at which the input for it is 0, and the most that it was taught with


def features(linear: Floats, mixture: Estimate, noise: float) -> Floats:
    """What the network sees.

    Parameters
    ----------
    linear : array (5, 5, rows, cols)
        Of `FieldEstimator.linear`.
    mixture : Estimate
        Of `FieldEstimator.mixture`.
    noise : float
        Standard deviation of a sample, 1 = white, 1e-5..10; outside of `NOISE` its nearer end.

    Returns
    -------
    float32 (54, rows, cols)
        Views of both without the mean of the mixture's; this mean, disparity, its spread, the noise's logarithm.

    Raises
    ------
    ParameterError
        For another number of views.
    """
    shape = mixture.light_field.shape
    if shape[:2] != (VIEWS, VIEWS) or linear.shape != shape:
        raise ParameterError(f"views = {shape[0]}: must be {VIEWS} for the network, which was taught with these")
    mean = mixture.light_field.mean((0, 1))
    views = [field.reshape(-1, *shape[2:]) - mean for field in (linear, mixture.light_field)]
    level = np.full((1, *shape[2:]), np.log10(np.clip(noise, *NOISE) / NOISE[0]))
    return np.concatenate([*views, mean[None], mixture.disparity[None], mixture.spread[None], level]).astype(np.float32)


class Network:
    """The network with its weights.

    Parameters
    ----------
    weights : mapping of str to array
        Of every layer of `LAYERS`: ``<layer>`` (out, in, 3, 3), and ``<layer>_bias`` (out,).
    """

    def __init__(self, weights: Mapping[str, Floats]) -> None:
        self.layers: dict[str, tuple[Floats, Floats]] = {}
        for name, (inside, out) in LAYERS.items():
            kernel, bias = (np.asarray(weights[key], np.float32) for key in (name, f"{name}_bias"))
            if kernel.shape != (out, inside, 3, 3) or bias.shape != (out,):
                raise ParameterError(f"{name} = weights of shape {kernel.shape}: must be {(out, inside, 3, 3)}")
            self.layers[name] = kernel.reshape(out, -1), bias[:, None]

    @classmethod
    @cache
    def shipped(cls) -> Self:
        """Load the weights that are shipped.

        Returns
        -------
        Network
            Of `WEIGHTS`.
        """
        with np.load(WEIGHTS) as weights:
            return cls(dict(weights))

    def correct(self, linear: Floats, mixture: Estimate, noise: float) -> Floats:
        """Light field that the network makes of both estimates.

        Parameters
        ----------
        linear, mixture, noise
            As of `features`.

        Returns
        -------
        float32 (5, 5, rows, cols)
            l[v, u, y, x], 1 = white.

        Raises
        ------
        ParameterError
            For another number of views.
        """
        seen = features(linear, mixture, noise)
        rows, cols = seen.shape[1:]
        padded = np.pad(seen, ((0, 0), (0, -rows % STEP), (0, -cols % STEP)), mode="edge")
        found = self._forward(padded)[:, :rows, :cols]
        return mixture.light_field + found.reshape(mixture.light_field.shape)

    def _forward(self, seen: Floats) -> Floats:
        """From all inputs to what is added to the views, (25, rows, cols)."""
        full = self._layers(seen, "full_1", "full_2")
        half = self._layers(_halved(full), "half_1", "half_2")
        quarter = self._layers(_halved(half), "quarter_1", "quarter_2")
        half = self._layers(half + _doubled(quarter), "half_3", "half_4")
        return self._layers(full + _doubled(half), "full_3", "full_4")

    def _layers(self, values: Floats, *names: str) -> Floats:
        for name in names:
            kernel, bias = self.layers[name]
            padded = np.pad(values, ((0, 0), (1, 1), (1, 1)))
            values = np.empty((len(bias), *values.shape[1:]), np.float32)
            for top in range(0, values.shape[1], STRIP):
                part = values[:, top : top + STRIP]
                near = sliding_window_view(padded[:, top : top + part.shape[1] + 2], (3, 3), (1, 2))
                near = near.transpose(0, 3, 4, 1, 2).reshape(kernel.shape[1], -1)
                part[:] = (kernel @ near + bias).reshape(part.shape)
            if name != "full_4":
                np.maximum(values, 0, out=values)
        return values


def _halved(values: Floats) -> Floats:
    """Means of 2 x 2 pixels."""
    channels, rows, cols = values.shape
    return values.reshape(channels, rows // 2, 2, cols // 2, 2).mean((2, 4))


def _doubled(values: Floats) -> Floats:
    return values.repeat(2, 1).repeat(2, 2)

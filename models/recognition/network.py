"""Small convolutional networks in NumPy: layers, training by Adam, files of at most 100 kB.

Arrays are float32 (pictures, height, width, channels). A network is a list of layers; each keeps what its gradient
needs. [LeCun1998] has the layout of `lenet`; with the first layer in the optics the list begins behind it.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError, check_int

Floats = npt.NDArray[np.float32]
BATCH = 64
RATE = 4e-3  # peak of the learning rate
RISE = 0.25  # of the steps, until that peak
DECAY = 0.02  # of the weights, decoupled from the gradient
MOMENTS = 0.9, 0.99
EPSILON = 1e-8
CHUNK = 500  # pictures of one inference
SMALLEST = 4  # px, for a lenet
LARGE = 20  # px: pictures of this size and more are pooled ahead of the second layer


class Layer(ABC):
    """A layer; by default without weights, and of the shape of its input."""

    weights: tuple[Floats, ...] = ()
    gradients: tuple[Floats, ...] = ()
    fixed = False  # its weights stay as they are drawn
    binary = False  # its weights are signs, and a factor an output

    def _factors(self) -> Floats:
        """Weights as they multiply: of a binary layer signs times their mean magnitude [Rastegari2016, Eq. 6]."""
        w = self.weights[0]
        return np.sign(w) * np.abs(w).mean(0) if self.binary else w

    def _start(self, shape: tuple[int, ...], rng: np.random.Generator) -> tuple[int, ...]:
        """Draw the weights for a picture of this shape at the input; return its shape at the output."""
        return shape

    @abstractmethod
    def _forward(self, x: Floats, rng: np.random.Generator | None) -> Floats:
        """Compute the output (n, ...) of an input (n, ...); rng: for random parts in training, else None."""

    @abstractmethod
    def _backward(self, g: Floats) -> Floats:
        """Return the loss's gradient by the input of the last `_forward` from that by its output."""

    def _products(self, shape: tuple[int, ...]) -> int:
        """Count the multiply-accumulate operations of a picture of this shape ([Jayasuriya2017], Table 6.2: FLOPS)."""
        return 0


@dataclass(eq=False)
class Signs(Layer):
    """ReLU of x and of -x, one behind the other in the channels: an edge's two polarities both pass."""

    def _start(self, shape: tuple[int, ...], rng: np.random.Generator) -> tuple[int, ...]:
        """Double the channels; see `Layer._start`."""
        return (*shape[:-1], 2 * shape[-1])

    def _forward(self, x: Floats, rng: np.random.Generator | None) -> Floats:
        """Rectify both signs; see `Layer._forward`."""
        both = np.concatenate([x, -x], -1)
        self._on = both > 0
        return both * self._on

    def _backward(self, g: Floats) -> Floats:
        """See `Layer._backward`."""
        g = g * self._on
        half = g.shape[-1] // 2
        return g[..., :half] - g[..., half:]


@dataclass(eq=False)
class Relu(Layer):
    """The positive part."""

    def _forward(self, x: Floats, rng: np.random.Generator | None) -> Floats:
        """Rectify; see `Layer._forward`."""
        self._on = x > 0
        return x * self._on

    def _backward(self, g: Floats) -> Floats:
        """See `Layer._backward`."""
        return g * self._on


@dataclass(eq=False)
class Pool(Layer):
    """Maximum of 2 x 2; an odd last row or column is dropped."""

    def _start(self, shape: tuple[int, ...], rng: np.random.Generator) -> tuple[int, ...]:
        """Halve height and width; see `Layer._start`."""
        return shape[0] // 2, shape[1] // 2, shape[2]

    def _forward(self, x: Floats, rng: np.random.Generator | None) -> Floats:
        """Take the maxima; see `Layer._forward`."""
        n, height, width, channels = self._shape = x.shape
        height, width = height // 2, width // 2
        cells = x[:, : 2 * height, : 2 * width].reshape(n, height, 2, width, 2, channels)
        top = cells.max((2, 4))
        if rng is not None:
            equal = cells == top[:, :, None, :, None]
            self._share = equal / equal.sum((2, 4), keepdims=True, dtype=np.float32)
        return top

    def _backward(self, g: Floats) -> Floats:
        """See `Layer._backward`; equal maxima share."""
        n, height, width, channels = self._shape
        out = np.zeros(self._shape, np.float32)
        spread = g[:, :, None, :, None] * self._share
        out[:, : height // 2 * 2, : width // 2 * 2] = spread.reshape(n, height // 2 * 2, width // 2 * 2, channels)
        return out


@dataclass(eq=False)
class Drop(Layer):
    """Dropout: in training a share of the inputs is 0."""

    share: float = 0.3

    def _forward(self, x: Floats, rng: np.random.Generator | None) -> Floats:
        """Drop some; see `Layer._forward`."""
        if rng is None:
            return x
        self._keep = (rng.random(x.shape, np.float32) >= self.share) * np.float32(1 / (1 - self.share))
        return x * self._keep

    def _backward(self, g: Floats) -> Floats:
        """See `Layer._backward`."""
        return g * self._keep


@dataclass(eq=False)
class Dense(Layer):
    """Fully connected. outputs: how many. binary: its weights are signs, and a factor an output."""

    outputs: int = 10
    binary: bool = False

    def _start(self, shape: tuple[int, ...], rng: np.random.Generator) -> tuple[int, ...]:
        """Draw by the inputs' number [He2015]; see `Layer._start`."""
        inputs = int(np.prod(shape))
        self.weights = (_drawn(rng, (inputs, self.outputs), inputs), np.zeros(self.outputs, np.float32))
        return (self.outputs,)

    def _forward(self, x: Floats, rng: np.random.Generator | None) -> Floats:
        """Multiply; see `Layer._forward`."""
        self._shape, self._x = x.shape, x.reshape(len(x), -1)
        return self._x @ self._factors() + self.weights[1]

    def _backward(self, g: Floats) -> Floats:
        """See `Layer._backward`; the gradient of a binary layer passes its signs unchanged."""
        self.gradients = self._x.T @ g, g.sum(0)
        return (g @ self._factors().T).reshape(self._shape)

    def _products(self, shape: tuple[int, ...]) -> int:
        """See `Layer._products`."""
        return int(np.prod(shape)) * self.outputs


@dataclass(eq=False)
class Conv(Layer):
    """Convolution of size x size, as large as its input (zeros around), or without a border.

    fixed: its weights stay as they are drawn. binary: as of `Dense`.
    """

    filters: int = 12
    size: int = 5
    same: bool = True
    fixed: bool = False
    binary: bool = False
    first: bool = field(default=False, init=False)  # nothing ahead of it takes a gradient

    def _start(self, shape: tuple[int, ...], rng: np.random.Generator) -> tuple[int, ...]:
        """Draw by the inputs' number [He2015]; see `Layer._start`."""
        height, width, channels = shape
        inputs = channels * self.size**2
        self.weights = (_drawn(rng, (inputs, self.filters), inputs), np.zeros(self.filters, np.float32))
        lost = 0 if self.same else self.size - 1
        return height - lost, width - lost, self.filters

    def _forward(self, x: Floats, rng: np.random.Generator | None) -> Floats:
        """Correlate; see `Layer._forward`."""
        half = self.size // 2 if self.same else 0
        x = np.pad(x, ((0, 0), (half, half), (half, half), (0, 0))) if half else x
        self._padded = x.shape
        patches = np.lib.stride_tricks.sliding_window_view(x, (self.size, self.size), (1, 2))
        n, height, width = patches.shape[:3]
        self._patches = patches.transpose(0, 1, 2, 4, 5, 3).reshape(n * height * width, -1)
        return (self._patches @ self._factors() + self.weights[1]).reshape(n, height, width, self.filters)

    def _backward(self, g: Floats) -> Floats:
        """See `Layer._backward`."""
        n, height, width, filters = g.shape
        flat = g.reshape(-1, filters)
        self.gradients = self._patches.T @ flat, flat.sum(0)
        if self.first:
            return g
        k, out = self.size, np.zeros(self._padded, np.float32)
        back = (flat @ self._factors().T).reshape(n, height, width, k, k, -1)
        for y in range(k):
            for x in range(k):
                out[:, y : y + height, x : x + width] += back[:, :, :, y, x]
        return out[:, k // 2 : k // 2 + height, k // 2 : k // 2 + width] if self.same else out

    def _products(self, shape: tuple[int, ...]) -> int:
        """See `Layer._products`."""
        lost = 0 if self.same else self.size - 1
        return (shape[0] - lost) * (shape[1] - lost) * self.size**2 * shape[2] * self.filters


def _drawn(rng: np.random.Generator, shape: tuple[int, int], inputs: int) -> Floats:
    return rng.standard_normal(shape, np.float32) * np.float32(np.sqrt(2 / inputs))


def lenet(size: int, classes: int, first: Sequence[Layer] = (), binary: bool = False) -> list[Layer]:
    """Lay a network out behind a first layer, which the optics or ``first`` computes.

    size: height of the pictures in px, 4 or more; from `LARGE` on they are pooled at the start, as LeNet's are.
    classes: outputs, 2 or more. first: the first layer, where the optics has none. binary: the weights of the
    layers between the first and the last are signs. Returns list of Layer: both signs of the first layer rectified, a
    convolution, pooling, two dense layers.
    """
    check_int("size", size, SMALLEST, 1 << 12)
    check_int("classes", classes, 2, 1 << 12)
    large = [Pool(), Conv(32, 5, same=False, binary=binary)]
    head = large if size >= LARGE else [Conv(24, 3, same=False, binary=binary)]
    tail = [Relu(), Pool(), Drop(0.2), Dense(64, binary), Relu(), Drop(0.2), Dense(classes)]
    return [*first, Signs(), *head, *tail]


class Network:
    """Layers, and the scale of their inputs.

    layers: in their order.
    shape: height, width and channels of a picture.
    seed: of the weights, and of the draws of training.
    """

    def __init__(self, layers: Sequence[Layer], shape: tuple[int, ...], seed: int = 1) -> None:
        self.layers, self.shape, self.rng = list(layers), tuple(shape), np.random.default_rng([seed, 53])
        self.mean, self.scale = np.zeros(shape[-1], np.float32), np.ones(shape[-1], np.float32)
        self.products: list[int] = []
        for layer in self.layers:
            self.products.append(layer._products(shape))
            shape = layer._start(shape, self.rng)
        if isinstance(self.layers[0], Conv):
            self.layers[0].first = True

    @property
    def flops(self) -> int:
        """Multiply-accumulate operations of a picture, all layers."""
        return sum(self.products)

    @property
    def additions(self) -> int:
        """Those of `flops` that are additions: of binary layers."""
        return sum(n for n, layer in zip(self.products, self.layers, strict=True) if layer.binary)

    @property
    def parameters(self) -> int:
        """Number of weights."""
        return sum(w.size for layer in self.layers for w in layer.weights)

    def scores(self, pictures: npt.ArrayLike) -> Floats:
        """Score every class.

        pictures: (n, height, width, channels), of the shape of those that it was trained on. Returns (n, classes), the
        logarithm of a probability, less a constant. Raises ParameterError for pictures of another shape.
        """
        pictures = np.asarray(pictures)
        if pictures.shape[1:] != self.shape:
            raise ParameterError(f"pictures = {pictures.shape}: must be (n, {', '.join(map(str, self.shape))})")
        parts = [self._forward(pictures[i : i + CHUNK], None) for i in range(0, len(pictures), CHUNK)]
        return np.concatenate(parts) if parts else np.zeros((0, 0), np.float32)

    def classify(self, pictures: npt.ArrayLike) -> npt.NDArray[np.intp]:
        """Classify pictures.

        pictures: (n, height, width, channels), as in `scores`. Returns (n,), the class of each.
        """
        return self.scores(pictures).argmax(1)

    def _forward(self, x: npt.NDArray[Any], rng: np.random.Generator | None) -> Floats:
        x = (x.astype(np.float32) - self.mean) * self.scale
        for layer in self.layers:
            x = layer._forward(x, rng)
        return x

    def loss(self, pictures: npt.NDArray[Any], labels: npt.NDArray[np.integer]) -> float:
        """Cross-entropy of a batch, with the gradients left in the layers.

        pictures: (n, height, width, channels), the batch. labels: (n,), their classes. Returns mean, in nats.
        """
        logits = self._forward(pictures, self.rng)
        logits = logits - logits.max(1, keepdims=True)
        odds = np.exp(logits)
        odds /= odds.sum(1, keepdims=True)
        picked = np.arange(len(labels)), labels
        loss = -float(np.log(np.maximum(odds[picked], 1e-30)).mean())
        odds[picked] -= 1
        g = odds / np.float32(len(labels))
        for layer in reversed(self.layers):
            g = layer._backward(g)
        return loss

    def train(
        self,
        pictures: npt.NDArray[Any],
        labels: npt.NDArray[np.integer],
        epochs: int = 20,
        shift: int = 0,
        note: Callable[[int, float], None] = lambda epoch, loss: None,
    ) -> None:
        """Train by Adam with decoupled decay, its rate rising, then falling.

        pictures: (n, height, width, channels), pictures; their mean and RMS, channel by channel, become the scale of
        the input. labels: (n,), classes. epochs: passes over all pictures, 1..1000. shift: px by which batches are
        moved at random, 0..4. note: receives the number of every epoch and its mean loss.
        """
        check_int("epochs", epochs, 1, 1000)
        check_int("shift", shift, 0, 4)
        mean, spread = _moments(pictures)
        self.mean = mean.astype(np.float32)
        self.scale = (1 / np.where(spread > 0, spread, 1)).astype(np.float32)
        learned = [layer for layer in self.layers if layer.weights and not layer.fixed]
        moments = [[(np.zeros_like(w), np.zeros_like(w)) for w in layer.weights] for layer in learned]
        steps = max(len(pictures) // BATCH, 1)
        for epoch in range(epochs):
            order, losses = self.rng.permutation(len(pictures)), []
            for i in range(steps):
                chosen = order[i * BATCH : (i + 1) * BATCH]
                batch = pictures[chosen]
                if shift:
                    batch = np.roll(batch, self.rng.integers(-shift, shift + 1, 2), (1, 2))
                losses.append(self.loss(batch, labels[chosen]))
                number = epoch * steps + i
                rate = RATE * _cycle(number / (epochs * steps))
                for layer, kept in zip(learned, moments, strict=True):
                    _adam(layer, kept, rate, number + 1)
            note(epoch, float(np.mean(losses)))

    def save(self, path: Path | BinaryIO) -> None:
        """Write the weights as float16, and the scale.

        path: an .npz file.
        """
        arrays = [w for layer in self.layers for w in layer.weights]
        named = {f"w{i}": w.astype(np.float16) for i, w in enumerate(arrays)}
        np.savez_compressed(path, allow_pickle=False, mean=self.mean, scale=self.scale, **named)

    def load(self, path: Path) -> None:
        """Read what `save` wrote of a network of the same layers.

        path: the file. Raises ParameterError for another network's.
        """
        with np.load(path) as file:
            arrays = iter([file[f"w{i}"].astype(np.float32) for i in range(len(file.files) - 2)])
            self.mean, self.scale = file["mean"], file["scale"]
        for layer in self.layers:
            new = tuple(next(arrays, np.zeros(0, np.float32)) for _ in layer.weights)
            if any(a.shape != b.shape for a, b in zip(new, layer.weights, strict=True)):
                raise ParameterError(f"weights = {path}: must be of the same layers")
            layer.weights = new


def _moments(pictures: npt.NDArray[Any]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Mean and standard deviation of every channel, without a copy of all pictures as float64."""
    count = pictures[..., 0].size
    parts = range(0, len(pictures), CHUNK)
    mean = np.sum([pictures[i : i + CHUNK].sum((0, 1, 2), dtype=np.float64) for i in parts], 0) / count
    squares = [np.square(pictures[i : i + CHUNK] - mean).sum((0, 1, 2)) for i in parts]
    return mean, np.sqrt(np.sum(squares, 0) / count)


def _cycle(part: float) -> float:
    """Factor of the learning rate at a part of the training, 0..1."""
    if part < RISE:
        return 0.04 + 0.96 * part / RISE
    return 0.5 + 0.5 * float(np.cos(np.pi * (part - RISE) / (1 - RISE)))


def _adam(layer: Layer, moments: list[tuple[Floats, Floats]], rate: float, step: int) -> None:
    """Move the weights of a layer by their gradients, in place [Kingma2015]."""
    first, second = MOMENTS
    for w, g, (m, v) in zip(layer.weights, layer.gradients, moments, strict=True):
        m += (1 - first) * (g - m)
        v += (1 - second) * (g * g - v)
        move = m / (1 - first**step) / (np.sqrt(v / (1 - second**step)) + EPSILON)
        w -= rate * (move + (DECAY * w if w.ndim > 1 else 0))

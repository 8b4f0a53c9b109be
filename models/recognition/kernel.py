"""Classification in closed form: ridge regression of the classes in a Gaussian kernel, no epochs and nothing to tune.

With more pictures than landmarks the regressors are a random subset [RasmussenWilliams2006, Sec. 8.3.1].
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import LinAlgError, solve

from talbot.models.parameters import ParameterError

Floats = npt.NDArray[np.float32]
LANDMARKS = 4000
RIDGE = 3e-3  # of the kernel's value at distance 0
CHUNK = 2000  # pictures at a time
LARGE = 20  # px: channels of this size and more are averaged over 2 x 2


def features(channels: npt.ArrayLike) -> Floats:
    """Prepare the channels of a first layer for the kernel.

    channels: (n, height, width, channels), several: both signs are rectified, and from `LARGE` px on averaged over 2 x
    2. One is taken as it is. Returns (n, features), a row a picture.
    """
    x = np.asarray(channels, np.float32)
    if x.shape[-1] > 1:
        x = np.concatenate([np.maximum(x, 0), np.maximum(-x, 0)], -1)
        if x.shape[1] >= LARGE:
            n, height, width, count = x.shape[0], x.shape[1] // 2, x.shape[2] // 2, x.shape[3]
            x = x[:, : 2 * height, : 2 * width].reshape(n, height, 2, width, 2, count).mean((2, 4))
    return x.reshape(len(x), -1)


@dataclass(frozen=True, eq=False)
class KernelClassifier:
    """A trained classifier.

    landmarks: (m, features), pictures that new ones are compared with.
    weights: (m, classes), of each landmark for each class.
    width: inverse of twice the kernel's variance.
    """

    landmarks: Floats
    weights: npt.NDArray[np.float64]
    width: float

    @property
    def flops(self) -> int:
        """Multiply-accumulate operations of a picture behind its features."""
        return self.landmarks.size + self.weights.size

    def scores(self, x: Floats) -> npt.NDArray[np.float64]:
        """Score every class.

        x: (n, features), as of `features`. Returns (n, classes), near 1 for the class, near 0 for the others. Raises
        ParameterError for features of another number.
        """
        if x.shape[1:] != self.landmarks.shape[1:]:
            raise ParameterError(f"features = {x.shape}: must be (n, {self.landmarks.shape[1]})")
        out = np.empty((len(x), self.weights.shape[1]))
        for i in range(0, len(x), CHUNK):
            out[i : i + CHUNK] = gaussian(x[i : i + CHUNK], self.landmarks, self.width) @ self.weights
        return out

    def classify(self, x: Floats) -> npt.NDArray[np.intp]:
        """Classify pictures.

        x: (n, features), as of `features`. Returns (n,), the class of each.
        """
        return self.scores(x).argmax(1)


def gaussian(x: Floats, y: Floats, width: float) -> npt.NDArray[np.float64]:
    """Gaussian kernel of all pairs.

    x: (n, features), one set. y: (m, features), the other. width: factor of the squared distance. Returns (n, m),
    exp(-width |x - y|**2).
    """
    squares = (x * x).sum(1, dtype=np.float64)[:, None] + (y * y).sum(1, dtype=np.float64) - 2.0 * (x @ y.T)
    return np.exp(-width * np.maximum(squares, 0))


def train(
    x: Floats, labels: npt.NDArray[np.integer], classes: int, seed: int = 1, landmarks: int = LANDMARKS
) -> KernelClassifier:
    """Train a classifier.

    x: (n, features), as of `features`. labels: (n,), 0..classes-1. classes: number of classes, 2 or more. seed: of the
    landmarks' draw. landmarks: at most; all pictures where there are no more. Returns KernelClassifier: of a kernel as
    wide as the pictures differ: the width is 1 / (features variance). Raises ParameterError for no picture.
    """
    return regress(x, np.eye(classes)[labels], seed, landmarks)


def regress(
    x: Floats, targets: npt.NDArray[np.floating], seed: int = 1, landmarks: int = LANDMARKS, ridge: float = RIDGE
) -> KernelClassifier:
    """Learn the targets of pictures.

    x: (n, features), as of `features`. targets: (n, outputs), what `KernelClassifier.scores` is to return. seed,
    landmarks: as of `train`. ridge: of the kernel's value at distance 0. Returns KernelClassifier: as of `train`.
    Raises ParameterError for no picture.
    """
    if not len(x):
        raise ParameterError("pictures = 0: must be 1 or more, to train")
    spread = float(x.var(0, dtype=np.float64).sum())
    width = 1 / spread if spread else 1.0
    if len(x) <= landmarks:
        gram = gaussian(x, x, width) + ridge * np.eye(len(x))
        return KernelClassifier(x, solve(gram, targets, assume_a="pos"), width)
    centres = x[np.sort(np.random.default_rng([seed, 54]).choice(len(x), landmarks, replace=False))]
    gram = ridge * gaussian(centres, centres, width)
    right = np.zeros((landmarks, targets.shape[1]))
    for i in range(0, len(x), CHUNK):
        part = gaussian(x[i : i + CHUNK], centres, width)
        gram += part.T @ part
        right += part.T @ targets[i : i + CHUNK]
    try:
        weights = solve(gram, right, assume_a="pos")
    except LinAlgError:  # two equal landmarks
        weights = np.linalg.lstsq(gram, right)[0]
    return KernelClassifier(centres, np.asarray(weights, np.float64), width)

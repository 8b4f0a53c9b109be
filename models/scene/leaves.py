"""Dead leaves: textured ellipses at random depths that hide one another, never the same twice.

Sizes fall as r**-3, as those of objects in photographs [Lee2001]. Made for learning and for tuning: any number of
scenes with edges, occlusions, fine and coarse texture, and of known disparity.
"""

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit
from talbot.models.scene import camera
from talbot.models.scene.sampling import Sampling
from talbot.models.scene.scene import Scene
from talbot.models.scene.targets import places

Floats = npt.NDArray[np.float64]

NEAR, FAR = 2.2, 4.9  # m of the scene: depths are even in 1/m between
SMALL, LARGE = 8.0, 100.0  # px, radii
COVER = 2.0  # ellipses over a pixel, on average, before a wall at FAR
WAVES = 4  # of the texture of an ellipse
FINE, COARSE = 3.0, 60.0  # px, their lengths
FIELDS = (
    8  # of an ellipse: y, x, disparity, both inverse radii, cosine, sine, level; then its waves' ky, kx, phase, size
)


def leaves(sampling: Sampling, seed: float = 0.0) -> Scene:
    """Dead leaves.

    sampling: array, views and camera. seed: of the scene, a whole number, 0..1e9. Returns Scene: all views, with
    disparity and depth. [Lee2001].
    """
    table = _ellipses(sampling, np.random.default_rng(int(seed)))
    y, x = (place.ravel() for place in places(sampling))

    def _view(dv: float, du: float) -> tuple[Floats, Floats]:
        return _paint(table, y, x, dv, du)

    field = np.array([[_view(dv, du)[0] for du in sampling.steps] for dv in sampling.steps], sampling.dtype)
    image, disparity = _view(0.0, 0.0)
    depth = camera.depth(disparity, sampling)
    return Scene(
        "leaves", sampling.views, field, image.astype(sampling.dtype), disparity, depth, render=lambda mask: _view
    )


def _ellipses(sampling: Sampling, rng: np.random.Generator) -> Floats:
    """Ellipses from the nearest to the farthest, (ellipses, FIELDS + 4 WAVES); the last is the wall."""
    rows, cols = sampling.shape
    ends = (1 / camera.scaled(z, sampling.camera) for z in (FAR, NEAR))
    small, large = SMALL**-2, LARGE**-2
    around = 2 * LARGE  # beyond the array: moved into it in other views
    area = np.pi * 2 * np.log(LARGE / SMALL) / (small - large)
    count = max(int(COVER * (rows + 2 * around) * (cols + 2 * around) / area), 1)
    out = np.empty((count + 1, FIELDS + 4 * WAVES))
    out[:, 0] = rng.uniform(-rows / 2 - around, rows / 2 + around, count + 1)
    out[:, 1] = rng.uniform(-cols / 2 - around, cols / 2 + around, count + 1)
    far, near = ends
    out[:, 2] = camera.disparity(1 / np.sort(rng.uniform(far, near, count + 1))[::-1], sampling)
    radius = (small - rng.random(count + 1) * (small - large)) ** -0.5
    out[:, 3:5] = 1 / (radius[:, None] * rng.uniform(0.6, 1.0, (count + 1, 2)))
    out[-1, 3:5] = 0
    angle = rng.uniform(0, np.pi, count + 1)
    out[:, 5], out[:, 6] = np.cos(angle), np.sin(angle)
    out[:, 7] = rng.uniform(0.15, 0.75, count + 1)
    length = np.exp(rng.uniform(np.log(FINE), np.log(COARSE), (count + 1, WAVES)))
    turn = rng.uniform(0, 2 * np.pi, (2, count + 1, WAVES))
    out[:, FIELDS::4], out[:, FIELDS + 1 :: 4] = (2 * np.pi / length * f(turn[0]) for f in (np.sin, np.cos))
    out[:, FIELDS + 2 :: 4] = turn[1]
    weight = rng.random((count + 1, WAVES)) * length**0.5
    contrast = rng.uniform(0, 0.4, (count + 1, 1)) * (rng.random((count + 1, 1)) > 0.1)  # a tenth has no texture
    out[:, FIELDS + 3 :: 4] = contrast * weight / weight.sum(1, keepdims=True)
    return out


@njit(cache=True)
def _paint(table: Floats, y: Floats, x: Floats, dv: float, du: float) -> tuple[Floats, Floats]:
    """Radiance and disparity of a view, (rows, cols) each."""
    radiance, disparity = np.full((len(y), len(x)), -1.0), np.zeros((len(y), len(x)))
    for leaf in table:
        d, p, q, c, s = leaf[2], leaf[3], leaf[4], leaf[5], leaf[6]
        top, left = leaf[0] - dv * d, leaf[1] - du * d  # of its middle in this view
        first, last, start, stop = 0, len(y), 0, len(x)
        if p > 0:
            high = np.sqrt((s / p) ** 2 + (c / q) ** 2)
            wide = np.sqrt((c / p) ** 2 + (s / q) ** 2)
            first = max(int(np.ceil(top - high - y[0])), 0)
            last = min(int(np.floor(top + high - y[0])) + 1, len(y))
            start = max(int(np.ceil(left - wide - x[0])), 0)
            stop = min(int(np.floor(left + wide - x[0])) + 1, len(x))
        for i in range(first, last):
            b = y[i] - top
            for j in range(start, stop):
                a = x[j] - left
                if radiance[i, j] >= 0 or ((a * c + b * s) * p) ** 2 + ((b * c - a * s) * q) ** 2 > 1:
                    continue
                light = leaf[7]
                for n in range(FIELDS, len(leaf), 4):
                    light += leaf[n + 3] * np.sin(leaf[n] * b + leaf[n + 1] * a + leaf[n + 2])
                radiance[i, j], disparity[i, j] = max(light, 0.0), d
    return radiance, disparity

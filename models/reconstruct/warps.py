"""Pictures at other places, and the transposes: what a place shows, put back to the pixels that it is from."""

from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit
from talbot.models.scene.warp import cubic_weights

Floats = npt.NDArray[np.floating]


@njit(cache=True, nogil=True)
def _inside(place: Any, first: int, last: int) -> tuple[int, Any]:
    """Whole part and rest of a place, which is moved between two pixels first."""
    place = min(max(place, np.float32(first)), np.float32(last))
    whole = min(int(place), last - 1)
    return whole, place - np.float32(whole)


@njit(cache=True, nogil=True)
def gather(picture: Floats, y: Floats, x: Floats, out: Floats) -> None:
    """Interpolate by cubic convolution, places within a pixel of the border moved inside [Keys1981].

    picture: (height, width), 4 pixels or more along each side. y, x: (rows, cols), places, px. out: (rows, cols),
    receives the values there.
    """
    height, width = picture.shape
    for i in range(y.shape[0]):
        for j in range(y.shape[1]):
            a, down = _inside(y[i, j], 1, height - 2)
            b, across = _inside(x[i, j], 1, width - 2)
            wy, wx = cubic_weights(down), cubic_weights(across)
            total = 0.0
            for p in range(4):
                row = picture[a + p - 1]
                total += wy[p] * (wx[0] * row[b - 1] + wx[1] * row[b] + wx[2] * row[b + 1] + wx[3] * row[b + 2])
            out[i, j] = total


@njit(cache=True, nogil=True)
def scatter(picture: Floats, y: Floats, x: Floats, values: Floats) -> None:
    """Add the transpose of `gather` to a picture.

    picture: (height, width), is added to. y, x: (rows, cols), as of `gather`. values: (rows, cols), values there.
    """
    height, width = picture.shape
    for i in range(y.shape[0]):
        for j in range(y.shape[1]):
            a, down = _inside(y[i, j], 1, height - 2)
            b, across = _inside(x[i, j], 1, width - 2)
            wy, wx = cubic_weights(down), cubic_weights(across)
            for p in range(4):
                value = wy[p] * values[i, j]
                for q in range(4):
                    picture[a + p - 1, b + q - 1] += wx[q] * value


@njit(cache=True, nogil=True)
def gather_linear(picture: Floats, y: Floats, x: Floats, out: Floats) -> None:
    """Interpolate linearly, places beyond the border moved to it.

    picture: (height, width), 2 pixels or more along each side. y, x, out: (rows, cols), as of `gather`.
    """
    height, width = picture.shape
    for i in range(y.shape[0]):
        for j in range(y.shape[1]):
            a, down = _inside(y[i, j], 0, height - 1)
            b, across = _inside(x[i, j], 0, width - 1)
            above = picture[a, b] + across * (picture[a, b + 1] - picture[a, b])
            below = picture[a + 1, b] + across * (picture[a + 1, b + 1] - picture[a + 1, b])
            out[i, j] = above + down * (below - above)


@njit(cache=True, nogil=True)
def scatter_linear(picture: Floats, y: Floats, x: Floats, values: Floats) -> None:
    """Add the transpose of `gather_linear` to a picture.

    picture: (height, width), is added to. y, x, values: (rows, cols), as of `scatter`.
    """
    height, width = picture.shape
    for i in range(y.shape[0]):
        for j in range(y.shape[1]):
            a, down = _inside(y[i, j], 0, height - 1)
            b, across = _inside(x[i, j], 0, width - 1)
            below = down * values[i, j]
            above = values[i, j] - below
            picture[a, b] += above - across * above
            picture[a, b + 1] += across * above
            picture[a + 1, b] += below - across * below
            picture[a + 1, b + 1] += across * below

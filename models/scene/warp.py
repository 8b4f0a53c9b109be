"""Views around a picture with disparity: forward warp with a z-buffer, then sub-pixel sampling.

Only the disparity is warped forward (to the nearest pixels, the nearest surface wins). The radiance is then fetched
at the exact sub-pixel position of that surface in the source, so that splatting blurs no surface.
"""

import numpy as np
import numpy.typing as npt

from talbot.models.compiled import njit

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Places = npt.NDArray[np.int64]

FOOTPRINT = 0.75  # px around its target that a pixel claims: surfaces stretched by up to 1.5 get no cracks
NO_SURFACE = -1e30  # no surface
JUMP = 0.25  # px per view step: a larger step between neighbours is a border of two surfaces


@njit(cache=True, nogil=True)
def splat(target: Floats, disparity: Floats, use: Bools, scale: float, offset: float, dv: float, du: float) -> None:
    """Warp a disparity map into a z-buffer; the largest disparity (the nearest surface) wins.

    target: (rows, n), the z-buffer. disparity: (rows, cols), px per view step. use: bool (rows, cols), pixels to warp.
    scale, offset: a pixel of disparity d is ``scale * d + offset`` px further to the right before the step. dv, du:
    view steps.
    """
    rows, cols = target.shape
    for y in range(disparity.shape[0]):
        for x in range(disparity.shape[1]):
            d = disparity[y, x]
            ty, tx = y - dv * d, x + (scale * d + offset) - du * d
            if not use[y, x] or not (-2 < ty < rows + 1 and -2 < tx < cols + 1):
                continue
            top, bottom = max(0, int(np.ceil(ty - FOOTPRINT))), min(rows - 1, int(np.floor(ty + FOOTPRINT)))
            left, right = max(0, int(np.ceil(tx - FOOTPRINT))), min(cols - 1, int(np.floor(tx + FOOTPRINT)))
            if top > bottom or left > right:
                continue
            # A footprint is one or two pixels wide and high. Two loops would take a third longer
            target[top, left] = max(target[top, left], d)
            target[top, right] = max(target[top, right], d)
            target[bottom, left] = max(target[bottom, left], d)
            target[bottom, right] = max(target[bottom, right], d)


@njit(cache=True, nogil=True)
def unmixed(disparity: Floats) -> Bools:
    """Pixels that show one surface alone.

    A pixel of a farther surface that touches a nearer one shows a mixture of both; used, it would draw the outline of
    the nearer one onto the farther.

    disparity: (rows, cols), px per view step. Returns bool (rows, cols): False for such a mixture.
    """
    rows, cols = disparity.shape
    out = np.ones((rows, cols), np.bool_)
    for y in range(rows):
        for x in range(cols):
            for r in range(max(0, y - 1), min(rows, y + 2)):
                for c in range(max(0, x - 1), min(cols, x + 2)):
                    if disparity[r, c] > disparity[y, x] + JUMP:
                        out[y, x] = False
    return out


@njit(cache=True, nogil=True)
def fill_rows(disparity: Floats, hole: Bools) -> None:
    """Fill holes in place with the farther of the nearest known neighbours in the row: the background side.

    A row without any known pixel takes the smallest known disparity of all (0 if none is known).

    disparity: (rows, cols), px per view step. hole: bool (rows, cols), pixels to fill.
    """
    rows, cols = disparity.shape
    lowest = np.inf
    for y in range(rows):
        for x in range(cols):
            if not hole[y, x] and disparity[y, x] < lowest:
                lowest = disparity[y, x]
    if lowest == np.inf:
        lowest = 0.0
    for y in range(rows):
        left = np.inf
        x = 0
        while x < cols:
            if not hole[y, x]:
                left = disparity[y, x]
                x += 1
                continue
            end = x
            while end < cols and hole[y, end]:
                end += 1
            value = min(left, disparity[y, end] if end < cols else np.inf)
            for i in range(x, end):
                disparity[y, i] = lowest if value == np.inf else value
            x = end


@njit(cache=True, nogil=True)
def cubic_weights(t: float) -> tuple[float, float, float, float]:
    """Weights of cubic convolution at -1, 0, 1 and 2.

    t: position, 0..1. Returns tuple of four floats: their sum is 1. [Keys1981], Eq. 15.
    """
    t2, t3 = t * t, t * t * t
    return (-0.5 * t + t2 - 0.5 * t3, 1 - 2.5 * t2 + 1.5 * t3, 0.5 * t + 2 * t2 - 1.5 * t3, -0.5 * t2 + 0.5 * t3)


@njit(cache=True, nogil=True)
def cubic(image: Floats, y: float, x: float) -> float:
    """Interpolate an image by cubic convolution, the border pixels repeated outwards.

    image: (rows, cols), the image. y, x: position in px. Returns float: value there. [Keys1981].
    """
    rows, cols = image.shape
    y, x = min(max(y, 0.0), rows - 1.0), min(max(x, 0.0), cols - 1.0)
    y0, x0 = int(y), int(x)
    wy, wx = cubic_weights(y - y0), cubic_weights(x - x0)
    total = 0.0
    for i in range(4):
        row = image[min(max(y0 + i - 1, 0), rows - 1)]
        total += wy[i] * (
            wx[0] * row[max(x0 - 1, 0)]
            + wx[1] * row[x0]
            + wx[2] * row[min(x0 + 1, cols - 1)]
            + wx[3] * row[min(x0 + 2, cols - 1)]
        )
    return total


@njit(cache=True, nogil=True)
def _taps(place: float, size: int) -> tuple[int, tuple[float, float, float, float]]:
    """First whole place and weights of `cubic` at a place, 0..size - 1."""
    place = min(max(place, 0.0), size - 1.0)
    return int(place), cubic_weights(place - int(place))


@njit(cache=True, nogil=True)
def shift_columns(out: Floats, image: Floats, places: Floats) -> None:
    """Interpolate along the rows of an image as `cubic` does.

    out: (rows, cols), receives the result. image: (rows, n), the image. places: (cols,), column of the image that each
    column of the result shows, px.
    """
    last = image.shape[1] - 1
    at, weight = np.empty((4, places.size), np.int64), np.empty((4, places.size))
    for x in range(places.size):
        first, weights = _taps(float(places[x]), image.shape[1])
        for j in range(4):
            at[j, x], weight[j, x] = min(max(first + j - 1, 0), last), weights[j]
    for y in range(out.shape[0]):
        for x in range(places.size):
            out[y, x] = (
                weight[0, x] * image[y, at[0, x]]
                + weight[1, x] * image[y, at[1, x]]
                + weight[2, x] * image[y, at[2, x]]
                + weight[3, x] * image[y, at[3, x]]
            )


@njit(cache=True, nogil=True)
def shift_rows(out: Floats, image: Floats, places: Floats, rows: Places, high: float) -> None:
    """Interpolate along the columns of an image as `cubic` does, limited as by `fetch`.

    out: (rows, cols), receives the result. image: (n, cols), the image. places: (rows,), row of the image that each row
    of the result shows, px. rows: (m,), rows of the result to compute. high: largest value; the smallest is 0.
    """
    last = image.shape[0] - 1
    for y in rows:
        first, (a, b, c, d) = _taps(float(places[y]), image.shape[0])
        above, at = min(max(first - 1, 0), last), min(max(first, 0), last)
        below, second = min(first + 1, last), min(first + 2, last)
        for x in range(out.shape[1]):
            total = a * image[above, x] + b * image[at, x] + c * image[below, x] + d * image[second, x]
            out[y, x] = min(max(total, 0.0), high)


@njit(cache=True, nogil=True)
def fetch(
    out: Floats, image: Floats, surface: Floats, mask: Bools, dv: float, du: float, right: float, high: float
) -> None:
    """Sample a picture for a view with a known disparity map.

    out: (rows, cols), receives the view where it is wanted and has a surface. image: (rows, cols), the picture.
    surface: (rows, cols), disparity map of the view; NO_SURFACE is no surface. mask: bool (rows, cols), pixels to
    sample. dv, du: from the view to the picture in view steps. right: px to the right in the adjacent picture. high:
    largest value; the smallest is 0.
    """
    for y in range(out.shape[0]):
        for x in range(out.shape[1]):
            d = surface[y, x]
            if mask[y, x] and d > NO_SURFACE:
                out[y, x] = min(max(cubic(image, y + dv * d, x + du * d + right), 0.0), high)


@njit(cache=True, nogil=True)
def claim(surface: Floats, disparity: Floats, last: int, right: float, offset: float) -> Bools:
    """Fill the holes of a view's disparity map in place with the surfaces of another picture.

    surface, disparity: (rows, cols), disparity map of the view, and the other picture's; NO_SURFACE is a hole. last:
    last column of the other picture. right, offset: a pixel of disparity d shows what is ``right * d + offset`` px to
    the right in the other picture. Returns bool (rows, cols): pixels filled.
    """
    out = np.zeros(surface.shape, np.bool_)
    for y in range(surface.shape[0]):
        for x in range(surface.shape[1]):
            d = disparity[y, x]
            if surface[y, x] == NO_SURFACE and d > NO_SURFACE and 0 <= x + right * d + offset <= last:
                surface[y, x], out[y, x] = d, True
    return out


@njit(cache=True, nogil=True)
def background(surface: Floats, mask: Bools, dv: float, du: float) -> Places:
    """Return, for every pixel of the mask without a surface, the nearest pixel on the background side.

    The search runs both ways along the direction of the view's step; the farther of the two surfaces is taken.

    surface: (rows, cols), disparity map of the view; NO_SURFACE is no surface. mask: bool (rows, cols), pixels of
    interest. dv, du: offset of the view in view steps; not both 0. Returns (n, 4): row and column of the pixel, then of
    the one behind it; pixels without any are left out.
    """
    rows, cols = surface.shape
    length = max(abs(dv), abs(du))
    sy, sx = dv / length, du / length
    places = [(0, 0, 0, 0) for _ in range(0)]
    for y in range(rows):
        for x in range(cols):
            if not mask[y, x] or surface[y, x] > NO_SURFACE:
                continue
            best, by, bx = np.inf, y, x
            for sign in (-1, 1):
                i = 1
                while True:
                    r, c = int(np.rint(y + sign * i * sy)), int(np.rint(x + sign * i * sx))
                    if r < 0 or r >= rows or c < 0 or c >= cols:
                        break
                    if surface[r, c] > NO_SURFACE:
                        if surface[r, c] < best:
                            best, by, bx = surface[r, c], r, c
                        break
                    i += 1
            if best < np.inf:
                places.append((y, x, by, bx))
    out = np.empty((len(places), 4), np.int64)
    for i, place in enumerate(places):
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = place
    return out

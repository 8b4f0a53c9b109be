"""Results of all views of a light field: refocused pictures [Jayasuriya2017, Ch. 3], disparity, all in focus.

View (v, u) shows at (y, x) what the middle of the views shows at (y + dv d, x + du d), where dv, du is its place from
the middle in view steps and d the disparity, in px per view step. Views that are 0 everywhere, as in the corners that a
round pupil does not reach, do not count.
"""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.floating]
POOL = 2.0  # px, standard deviation of the weights around a pixel with which its neighbours' differences count
FLAT = 1e-6  # of white squared, per px squared: what rounding leaves of the differences of uniform light


def moved(image: Floats, down: float, right: float) -> Floats:
    """Move a picture.

    image: (rows, cols), the picture. down, right: by how much, px. Returns (rows, cols), linear between pixels,
    constant outside; of the type of ``image``.
    """
    for axis, move in enumerate((down, right)):
        if move:
            last = image.shape[axis] - 1
            place = np.clip(np.arange(last + 1) - move, 0, last)
            low = place.astype(int)
            share = np.expand_dims((place - low).astype(image.dtype), 1 - axis)
            image = image.take(low, axis) * (1 - share) + image.take(np.minimum(low + 1, last), axis) * share
    return image


def refocus(light_field: Floats, disparity: float) -> Floats:
    """Picture of a lens that is focused at a disparity.

    light_field: (view rows, view cols, rows, cols), l[v, u, y, x]. disparity: of what is to be sharp, px per view step.
    Returns (rows, cols), mean of the views; linear between pixels, constant outside.
    """
    views = [moved(view, dv * disparity, du * disparity) for dv, du, view in _rays(light_field)]
    return np.asarray(sum(views[1:], views[0]) / len(views), light_field.dtype)


def disparity_of(light_field: Floats, tried: npt.NDArray[np.float64]) -> tuple[Floats, Floats]:
    """Disparity at which the views agree best, around every pixel of the middle.

    light_field: (view rows, view cols, rows, cols), l[v, u, y, x], two views at least. tried: (disparities,), ascending
    and evenly spaced, 3 at least; between them a parabola tells the best. Returns disparity ((rows, cols), in px per
    view step), spread ((rows, cols), its standard deviation: infinite where the light is uniform, or where an end of
    ``tried`` is the best).
    """
    from scipy.ndimage import gaussian_filter  # it imports for long

    reference = np.asarray(light_field, float).mean((0, 1))
    count = 0
    errors = np.empty((len(tried), *reference.shape))
    for number, disparity in enumerate(tried):
        total, squares, count = np.zeros(reference.shape), np.zeros(reference.shape), 0
        for dv, du, view in _rays(light_field):
            away = moved(view, dv * disparity, du * disparity) - reference
            total += away
            squares += away * away
            count += 1
        errors[number] = gaussian_filter(squares / count - (total / count) ** 2, POOL, mode="nearest")
    best = np.clip(errors.argmin(0), 1, len(tried) - 2)[None]
    before, at, after = (np.take_along_axis(errors, best + step, 0)[0] for step in (-1, 0, 1))
    bend = (before + after) / 2 - at  # of the parabola, per step squared
    curved = np.where(bend > 0, bend, 1)
    offset = np.where(bend > 0, (before - after) / (4 * curved), 0)
    step = float(tried[1] - tried[0])
    least = np.maximum(at - bend * offset**2, 0)
    spread = step * np.sqrt(least / (curved * 4 * np.pi * POOL**2))
    is_curved = (bend > FLAT * step**2) & (np.abs(offset) < 1)
    return tried[best[0]] + step * np.clip(offset, -1, 1), np.where(is_curved, spread, np.inf)


def all_in_focus(light_field: Floats, disparity: Floats) -> Floats:
    """Picture with every pixel refocused at its own disparity.

    light_field: (view rows, view cols, rows, cols), l[v, u, y, x]. disparity: (rows, cols), of the middle, px per view
    step. Returns (rows, cols), mean of the rays that meet in each pixel of the middle; linear between pixels, constant
    outside.
    """
    from scipy.ndimage import map_coordinates  # it imports for long

    y, x = np.indices(disparity.shape, float)
    rays = [
        map_coordinates(view, (y - dv * disparity, x - du * disparity), order=1, mode="nearest")
        for dv, du, view in _rays(light_field)
    ]
    return np.asarray(sum(rays[1:], rays[0]) / len(rays), light_field.dtype)


def _rays(light_field: Floats) -> Iterator[tuple[float, float, Floats]]:
    """Place of every view that counts from the middle, down and across, and the view."""
    lit = np.asarray(light_field.any((2, 3)))
    middle = (np.array(lit.shape) - 1) / 2
    for v, u in np.argwhere(lit if lit.any() else ~lit):
        yield float(v - middle[0]), float(u - middle[1]), light_field[v, u]

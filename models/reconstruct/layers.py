"""A light field as a few surfaces, one before the other, each with a complete texture.

The mixture has one surface a pixel, and fills from its filter what another view shows behind an edge. Here a scene is
layers: a surface of disparity, a texture that goes on behind what covers it, and a mask. Surfaces are planes fitted to
the mixture's disparity, and what the disparity bends from them. Textures and masks are fitted to the samples in turn:
both are linear problems where the other is known. The result counts where it explains the samples to their noise, and
the mixture elsewhere: the samples alone decide.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.ndimage import binary_erosion, distance_transform_edt, gaussian_filter

from talbot.models.capture import CaptureOperator
from talbot.models.parameters import SensorParameters
from talbot.models.reconstruct.bayes import Estimate
from talbot.models.reconstruct.stack import Stack

Floats = npt.NDArray[np.floating]
Bools = npt.NDArray[np.bool_]
MOST = 6  # surfaces
PUPIL = 9  # points along the pupil's diameter, of more that the samples are of
SURE = 0.5  # px per view step, standard deviation of a disparity that tells a surface
NEAR = 0.25  # px per view step, distance from a plane within which a pixel is on it
SHARE = 0.04  # of the reliable pixels that a surface must have
PATCH = 12  # px, half of a side of the window whose disparities propose a plane
PROPOSALS = 200  # planes
STEEP = 0.04  # of a plane, px per view step and px
BEND = 8.0  # px, standard deviation of the weights that smooth a surface's bend
CLEAR = 0.5  # of the prior's noise, which has a floor: that of a frame in good light
SMOOTH = 40.0  # weight of a texture's total variation, of white = 1
CORNER = 0.005  # of white, of a texture's step below which its square counts
EDGE = 2.0  # weight of a mask's outline, per px
SOFT = 0.05  # of a mask's step below which its square counts
CONTRAST = 0.03  # of white, of a step of the middle view along which an outline counts half
ROUNDS = 4  # of textures and masks
TEXTURE_STEPS, MASK_STEPS = 15, 12
AROUND = 4.0  # px, standard deviation of the weights with which residuals count
TRUST = 0.6  # share of the layers where they explain the samples
FIT, MISFIT = 1.0, 1.8  # residual, of the noise, up to which they have it and from which on they have none


class Surfaces(NamedTuple):
    """Surfaces of a scene, the nearest first.

    disparity: (rows + 2 margin, cols + 2 margin), of each, px per view step.
    label: (rows, cols), which one the middle view shows.
    """

    disparity: list[Floats]
    label: npt.NDArray[np.int64]


def layered(estimate: Estimate, sensor: SensorParameters, pupil: int, noise: float, pair: Floats) -> Floats:
    """Light field of layers where they explain the samples, else that of the mixture.

    estimate: of the mixture. sensor: the sensor; its lens counts as telecentric. pupil: points of the pupil at which
    the samples see the scene, along its diameter. noise: standard deviation of a sample as the mixture's prior has it,
    of white = 1. pair: (2, rows, cols), both diodes of every pixel, 1 = the average diode in a flat white scene.
    Returns (views, views, rows, cols), l[v, u, y, x], 1 = white.
    """
    field, views = estimate.light_field, len(estimate.light_field)
    margin = math.ceil(float(np.abs(estimate.disparity).max()) * views / 2) + 4
    surfaces = surfaces_of(estimate.disparity, estimate.spread, margin)
    if views == 1 or not surfaces.disparity:
        return field
    pupil = min(pupil, PUPIL)
    operator = CaptureOperator(replace(sensor, optics=replace(sensor.optics, views=pupil)), "float32")
    stack = Stack(surfaces.disparity, _steps(pupil) * views / pupil, margin)
    samples, sigma = pair.astype(np.float32), CLEAR * noise
    middle = _padded(field[views // 2, views // 2], margin)
    masks, textures = _begin(surfaces, middle, margin)
    steps = np.hypot(*_gradient(np.asarray(gaussian_filter(middle, 0.7), np.float32)))
    outline = (EDGE / (1 + steps / CONTRAST)).astype(np.float32)
    for left in reversed(range(ROUNDS)):
        textures = fit_textures(stack, operator, samples, masks, textures, sigma)
        if left:
            masks = fit_masks(stack, operator, samples, masks, textures, sigma, outline)
    error = (operator.forward(stack.field(textures, stack.seen(masks))) - samples) / sigma
    residual = np.sqrt(gaussian_filter(np.square(error).mean(0), AROUND))
    share = TRUST * np.clip((MISFIT - residual) / (MISFIT - FIT), 0, 1)
    shown = Stack(surfaces.disparity, _steps(views), margin)
    return np.asarray(field + share * (shown.field(textures, shown.seen(masks)) - field), np.float32)


def surfaces_of(disparity: Floats, spread: Floats, margin: int) -> Surfaces:
    """Planes that a share of the reliable disparities is on, bent to follow them.

    disparity, spread: (rows, cols), of the mixture, px per view step. margin: px around the array. Returns None where
    nothing is reliable.
    """
    y, x = np.indices(disparity.shape, float)
    sure = spread <= SURE
    planes = _planes(disparity, sure)
    if not planes:
        return Surfaces([], np.zeros(disparity.shape, np.int64))
    flat = np.stack([a + b * y + c * x for a, b, c in planes])
    label = np.abs(disparity - flat).argmin(0)
    order = np.argsort([-flat[k][label == k].mean() if (label == k).any() else np.inf for k in range(len(planes))])
    flat, label = flat[order], np.argsort(order)[label]
    rows, cols = disparity.shape
    yy, xx = np.indices((rows + 2 * margin, cols + 2 * margin), float) - margin
    out = []
    for k, number in enumerate(order):
        a, b, c = planes[number]
        on = binary_erosion(label == k, iterations=3) & (np.abs(disparity - flat[k]) < 2 * NEAR) & sure
        weight = gaussian_filter(np.pad(on.astype(float), margin), BEND)
        bend = gaussian_filter(np.pad(on * (disparity - flat[k]), margin), BEND) / (weight + 0.05)
        out.append((a + b * yy + c * xx + bend).astype(np.float32))
    inner = (slice(margin, -margin),) * 2
    label = np.stack([np.abs(disparity - surface[inner]) for surface in out]).argmin(0)
    return Surfaces(out, _filled(label, sure))


def _planes(disparity: Floats, sure: Bools) -> list[Floats]:
    """Planes (3,), disparity at (0, 0) and its slopes, by random proposals from small windows; the largest first."""
    y, x = np.indices(disparity.shape, float)
    left, total, planes, rng = sure.copy(), int(sure.sum()), [], np.random.default_rng(0)

    def fit(on: Bools) -> Floats:
        return np.linalg.lstsq(np.stack([np.ones(on.sum()), y[on], x[on]], 1), disparity[on], rcond=None)[0]

    def away(plane: Floats) -> Floats:
        return np.abs(disparity - plane[0] - plane[1] * y - plane[2] * x)

    while len(planes) < MOST and left.sum() > SHARE * total:
        best, most, places = None, SHARE * total, np.argwhere(left)
        for row, col in places[rng.integers(len(places), size=PROPOSALS)]:
            window = slice(max(row - PATCH + 1, 0), row + PATCH), slice(max(col - PATCH + 1, 0), col + PATCH)
            on = np.zeros_like(left)
            on[window] = left[window] & (np.abs(disparity[window] - disparity[row, col]) < 2 * NEAR)
            if on.sum() < 2 * PATCH:
                continue
            plane = fit(on)
            count = int(((away(plane) < NEAR) & left).sum())
            if count > most and np.abs(plane[1:]).max() <= STEEP:
                best, most = plane, count
        if best is None:
            break
        for _ in range(5):
            on = (away(best) < NEAR) & left
            best = fit(on) if on.sum() > 3 else best
        planes.append(best)
        left &= away(best) >= 2 * NEAR
    return planes


def fit_textures(
    stack: Stack, operator: CaptureOperator, samples: Floats, masks: Sequence[Floats], textures: Floats, sigma: float
) -> Floats:
    """Textures that explain the samples behind these masks, of least total variation: conjugate gradients.

    stack: at the operator's views. operator: in float32. samples: (2, rows, cols), of the frame. masks: (rows + 2
    margin, cols + 2 margin), of all surfaces but the farthest, 0..1. textures: (surfaces, rows + 2 margin, cols + 2
    margin), to begin with. sigma: standard deviation of a sample. Returns float32: as ``textures``.
    """
    seen = stack.seen(masks)
    weight = SMOOTH / np.sqrt(sum(np.square(step) for step in _gradient(textures)) + np.float32(CORNER**2))

    def both(values: Floats) -> Floats:
        data = stack.textures(operator.transpose(operator.forward(stack.field(values, seen))), seen)
        return np.asarray(data / sigma**2 + _divergence(*(weight * step for step in _gradient(values))), np.float32)

    residual = stack.textures(operator.transpose(samples), seen) / sigma**2 - both(textures)
    direction, square = residual, float(np.vdot(residual, residual))
    for _ in range(TEXTURE_STEPS):
        if not square:
            break
        image = both(direction)
        step = np.float32(square / float(np.vdot(direction, image)))
        textures = textures + step * direction
        residual = residual - step * image
        before, square = square, float(np.vdot(residual, residual))
        direction = residual + np.float32(square / before) * direction
    return textures


def fit_masks(
    stack: Stack,
    operator: CaptureOperator,
    samples: Floats,
    masks: Sequence[Floats],
    textures: Floats,
    sigma: float,
    outline: Floats,
) -> list[Floats]:
    """Masks with which these textures explain the samples, of short outlines: projected accelerated gradients.

    stack, operator, samples, masks, textures, sigma: as of `fit_textures`. outline: (rows + 2 margin, cols + 2 margin),
    weight of an outline at each place. Returns list of float32: as ``masks``, one surface after the other.
    """
    masks, shown = list(masks), [stack.warped(k, texture) for k, texture in enumerate(textures)]
    for k in range(stack.count - 1):
        parts = [stack.warped(j, mask, linear=True) for j, mask in enumerate(masks)]
        left, front, behind = np.ones_like(shown[0]), np.zeros_like(shown[0]), shown[-1]
        for j in range(k):
            front = front + left * parts[j] * shown[j]
            left = left * (1 - parts[j])
        for j in range(stack.count - 2, k, -1):
            behind = parts[j] * shown[j] + (1 - parts[j]) * behind
        change = left * (shown[k] - behind)
        remainder = samples - operator.forward(front + left * behind)
        masks[k] = _mask(stack, operator, k, masks[k], change, remainder, sigma, outline)
    return masks


def _mask(
    stack: Stack,
    operator: CaptureOperator,
    k: int,
    mask: Floats,
    change: Floats,
    remainder: Floats,
    sigma: float,
    outline: Floats,
) -> Floats:
    """Mask of surface ``k``. change: what it adds to the light field; remainder: of the samples, without it."""

    def back(values: Floats, factor: Floats) -> Floats:
        return stack.back(k, factor * operator.transpose(values), linear=True) / np.float32(sigma**2)

    whole, size = stack.warped(k, np.ones_like(mask), linear=True), np.abs(change)
    bound = back(operator.forward(size * whole), size) + 8 * outline / np.float32(SOFT) + np.float32(1e-3)
    latest, ahead, pace = mask, mask, 1.0
    for _ in range(MASK_STEPS):
        steps = _gradient(ahead)
        weight = outline / np.sqrt(np.square(steps[0]) + np.square(steps[1]) + np.float32(SOFT**2))
        slope = back(operator.forward(change * stack.warped(k, ahead, linear=True)) - remainder, change)
        slope = slope + _divergence(*(weight * step for step in steps))
        after = np.clip(ahead - slope / bound, 0, 1).astype(np.float32)
        faster = (1 + math.sqrt(1 + 4 * pace**2)) / 2
        latest, ahead, pace = after, after + np.float32((pace - 1) / faster) * (after - latest), faster
    return latest


def _begin(surfaces: Surfaces, middle: Floats, margin: int) -> tuple[list[Floats], Floats]:
    """Masks and textures of the labels: what a nearer surface covers is as what is next to it."""
    label, masks, textures = np.pad(surfaces.label, margin, mode="edge"), [], []
    last = len(surfaces.disparity) - 1
    for k in range(last + 1):
        if k < last:
            masks.append((_filled(label, label >= k) == k).astype(np.float32))
        textures.append(_filled(middle, label == k))
    return masks, np.stack(textures).astype(np.float32)


def _filled(values: npt.NDArray[Any], known: Bools) -> npt.NDArray[Any]:
    """Values, where not known those of the nearest pixel that is."""
    if not known.any():
        return values
    nearest = np.asarray(distance_transform_edt(~known, return_distances=False, return_indices=True))
    return values[nearest[0], nearest[1]]


def _steps(views: int) -> npt.NDArray[np.float64]:
    """Places of views along the pupil, in steps of theirs from the middle."""
    return np.arange(views, dtype=float) - (views - 1) / 2


def _padded(picture: Floats, margin: int) -> Floats:
    return np.pad(picture, margin, mode="edge").astype(np.float32)


def _gradient(values: Floats) -> tuple[Floats, Floats]:
    """Steps to the next pixel down and across, 0 at the end."""
    down, across = np.zeros_like(values), np.zeros_like(values)
    down[..., :-1, :] = values[..., 1:, :] - values[..., :-1, :]
    across[..., :-1] = values[..., 1:] - values[..., :-1]
    return down, across


def _divergence(down: Floats, across: Floats) -> Floats:
    """The transpose of `_gradient`."""
    out = np.zeros_like(down)
    out[..., :-1, :] -= down[..., :-1, :]
    out[..., 1:, :] += down[..., :-1, :]
    out[..., :-1] -= across[..., :-1]
    out[..., 1:] += across[..., :-1]
    return out

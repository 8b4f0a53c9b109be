"""Depth fields: light fields of phasors, one of the four taps' light fields each [Jayasuriya2017, Ch. 5].

A tap is a light field behind Phi. Each is given back by itself, with the disparity that all four together show; their
quadrature is then a phasor, albedo exp(i phase), of every ray.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view
from scipy.ndimage import shift
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import splu

from talbot.models.parameters import ParameterError
from talbot.models.pixel.time_of_flight import quadrature
from talbot.models.reconstruct.bayes import Estimate, FieldEstimator

Floats = npt.NDArray[np.floating]
Complexes = npt.NDArray[np.complexfloating]
Bools = npt.NDArray[np.bool_]
SMOOTH = 0.01  # turns: by this much neighbours may differ from what their phases say
FLAT = 0.015  # turns: a larger step is a depth edge, if it is not one of a slope's
BEND = 0.03  # turns by which the steps of a slope differ at most
RUN = 4  # steps of a slope: an edge that defocus smears has fewer
FOLLOWED = 1.0  # weight of neighbours over an edge, 1 / turns**2: what hangs on nothing else follows them
HELD = 0.05  # of the firmest link: a pixel without one as firm is a mixture of two surfaces
ROUNDS = 2  # of weighing again what the solution contradicts
APART = 0.2  # turns by which a solution departs from a step that counts half in power: an edge of whole turns
AWAY = 0.3  # the same from a coarse depth, or its doubt where that is more
SURE = 0.3  # turns from a whole number beyond which the number of turns is not known
IGNORANCE = 1e-3  # weight of no turns, 1 / turns**2: keeps the equation regular where nothing is known
TOLD = 0.9  # of a number of turns must be from the coarse depth
AGREED = 0.3  # mean weight of the coarse depths around a pixel below which they contradict its turns
LOCAL = 0.05  # of the links: the same is a mean over a few pixels
DOUBT_MIN = 0.02  # turns: no disparity is surer
MOVED = 1.5  # standard deviations of four taps' noise: what differs more has moved
BINS = 128  # of the histogram of phases


class DepthField(NamedTuple):
    """A depth field and the disparity of its scene.

    taps: (4, views, views, rows, cols), light field of every tap, 1 = white.
    disparity, spread: (rows, cols), in px per view step, with its standard deviation.
    """

    taps: Floats
    disparity: Floats
    spread: Floats

    @property
    def phasors(self) -> Complexes:
        """Phasor of every ray, albedo exp(i phase), (views, views, rows, cols)."""
        x, y = quadrature(self.taps)
        return x + 1j * y

    @property
    def centre(self) -> Floats:
        """Taps of the centre view, (4, rows, cols)."""
        middle = self.taps.shape[1] // 2
        return self.taps[:, middle, middle]


def depth_field(estimator: FieldEstimator, pairs: Floats) -> DepthField:
    """Depth field from the diodes of four taps.

    estimator: of the sensor. pairs: (4, 2, rows, cols), both diodes of every pixel in every tap, 1 = the average diode
    in a flat white scene. Of three, the tap at 270 degrees is what two opposite taps have in common less the one at 90:
    right where nothing moves (`still`). Returns DepthField: by the mixture, the disparity from the sum of the taps.
    Raises ParameterError for a wrong shape. Source: [Jayasuriya2017], Sec. 5.3.3.
    """
    if len(pairs) not in (3, 4):
        raise ParameterError(f"pairs = {len(pairs)} taps: must be 3 or 4")
    # Both halves of the wave: its mean light, twice what is ambient
    evidence = pairs.sum(0) / 2 if len(pairs) == 4 else pairs[0] + pairs[2]
    estimates = [estimator.mixture(pair, evidence) for pair in pairs]
    first: Estimate = estimates[0]
    taps = [tap.light_field for tap in estimates]
    if len(taps) == 3:
        taps.append(taps[0] + taps[2] - taps[1])
    return DepthField(np.stack(taps), first.disparity, first.spread)


def still(pairs: Floats, noise: float) -> bool:
    """Return whether nothing moves between four taps: opposite ones have the same sum.

    pairs: (4, ...), in order of the taps. noise: standard deviation of a sample, greater than 0. Returns whether the
    sums differ by no more than noise makes them, over all and in the worst hundredth.
    """
    off = np.abs(pairs[0] + pairs[2] - pairs[1] - pairs[3]) / (2 * noise)
    return bool(np.sqrt(np.mean(off**2)) < MOVED and np.quantile(off, 0.99) < 3 * MOVED)


class Unwrapped(NamedTuple):
    """A phase with its turns.

    turns: (rows, cols), phase / 2 pi and the whole turns before it, 0 or more; finite.
    sure: (rows, cols), where the number of whole turns is known.
    """

    turns: Floats
    sure: Bools


def unwrap(phase: Floats, coarse: Floats, doubt: Floats) -> Unwrapped:
    """Whole turns of a phase, from a coarse depth that is nowhere exact and somewhere unknown.

    The smoothest field of turns that follows the phase from pixel to pixel and the coarse depth at large: a screened
    Poisson equation. Neighbours whose phase bends between them do not hold each other: a slope may be steep. A coarse
    depth that is smeared over an edge, and an edge of whole turns, which no phase shows, are what the solution
    contradicts: both count less when it is found again [Geman1987].

    phase: (rows, cols), in rad, modulo 2 pi; NaN where there is none. coarse: (rows, cols), depth in turns, without
    wrap. doubt: (rows, cols), its standard deviation in turns; infinite where it is not known. Returns Unwrapped: where
    there is no phase, the mean of what is around; 0 turns where there is none at all. Source: [Jayasuriya2017], Sec.
    5.6.2, without a manually marked line.
    """
    known = np.isfinite(phase)
    fine = np.where(known, phase, 0) / (2 * np.pi) % 1
    told_by = known & np.isfinite(doubt) & np.isfinite(coarse)
    coarse, doubt = np.where(told_by, coarse, 0), np.where(told_by, doubt, 1)
    trust = told_by / np.maximum(doubt, DOUBT_MIN) ** 2
    steps = [_steps(fine, known, axis) for axis in (0, 1)]
    solve = _followed(steps, trust)
    smooth = solve(coarse)
    for _ in range(ROUNDS):
        away = (smooth - coarse) / np.maximum(doubt, AWAY)
        apart = [(np.diff(smooth, axis=axis) - step) / APART for axis, (step, _) in enumerate(steps)]
        links = [(step, link * _counts(by)) for (step, link), by in zip(steps, apart, strict=True)]
        solve = _followed(links, trust * _counts(away))
        smooth = solve(coarse)
    anchored = solve(np.ones(phase.shape), False)  # 1: all from the coarse depth, here or along the phase
    around = _followed([(step, LOCAL * link) for step, link in steps], trust)
    agreed = around(_counts((smooth - coarse) / np.maximum(doubt, AWAY)), False)
    whole = np.abs(smooth - fine - np.rint(smooth - fine)) < SURE
    sure = known & whole & (anchored > TOLD) & (agreed > AGREED) & _held(steps)
    turns = fine + np.maximum(np.rint(smooth - fine), 0)
    return Unwrapped(np.where(known, turns, np.maximum(smooth, 0) * known.any()), sure)


def _held(steps: Sequence[tuple[Floats, Floats]]) -> Bools:
    """Where a pixel goes on, along both axes, in one of its neighbours: a mixture of two surfaces does in neither."""
    parts = []
    for axis, (_, link) in enumerate(steps):
        firm = np.moveaxis(link > HELD / SMOOTH**2, axis, 0)
        ends = np.full((1, *firm.shape[1:]), not len(firm))  # one pixel alone has no neighbour to differ from
        parts.append(np.moveaxis(np.concatenate([ends, firm]) | np.concatenate([firm, ends]), 0, axis))
    return np.logical_and(*parts)


def _counts(residual: Floats) -> Floats:
    """Weight of a residual, 1 = of its scale, in the next round."""
    return 1 / (1 + residual**2) ** 2


def _steps(fine: Floats, known: Bools, axis: int) -> tuple[Floats, Floats]:
    """Steps of the phase from pixel to pixel along an axis, in turns, and how firmly each links the two."""
    both = np.logical_and(*_pairs(known, axis))
    step = np.where(both, _short(np.diff(fine, axis=axis)), 0)
    run = np.moveaxis(both, axis, 0)
    bend = np.moveaxis(np.abs(step), axis, 0) / FLAT
    lines = np.where(run, np.moveaxis(step, axis, 0), np.inf)
    if len(lines) >= RUN:
        straight = sliding_window_view(lines, RUN, 0)
        with np.errstate(invalid="ignore"):
            spread = np.where(np.isfinite(straight).all(-1), np.ptp(straight, axis=-1), np.inf)
        for start in range(RUN):  # of the straightest run that a step is in
            part = bend[start : start + len(spread)]
            np.minimum(part, spread / BEND, out=part)
    firm = np.moveaxis(run * np.exp(-(bend**2)), 0, axis)
    return step, firm / SMOOTH**2 + FOLLOWED


def _short(turns: Floats) -> Floats:
    """Return the same modulo a turn, in -0.5..0.5."""
    return (turns + 0.5) % 1 - 0.5


def _pairs(values: npt.NDArray[Any], axis: int) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Each pixel that has a next one along an axis, and that."""
    lines = np.moveaxis(values, axis, 0)
    return np.moveaxis(lines[:-1], 0, axis), np.moveaxis(lines[1:], 0, axis)


def _followed(links: Sequence[tuple[Floats, Floats]], trust: Floats) -> Callable[..., Floats]:
    """Function of a coarse depth: what follows ``links``, steps and their weights along both axes, and it.

    Its second argument is False for no steps: a mean along the links.
    """
    size, number = trust.size, np.arange(trust.size).reshape(trust.shape)
    ends = [_pairs(number, axis) for axis in range(len(links))]
    first, last = (np.concatenate([pair[side].ravel() for pair in ends]) for side in (0, 1))
    step, link = (np.concatenate([pair[part].ravel() for pair in links]) for part in (0, 1))
    pull = np.bincount(last, link * step, size) - np.bincount(first, link * step, size)
    held = np.bincount(last, link, size) + np.bincount(first, link, size)
    between = csr_array((np.tile(link, 2), (np.r_[first, last], np.r_[last, first])), (size, size))
    equations = (diags_array(trust.ravel() + held + IGNORANCE) - between).tocsc()
    # Positive definite and symmetric: an order for Cholesky has a third of the fill, and no pivot is needed
    solve = splu(equations, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True}).solve

    def _solved(coarse: Floats, stepped: bool = True) -> Floats:
        return np.reshape(solve((trust * coarse).ravel() + stepped * pull), trust.shape)

    return _solved


def refocused(field: Complexes, disparity: float, rays: Bools | None = None) -> Complexes:
    """Mean phasor of the rays that meet at a disparity: depth through the whole lens, sharp there.

    field: (views, views, rows, cols), phasors. disparity: in px per view step. rays: (views, views, rows, cols), rays
    that count; None is all. Returns (rows, cols), 0 where no ray counts. Source: [Jayasuriya2017], Sec. 5.6.1.
    """
    views = len(field)
    total, count = np.zeros(field.shape[2:], complex), np.zeros(field.shape[2:])
    for v, u in np.ndindex(views, views):
        move = ((v - (views - 1) / 2) * disparity, (u - (views - 1) / 2) * disparity)
        weight = np.ones(field.shape[2:]) if rays is None else rays[v, u].astype(float)
        for part, factor in ((field[v, u].real, 1), (field[v, u].imag, 1j)):
            total += factor * shift(part * weight, move, order=1, mode="constant")
        count += shift(weight, move, order=1, mode="constant")
    return np.where(count > 0, total / np.where(count > 0, count, 1), 0)


def foreground(field: DepthField, coarse: Floats) -> Bools | None:
    """Rays of the nearer of two clusters of phase.

    The edges between an occluder and what is behind it move with the occluder, and are most of what the disparity is
    from: the nearer cluster is the one whose phases agree with it.

    field: the depth field. coarse: (rows, cols), depth by disparity in turns. Returns (views, views, rows, cols), None
    where the phases are of one cluster alone. Source: [Jayasuriya2017], Sec. 5.6.3.
    """
    phasors = field.phasors
    strength = np.abs(phasors)
    if not strength.any():
        return None
    # The two arcs of the circle whose phasors agree most among themselves, of all that the histogram's bins allow
    bins = np.floor(np.angle(phasors) / (2 * np.pi) * BINS).astype(int) % BINS
    sums = [np.bincount(bins.ravel(), part.ravel(), BINS) for part in (phasors.real, phasors.imag)]
    ends = np.concatenate([[0], np.cumsum(sums[0] + 1j * sums[1])])
    arcs = ends - ends[:, None]
    best = np.argmax(np.triu(np.abs(arcs) + np.abs(ends[-1] - arcs)))
    first, last = np.unravel_index(best, arcs.shape)
    second = (bins >= first) & (bins < last)
    middle = len(phasors) // 2
    here = second[middle, middle]
    if here.all() or not here.any():
        return None
    agree = (phasors[middle, middle] * np.exp(-2j * np.pi * coarse)).real / np.maximum(strength[middle, middle], 1e-12)
    return second if agree[here].mean() > agree[~here].mean() else ~second

"""Depth fields: light fields of phasors, one of the four taps' light fields each [Jayasuriya2017, Ch. 5].

A tap is a light field behind Phi. Each is given back by itself, with the disparity that all four together show; their
quadrature is then a phasor, albedo exp(i phase), of every ray.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.ndimage import shift
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import splu

from talbot.models.parameters import ParameterError
from talbot.models.pixel.time_of_flight import quadrature

from .bayes import Estimate, FieldEstimator

Floats = npt.NDArray[np.floating]
Complexes = npt.NDArray[np.complexfloating]
Bools = npt.NDArray[np.bool_]
SMOOTH = 0.01  # turns: by this much neighbours may differ from what their phases say
JUMP = 0.03  # turns between neighbours beyond which a depth edge is between them
SURE = 0.3  # turns from a whole number beyond which the number of turns is not known
IGNORANCE = 1e-3  # weight of no turns, 1 / turns**2: keeps the equation regular where nothing is known
TOLD = 0.9  # of a number of turns must be from the coarse depth
DOUBT_MIN = 0.02  # turns: no disparity is surer
BINS = 128  # of the histogram of phases


class DepthField(NamedTuple):
    """A depth field and the disparity of its scene.

    Attributes
    ----------
    taps : float32 (4, views, views, rows, cols)
        Light field of every tap, 1 = white.
    disparity, spread : float32 (rows, cols)
        In px per view step, with its standard deviation.
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

    Parameters
    ----------
    estimator : FieldEstimator
        Of the sensor.
    pairs : array (4, 2, rows, cols)
        Both diodes of every pixel in every tap, 1 = the average diode in a flat white scene.

    Returns
    -------
    DepthField
        By the mixture, the disparity from the sum of the taps.

    Raises
    ------
    ParameterError
        For a wrong shape.

    References
    ----------
    [Jayasuriya2017], Sec. 5.3.3.
    """
    if len(pairs) != 4:
        raise ParameterError(f"pairs = {len(pairs)} taps: must be 4")
    evidence = pairs.sum(0) / 2  # both halves of the wave: its mean light, twice what is ambient
    found = [estimator.mixture(pair, evidence) for pair in pairs]
    first: Estimate = found[0]
    return DepthField(np.stack([tap.light_field for tap in found]), first.disparity, first.spread)


class Unwrapped(NamedTuple):
    """A phase with its turns.

    Attributes
    ----------
    turns : float64 (rows, cols)
        Phase / 2 pi and the whole turns before it, 0 or more; finite.
    sure : bool (rows, cols)
        Where the number of whole turns is known.
    """

    turns: Floats
    sure: Bools


def unwrap(phase: Floats, coarse: Floats, doubt: Floats) -> Unwrapped:
    """Whole turns of a phase, from a coarse depth that is nowhere exact and somewhere unknown.

    The smoothest field of turns that follows the phase from pixel to pixel and the coarse depth at large: a screened
    Poisson equation. Neighbours whose phases jump do not hold each other.

    Parameters
    ----------
    phase : array (rows, cols)
        In rad, modulo 2 pi; NaN where there is none.
    coarse : array (rows, cols)
        Depth in turns, without wrap.
    doubt : array (rows, cols)
        Its standard deviation in turns; infinite where it is not known.

    Returns
    -------
    Unwrapped
        0 turns where there is no phase.

    References
    ----------
    [Jayasuriya2017], Sec. 5.6.2, without a line that is marked by hand.
    """
    known = np.isfinite(phase)
    fine = np.where(known, phase, 0) / (2 * np.pi) % 1
    trust = np.where(known & np.isfinite(doubt), 1 / np.maximum(doubt, DOUBT_MIN) ** 2, 0)
    number = np.arange(phase.size).reshape(phase.shape)
    parts = []
    for axis in (0, 1):
        first, last = (np.take(number, np.arange(*ends), axis).ravel() for ends in _ends(phase.shape[axis]))
        step = (fine.ravel()[last] - fine.ravel()[first] + 0.5) % 1 - 0.5
        link = known.ravel()[first] * known.ravel()[last] * np.exp(-((step / JUMP) ** 2)) / SMOOTH**2
        parts.append((first, last, link, step))
    first, last, link, step = (np.concatenate(part) for part in zip(*parts, strict=True))
    size = phase.size
    pull = np.bincount(last, link * step, size) - np.bincount(first, link * step, size)
    held = np.bincount(last, link, size) + np.bincount(first, link, size)
    between = csr_array((np.tile(link, 2), (np.r_[first, last], np.r_[last, first])), (size, size))
    solve = splu((diags_array(trust.ravel() + held + IGNORANCE) - between).tocsc()).solve
    smooth = np.reshape(solve((trust * np.where(np.isfinite(coarse), coarse, 0)).ravel() + pull), phase.shape)
    told = np.reshape(solve(trust.ravel()), phase.shape)  # 1: all from the coarse depth, here or along the phase
    sure = known & (told > TOLD) & (np.abs(smooth - fine - np.rint(smooth - fine)) < SURE)
    whole = np.maximum(np.rint(smooth - fine), 0)
    return Unwrapped(np.where(known, fine + whole, 0), sure)


def _ends(length: int) -> tuple[tuple[int, int], tuple[int, int]]:
    return (0, length - 1), (1, length)


def refocused(field: Complexes, disparity: float, rays: Bools | None = None) -> Complexes:
    """Mean phasor of the rays that meet at a disparity: depth through the whole lens, sharp there.

    Parameters
    ----------
    field : complex (views, views, rows, cols)
        Phasors.
    disparity : float
        In px per view step.
    rays : bool (views, views, rows, cols), optional
        Rays that count; None is all.

    Returns
    -------
    complex (rows, cols)
        0 where no ray counts.

    References
    ----------
    [Jayasuriya2017], Sec. 5.6.1.
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

    Parameters
    ----------
    field : DepthField
        The depth field.
    coarse : array (rows, cols)
        Depth by disparity in turns.

    Returns
    -------
    bool (views, views, rows, cols) or None
        None where the phases are of one cluster alone.

    References
    ----------
    [Jayasuriya2017], Sec. 5.6.3.
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

"""A light field from samples: the most likely one for any disparity, or with each window's own disparity.

For every disparity, samples and light field of a window are Gaussian, with the covariances of `covariance`. The linear
estimate is the best one where the disparity may be any. How well the samples of a window fit to each disparity is the
evidence for it; the mixture is the mean of the estimates, each as probable as its disparity [Levin2008].
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view
from scipy.ndimage import maximum_filter
from threadpoolctl import threadpool_limits

from talbot.models.parameters import ParameterError, SensorParameters
from talbot.models.pixel.weights import view_weights

from .covariance import Covariances, Tables
from .evidence import REACH, Residuals, badness, pooled, probability, whitener
from .prior import FieldPrior
from .scene import Ways, shares_of
from .windows import Axis, Group, even

Floats = npt.NDArray[np.floating]
Ints = npt.NDArray[np.int64]
Windows = Sequence[tuple[Group, Group, Floats]]  # (samples, windows) of every group
# What differs between the views, times its mean over what is not known, which shrinks it: by leaves and a tilted plane
LINEAR, MIXTURE = 1.15, 1.06
LOST = 0.5  # probability of no one disparity, from which on it is not known
UNLIKELY = 1e-3  # probability below which a disparity is left out of a mixture


class Estimate(NamedTuple):
    """What a frame shows, by the mixture.

    Attributes
    ----------
    light_field : float32 (views, views, rows, cols)
        l[v, u, y, x], 1 = white.
    disparity : float32 (rows, cols)
        Mean of the disparity's probability, px per view step.
    spread : float32 (rows, cols)
        Its standard deviation: 0 is certain.
    plain : float
        Share of the windows, 0..1, that show no more than noise on a uniform scene: they take the linear estimate.
    """

    light_field: Floats
    disparity: Floats
    spread: Floats
    plain: float = 0.0


class FieldEstimator:
    """Estimates light fields from frames of one sensor.

    Parameters
    ----------
    sensor : SensorParameters
        The sensor; its lens counts as telecentric.
    views : int
        Of the light field along the pupil's diameter.
    prior : FieldPrior
        What is known before.
    pupil : int, optional
        Points of the pupil at which the samples are taken to see the scene, along its diameter; None is as the views.
    measured : bool (types,), optional
        Pixel types that are read; None is all.
    """

    def __init__(
        self,
        sensor: SensorParameters,
        views: int,
        prior: FieldPrior = FieldPrior(),
        pupil: int | None = None,
        measured: npt.NDArray[np.bool_] | None = None,
    ) -> None:
        tile = sensor.tile
        self.prior, self.views, self.shape, self.tile = prior, views, sensor.shape, tile
        self.y, self.x = (Axis.of(*ends, prior.margin) for ends in zip(sensor.shape, (tile.rows, tile.cols)))
        weights = view_weights(tile, replace(sensor.optics, views=pupil or views))
        self.measured = np.ones(tile.n_types, bool) if measured is None else np.asarray(measured, bool)
        if not self.measured.any():
            raise ParameterError("measured = no pixel type: must be at least one")
        weights = np.stack([weights[:, 0] + weights[:, 1], weights[:, 0] - weights[:, 1]], 1) / np.sqrt(2)
        weights = weights.reshape(-1, *weights.shape[2:])
        self.covariances = Covariances(weights, views, self.y.window, self.x.window, prior)

    def linear(self, pair: Floats) -> Floats:
        """Best linear estimate.

        Parameters
        ----------
        pair : array (2, rows, cols)
            Both diodes of every pixel, 1 = the average diode in a flat white scene.

        Returns
        -------
        float32 (views, views, rows, cols)
            l[v, u, y, x], 1 = white.

        Raises
        ------
        ParameterError
            For a wrong shape.
        """
        groups = self._windows(pair)
        return self._linear(groups, groups)

    # NumPy and SciPy have threads of their own for BLAS, which wait for one another: three times as long as one alone
    @threadpool_limits.wrap(limits=1, user_api="blas")
    def _linear(self, groups: Windows, told: Windows) -> Floats:
        """The estimate of `linear` from the windows of ``groups``, with the disparities that those of ``told`` show."""
        out = np.zeros((self.views, self.views, *self.shape), np.float32)
        shares = self._shares(told)
        for (down, across, samples), ways in zip(groups, self._ways, strict=True):
            own = shares[:, down.blocks, across.blocks].reshape(len(shares), -1)
            self._place(out, ways.estimate(samples, own, LINEAR, self.views, shares[0].size), down, across)
        return out

    def _shares(self, groups: Windows) -> Floats:
        """Shares of the disparities in every window, (disparities, block rows, block cols)."""
        blocks = len(self.y.blocks), len(self.x.blocks)
        count, pool = self.prior.disparities, self.prior.width
        squares, certain = np.zeros((2, count, *blocks), np.float32)
        contrast = np.zeros(blocks)
        for (down, across, samples), ways in zip(groups, self._ways, strict=True):
            shape = self._count(down, across)
            at = down.blocks, across.blocks
            contrast[at] = samples[: len(samples) // 2].var(0).reshape(shape)
            for number, residual in enumerate(ways.residuals):
                errors = np.square(residual.matrix @ samples).sum(0) / ways.read
                squares[number][at] = errors.reshape(shape)
                certain[number][at] = residual.certain.sum() / ways.read
        near = pool / (self.y.block * self.x.block) ** 0.5  # in blocks
        scores = [badness(pooled(s, near), c, 4 * np.pi * pool**2) for s, c in zip(squares, certain, strict=True)]
        return shares_of(probability(self.prior.trust * np.stack(scores), 0.0), contrast)

    def _windows(self, pair: Floats) -> Windows:
        """Samples of every group."""
        turned = self._turned(pair)
        return [(down, across, self._samples(turned, down, across)) for down, across in self._groups()]

    @cached_property
    def _ways(self) -> list[Ways]:
        """What every group is at each disparity, made once a sensor."""
        kinds = {_kind(*group): group for group in self._groups()}
        made: dict[tuple[int, ...], list[tuple[Floats, Floats, Residuals]]] = {kind: [] for kind in kinds}
        for d in self.prior.grid:
            tables = self.covariances.of(float(d))
            # Of windows that begin at the same place in a tile
            known: dict[tuple[int, ...], tuple[Floats, Floats]] = {}
            for kind, group in kinds.items():
                if kind[:2] not in known:
                    shared = self._shared(tables, *group)
                    known[kind[:2]] = shared.astype(np.float32), whitener(shared)
                shared, inverse = known[kind[:2]]
                field = self._field(tables, *group).astype(np.float32)
                made[kind].append((shared, field, Residuals.of(inverse, *self._own(*group))))
        stacks: dict[tuple[int, ...], Floats] = {}
        ways = {}
        for kind, group in kinds.items():
            shared, field, residuals = zip(*made.pop(kind), strict=True)
            stack = stacks.setdefault(kind[:2], np.stack(shared))
            ways[kind] = Ways(stack, np.stack(field), list(residuals), max(len(self._own(*group)[1]), 1))
        return [ways[_kind(*group)] for group in self._groups()]

    def prepare(self, mixture: bool = False) -> None:
        """Make what `linear` needs once a sensor, or `mixture`; they do so themselves where it has not been done.

        Parameters
        ----------
        mixture : bool
            Also what `mixture` needs.
        """
        _ = self._ways
        if mixture:
            _ = self.components, self._hypotheses

    @cached_property
    def components(self) -> list[list[Floats]]:
        """Filters of each disparity for every group, float32 (pixels * views**2, samples), made once a sensor."""
        units, own = np.eye(self.prior.disparities), {id(ways): ways for ways in self._ways}
        filters = {key: [s.filters for s in ways.mixed(units, MIXTURE, self.views)] for key, ways in own.items()}
        return [[filters[id(ways)][number] for ways in self._ways] for number in range(len(units))]

    @cached_property
    def _hypotheses(self) -> list[tuple[list[Residuals], Floats]]:
        """Every disparity, then any of them: residuals of every group, and their `certain` around each pixel."""
        tables, groups = self.covariances.mean(), list(self._groups())
        every = [[ways.residuals[number] for ways in self._ways] for number in range(self.prior.disparities)]
        every.append([Residuals.of(whitener(self._shared(tables, *g)), *self._own(*g)) for g in groups])
        width = self.prior.width
        certain = [pooled(self._map(r.certain for r in residuals), width) / self._read for residuals in every]
        return list(zip(every, certain, strict=True))

    @cached_property
    def _read(self) -> Floats:
        """Share of the pixels around each that are read."""
        kinds = self.tile.type_map(*self.shape)
        return np.maximum(pooled(self.measured[kinds].astype(np.float32), self.prior.width), np.float32(1e-6))

    def told_by(self, pixels: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
        """Where the mixture's disparity is from any of some pixels.

        Parameters
        ----------
        pixels : bool (rows, cols)
            Dead or full ones, for example.

        Returns
        -------
        bool (rows, cols)
            True where one of them is in a window.
        """
        windows = sliding_window_view(pixels, (self.y.window, self.x.window))[np.ix_(self.y.firsts, self.x.firsts)]
        told = np.asarray(self.y.spread() @ windows.any((2, 3)) @ self.x.spread().T > 0)
        return np.asarray(maximum_filter(told, 2 * math.ceil(REACH * self.prior.width) + 1), bool)

    def condition(self, disparity: float | None = None) -> float:
        """Condition of the covariance of the samples in a window, noise included.

        Parameters
        ----------
        disparity : float, optional
            In px per view step; None is the mean over the prior's, that of `linear`.

        Returns
        -------
        float
            Greatest of all groups of windows.
        """
        tables = self.covariances.mean() if disparity is None else self.covariances.of(disparity)
        groups = {(down.phase, across.phase): (down, across) for down, across in self._groups()}
        return max(float(np.linalg.cond(self._shared(tables, *group))) for group in groups.values())

    def mixture(self, pair: Floats, evidence: Floats | None = None) -> Estimate:
        """Mean over the disparities, each as probable as the samples make it.

        Parameters
        ----------
        pair : array (2, rows, cols)
            As in `linear`.
        evidence : array (2, rows, cols), optional
            Samples of the same scene that tell its disparity; None is ``pair``. For the taps of time of flight.

        Returns
        -------
        Estimate
            Light field and disparity.

        Raises
        ------
        ParameterError
            For a wrong shape.
        """
        groups = self._windows(pair)
        told = groups if evidence is None else self._windows(evidence)
        grid, plain = self.prior.grid, self._plain(told)
        blank = self.y.spread() @ plain @ self.x.spread().T
        scores = self._scores(told)
        chance = probability(scores, UNLIKELY)
        # What shows no disparity, or more than one, takes the linear estimate
        any_of = chance[-1] * (1 - blank) + blank
        out = self._linear(groups, told) * any_of.astype(np.float32)
        for weight, filters in zip(chance * (1 - blank), self.components, strict=False):
            if weight.any():
                out += self._estimate(filters, groups, weight > 0) * weight.astype(np.float32)
        planes = probability(scores[:-1], UNLIKELY) * (1 - blank) + blank / len(grid)
        mean = np.tensordot(grid, planes, 1)
        lost = np.where(any_of > LOST, any_of, 0)  # no disparity is likelier than any
        doubt = planes * (1 - lost) + lost / len(grid)
        spread = np.tensordot(grid**2, doubt, 1) - 2 * mean * np.tensordot(grid, doubt, 1) + mean**2
        spread = np.sqrt(np.maximum(spread, 0))
        return Estimate(out, mean.astype(np.float32), spread.astype(np.float32), float(plain.mean()))

    def _map(self, values: Iterable[Floats]) -> Floats:
        """A value of each pixel from those of every group's blocks, each (pixels, windows) or (pixels,)."""
        out = np.zeros((1, 1, *self.shape), np.float32)
        for (down, across), part in zip(self._groups(), values, strict=True):
            shape = len(part), math.prod(self._count(down, across))
            self._place(out, np.broadcast_to(part.reshape(len(part), -1), shape), down, across)
        return out[0, 0]

    def _plain(self, groups: Windows) -> npt.NDArray[np.bool_]:
        """Whether noise explains what each window has beside the nearest uniform scene, (block rows, block cols)."""
        plain = np.zeros((len(self.y.blocks), len(self.x.blocks)), bool)
        totals = self.covariances.weights.sum((1, 2))
        for down, across, samples in groups:
            white = totals[self._diodes(down, across)[2]].astype(np.float32)
            found = white @ samples / (white @ white)
            rest = np.square(samples - white[:, None] * found).mean(0)
            part = plain[down.blocks, across.blocks]
            part[:] = (rest < self.prior.plain * self.prior.noise**2).reshape(part.shape)
        return plain

    def _scores(self, groups: Windows) -> Floats:
        """What trust leaves of -2 log p of every disparity, and of any, (disparities + 1, rows, cols)."""
        pool, scores = self.prior.width, []
        for residuals, certain in self._hypotheses:
            errors = [residual.matrix @ samples for (*_, samples), residual in zip(groups, residuals, strict=True)]
            squares = pooled(self._map(np.square(e) for e in errors), pool) / self._read
            scores.append(badness(squares, certain, 4 * np.pi * pool**2))
        return self.prior.trust * np.stack(scores)

    def _estimate(self, filters: list[Floats], groups: Windows, wanted: npt.NDArray[np.bool_]) -> Floats:
        """The light field by filters of every group in the blocks that have a wanted pixel; 0 in the others."""
        blocks = np.asarray(sliding_window_view(wanted, (self.y.block, self.x.block)).any((2, 3)))
        out = np.zeros((self.views, self.views, *self.shape), np.float32)
        for (down, across, samples), matrix in zip(groups, filters, strict=True):
            first, count = self.y.blocks[down.blocks], self.x.blocks[across.blocks]
            some = np.flatnonzero(blocks[np.ix_(first, count)])
            if len(some):
                found = np.zeros((len(matrix), samples.shape[1]), np.float32)
                found[:, some] = matrix @ samples[:, some]
                self._place(out, found, down, across)
        return out

    def _turned(self, pair: Floats) -> Floats:
        """Sum and difference of each pair, scaled so that the noise of both is that of a diode."""
        if pair.shape != (2, *self.shape):
            raise ParameterError(f"pair shape = {pair.shape}: must be {(2, *self.shape)}")
        return np.stack([pair[0] + pair[1], pair[0] - pair[1]]).astype(np.float32) / np.float32(np.sqrt(2))

    def _groups(self) -> Iterator[tuple[Group, Group]]:
        return ((down, across) for down in self.y.groups() for across in self.x.groups())

    def _count(self, down: Group, across: Group) -> tuple[int, int]:
        """Blocks of a group, down and across."""
        return len(self.y.blocks[down.blocks]), len(self.x.blocks[across.blocks])

    def _diodes(self, down: Group, across: Group) -> tuple[npt.NDArray[np.int64], ...]:
        """Row, column and number (2 type + 0 for sums, 1 for differences) of every sample of a window, sums first."""
        high, wide = self.y.window, self.x.window
        period = self.tile.type_map(self.tile.rows, self.tile.cols)
        lines = (down.phase + np.arange(high)) % self.tile.rows
        kinds = period[np.ix_(lines, (across.phase + np.arange(wide)) % self.tile.cols)]
        diode = (2 * kinds + np.arange(2)[:, None, None]).ravel()
        y, x = (np.tile(p.ravel(), 2) for p in np.indices((high, wide)))
        used = self.measured[diode // 2]
        return y[used], x[used], diode[used]

    def _samples(self, pair: Floats, down: Group, across: Group) -> Floats:
        """Samples of all windows of a group, (samples, windows)."""
        windows = sliding_window_view(pair, (self.y.window, self.x.window), (1, 2))
        windows = windows[:, down.windows, across.windows].transpose(0, 3, 4, 1, 2)
        out = np.ascontiguousarray(windows, np.float32).reshape(-1, windows.shape[3] * windows.shape[4])
        if self.measured.all():
            return out
        y, x, diode = self._diodes(down, across)
        return out[((diode % 2) * self.y.window + y) * self.x.window + x]

    def _shared(self, tables: Tables, down: Group, across: Group) -> npt.NDArray[np.float64]:
        """Covariance of the samples of a window, noise included."""
        y, x, diode = self._diodes(down, across)
        places = y - y[:, None] + self.y.window - 1, x - x[:, None] + self.x.window - 1
        shared = tables.samples[*places, diode[:, None], diode]
        shared[np.diag_indices(len(shared))] += self.prior.noise**2
        return shared

    def _own(self, down: Group, across: Group) -> tuple[Ints, Ints, int]:
        """Which samples are differences of the block's pixels, these pixels' numbers in it, and how many it has."""
        y, x, diode = self._diodes(down, across)
        y, x = y - down.offset, x - across.offset
        inside = (diode % 2 == 1) & (y >= 0) & (y < self.y.block) & (x >= 0) & (x < self.x.block)
        return np.flatnonzero(inside), (y * self.x.block + x)[inside], self.y.block * self.x.block

    def _field(self, tables: Tables, down: Group, across: Group) -> npt.NDArray[np.float64]:
        """Covariance of the views of a block with the samples of its window, (pixels * views**2, samples)."""
        y, x, diode = self._diodes(down, across)
        own = np.indices((self.y.block, self.x.block)).reshape(2, -1, 1)
        dy, dx = y - own[0] - down.offset, x - own[1] - across.offset
        out = tables.field[dy + self.y.window - 1, dx + self.x.window - 1, :, diode]  # (pixels, samples, views)
        return out.transpose(0, 2, 1).reshape(-1, len(diode))

    def _place(self, out: Floats, values: Floats, down: Group, across: Group) -> None:
        """Write the blocks of a group into the light field."""
        first, count = self.y.blocks[down.blocks], self.x.blocks[across.blocks]
        part = values.reshape(self.y.block, self.x.block, *out.shape[:2], len(first), len(count))
        lines, columns = even(first), even(count)
        for i, j in np.ndindex(self.y.block, self.x.block):
            rows = slice(lines.start + i, lines.stop + i, lines.step)
            out[:, :, rows, columns.start + j : columns.stop + j : columns.step] = part[i, j]


def _kind(down: Group, across: Group) -> tuple[int, int, int, int]:
    """What windows are alike in: where they begin in a tile, then where the blocks are in them."""
    return down.phase, across.phase, down.offset, across.offset

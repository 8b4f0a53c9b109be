"""A light field from samples: the most likely one for any disparity, or with each window's own disparity.

For every disparity, samples and light field of a window are Gaussian, with the covariances of `covariance`. The linear
estimate is the best one where the disparity may be any. How well the samples of a window fit to each disparity is the
evidence for it; the mixture is the mean of the estimates, each as probable as its disparity [Levin2008].
"""

import math
from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view
from scipy.ndimage import maximum_filter
from threadpoolctl import threadpool_limits

from talbot.models.capture.cameras import asp
from talbot.models.capture.projection import Projection
from talbot.models.parameters import ParameterError, SensorParameters
from talbot.models.reconstruct.bayes.blocks import Blocks, Kind, Pair, kind
from talbot.models.reconstruct.bayes.covariance import Covariances, Tables
from talbot.models.reconstruct.bayes.evidence import REACH, Residuals, badness, pooled, probability, whitener
from talbot.models.reconstruct.bayes.hypotheses import Hypotheses
from talbot.models.reconstruct.bayes.planes import Plane, Window, texture_points
from talbot.models.reconstruct.bayes.prior import FieldPrior
from talbot.models.reconstruct.bayes.scene import Factor, Solver, Ways, factor, raised, shares_of
from talbot.models.reconstruct.bayes.slants import Slant, slants_of
from talbot.models.reconstruct.bayes.windows import Axis, Group, Windows

Floats = npt.NDArray[np.floating]
# What differs between the views, times its mean over what is not known, which shrinks it: by leaves and a tilted plane
LINEAR, MIXTURE = 1.15, 1.1
LOST = 0.5  # probability of no one disparity, from which on it is not known
TEXTURE = 2500  # pixels of texture that a window's planes may need: its covariance is 50 MB
WIDEST = 8.0  # px, of the evidence's pool, beyond which it tells no slant
UNLIKELY = 1e-3  # probability below which a disparity is left out of a mixture


class Estimate(NamedTuple):
    """The result of `mixture` for a frame.

    light_field: (views, views, rows, cols), l[v, u, y, x], 1 = white.
    disparity: (rows, cols), mean of the disparity's probability, px per view step.
    spread: (rows, cols), its standard deviation: 0 is certain.
    plain: share of the windows, 0..1, that show no more than noise on a uniform scene: they take the linear estimate.
    """

    light_field: Floats
    disparity: Floats
    spread: Floats
    plain: float = 0.0


class FieldEstimator:
    """Estimates light fields from frames of one sensor, or of another camera.

    sensor: the sensor; its lens counts as telecentric. Samples of a camera stand for the pair of diodes in what
        follows.
    views: of the light field along the pupil's diameter.
    prior: what is known before.
    pupil: points of the pupil at which the samples are taken to see the scene, along its diameter; None is as the
        views, or the camera's own.
    measured: (types,), pixel types that are read, or responses of a camera; None is all.
    """

    def __init__(
        self,
        sensor: SensorParameters | Projection,
        views: int,
        prior: FieldPrior = FieldPrior(),
        pupil: int | None = None,
        measured: npt.NDArray[np.bool_] | None = None,
    ) -> None:
        self._pairs = isinstance(sensor, SensorParameters)
        camera = sums_and_differences(sensor, pupil or views) if isinstance(sensor, SensorParameters) else sensor
        if prior.margin % camera.side:
            raise ParameterError(f"margin = {prior.margin}: must be whole squares of {camera.side} px")
        self.prior, self.views, self.shape, self.pupil = prior, views, camera.shape, camera.pupil
        sides = zip(camera.shape, camera.period, camera.block or camera.period, strict=True)
        y, x = (Axis.of(length, period, prior.margin, block) for length, period, block in sides)
        count = len(camera.weights) // (2 if self._pairs else 1)
        read = np.ones(count, bool) if measured is None else np.asarray(measured, bool)
        if not read.any():
            raise ParameterError("measured = no pixel type: must be at least one")
        read = np.repeat(read, len(camera.weights) // count)
        self.blocks, self._slants = Blocks(y, x, camera, read), dict[Slant, Hypotheses]()
        self.covariances = Covariances(camera.weights, views, y.window, x.window, prior, camera.side)

    def linear(self, pair: Floats) -> Floats:
        """Best linear estimate.

        pair: (2, rows, cols), both diodes of every pixel, 1 = the average diode in a flat white scene. Returns (views,
        views, rows, cols), l[v, u, y, x], 1 = white. Raises ParameterError for a wrong shape.
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
            block_shares = shares[:, down.blocks, across.blocks].reshape(len(shares), -1)
            self.blocks.place(
                out, ways.estimate(samples, block_shares, LINEAR, self.views, shares[0].size), down, across
            )
        return out

    def _shares(self, groups: Windows) -> Floats:
        """Shares of the disparities in every window, (disparities, block rows, block cols)."""
        blocks, pool = (len(self.blocks.y.blocks), len(self.blocks.x.blocks)), self.prior.width
        squares, certain = np.zeros((2, self.prior.disparities, *blocks), np.float32)
        contrast = np.zeros(blocks)
        for (down, across, samples), ways in zip(groups, self._ways, strict=True):
            shape = self.blocks.count(down, across)
            at = down.blocks, across.blocks
            telling = self.blocks.camera.telling[self.blocks.diodes(down, across)[2]]
            contrast[at] = samples[telling if telling.all() else ~telling].var(0).reshape(shape)
            for number, residual in enumerate(ways.residuals):
                errors = np.square(residual.matrix @ samples).sum(0) / ways.read
                squares[number][at] = errors.reshape(shape)
                certain[number][at] = residual.certain.sum() / ways.read
        near = pool / (self.blocks.y.block * self.blocks.x.block) ** 0.5  # in blocks
        count = self.blocks.pooled_errors(pool)
        scores = [badness(pooled(s, near), c, count) for s, c in zip(squares, certain, strict=True)]
        return shares_of(probability(self.prior.trust * np.stack(scores), 0.0), contrast)

    def _windows(self, pair: Floats) -> Windows:
        """Samples of every group."""
        turned = self._turned(pair)
        return [(down, across, self.blocks.samples(turned, down, across)) for down, across in self.blocks.groups]

    @cached_property
    def _ways(self) -> list[Ways]:
        """Ways of every group at each disparity of the grid, cached for the sensor."""
        return self._ways_at(self.prior.grid)

    def _ways_at(self, disparities: Floats) -> list[Ways]:
        """Return the ways of every group at each of the disparities."""
        kinds = {kind(*group): group for group in self.blocks.groups}
        count = len(disparities)
        stacks: dict[tuple[int, int], Floats] = {}
        means: dict[tuple[int, int], Floats] = {}
        fields: dict[Kind, Floats] = {}
        residuals: dict[Kind, list[Residuals]] = {key: [] for key in kinds}
        for number, d in enumerate(disparities):
            tables = self.covariances.of(float(d))
            # Of windows that begin at the same place in a tile
            known: dict[tuple[int, int], Floats] = {}
            for key, group in kinds.items():
                phase = key[:2]
                if phase not in known:
                    shared = self._shared(tables, *group)
                    known[phase] = whitener(shared)
                    if not number:
                        stacks[phase] = np.empty((count, *shared.shape), np.float32)
                        means[phase] = np.zeros_like(shared)
                    stacks[phase][number] = shared
                    means[phase] += shared / count
                field = self._field(tables, *group)
                if not number:
                    fields[key] = np.empty((count, *field.shape), np.float32)
                fields[key][number] = field
                residuals[key].append(Residuals.of(known[phase], *self.blocks.own(*group)))
        ways = {
            key: Ways(
                stacks[key[:2]], means[key[:2]], fields[key], residuals[key], max(len(self.blocks.own(*group)[1]), 1)
            )
            for key, group in kinds.items()
        }
        return [ways[kind(*group)] for group in self.blocks.groups]

    @threadpool_limits.wrap(limits=1, user_api="blas")
    def prepare(self, mixture: bool = False) -> None:
        """Compute the tables of `linear` or `mixture` for the sensor in advance; they do so on demand otherwise.

        mixture: also what `mixture` needs, but for slants, which a scene tells.
        """
        _ = self._ways
        if mixture:
            _ = self._facing, self._any

    @cached_property
    def _facing(self) -> Hypotheses:
        """Planes that face the camera: those of the grid are as `linear` has them."""
        fine, step = self.prior.fine, self.prior.between + 1
        between = np.arange(len(fine)) % step > 0
        ways = [self._ways] * len(fine)
        if between.any():
            more = self._ways_at(fine[between])
            ways = [more if other else self._ways for other in between]
        place = np.where(between, np.cumsum(between) - 1, np.arange(len(fine)) // step)
        residuals = [[way.residuals[i] for way in groups] for groups, i in zip(ways, place, strict=True)]
        index = {kind(*group): i for i, group in enumerate(self.blocks.groups)}
        factors: dict[tuple[int, int, int], Factor] = {}

        def solver(number: int, group: Pair) -> Solver:
            key = kind(*group)
            way = ways[number][index[key]]
            same = number, *key[:2]
            if same not in factors:
                factors[same] = factor(way.shared[place[number]].copy())
            return Solver(factors[same], way.field[place[number]])

        return Hypotheses((0.0, 0.0), self.blocks, self.prior, self._read, residuals, solver)

    def _slanted(self, slant: Slant) -> Hypotheses:
        """Planes of a slant."""

        def covariances(number: int, group: Pair, views: bool) -> tuple[npt.NDArray[np.float64], Floats | None]:
            (down, across), high, wide = group, self.blocks.y, self.blocks.x
            (y, x), diode = self.blocks.aims(*group), self.blocks.diodes(*group)[2]
            block = down.offset, across.offset, high.block, wide.block
            weights, side = self.covariances.weights[diode], self.covariances.side
            window = Window((high.window, wide.window), y, x, weights, block, self.views, side)
            shared, field = window.covariances(Plane(float(self.prior.fine[number]), slant), self.prior, views)
            return self._noisy(shared), field

        def residuals(number: int) -> list[Residuals]:
            known: dict[tuple[int, int], Floats] = {}  # of windows that begin at the same place in a tile
            by_pair = {}
            for group in self.blocks.groups:
                key = kind(*group)
                if key[:2] not in known:
                    known[key[:2]] = whitener(covariances(number, group, False)[0])
                by_pair[key] = Residuals.of(known[key[:2]], *self.blocks.own(*group))
            return [by_pair[kind(*group)] for group in self.blocks.groups]

        def solver(number: int, group: Pair) -> Solver:
            shared, field = covariances(number, group, True)
            assert field is not None
            return Solver(factor(shared.astype(np.float32)), field)

        every = [residuals(number) for number in range(len(self.prior.fine))]
        return Hypotheses(slant, self.blocks, self.prior, self._read, every, solver)

    def _slants_of(self, disparity: Floats, spread: Floats) -> list[Slant]:
        """Those of `slants_of` whose planes need no more than TEXTURE, none where noise hides them."""
        if not self.prior.slants or self.prior.width > WIDEST:
            return []
        most, window = max(abs(self.prior.far), abs(self.prior.near)), (self.blocks.y.window, self.blocks.x.window)
        slants = slants_of(disparity, spread, self.prior.slants)
        return [slant for slant in slants if texture_points(window, self.views, most, slant) <= TEXTURE]

    @cached_property
    def _any(self) -> tuple[list[Residuals], Floats]:
        """Return, for any disparity, the residuals of every group and their `certain` around each pixel."""
        means = {kind(*group)[:2]: ways.mean for group, ways in zip(self.blocks.groups, self._ways, strict=True)}
        known = {phase: whitener(mean) for phase, mean in means.items()}
        residuals = [Residuals.of(known[kind(*g)[:2]], *self.blocks.own(*g)) for g in self.blocks.groups]
        return residuals, pooled(self.blocks.map(r.certain for r in residuals), self.prior.width) / self._read

    @cached_property
    def _read(self) -> Floats:
        """Telling samples that are read, a pixel around each."""
        camera = self.blocks.camera
        read = (self.blocks.measured & camera.telling)[camera.responses].sum(0, dtype=np.float32)
        return np.maximum(pooled(read, self.prior.width), np.float32(1e-6))

    def told_by(self, pixels: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
        """Return where the mixture's disparity depends on any of some pixels.

        pixels: (rows, cols), dead or full ones, for example. Returns (rows, cols), True where one of them is in a
        window.
        """
        y, x = self.blocks.y, self.blocks.x
        windows = sliding_window_view(pixels, (y.window, x.window))[np.ix_(y.firsts, x.firsts)]
        told = np.asarray(y.spread() @ windows.any((2, 3)) @ x.spread().T > 0)
        return np.asarray(maximum_filter(told, 2 * math.ceil(REACH * self.prior.width) + 1), bool)

    def condition(self, disparity: float | None = None) -> float:
        """Condition of the covariance of the samples in a window, noise included.

        disparity: in px per view step; None is the mean over the prior's, that of `linear`. Returns greatest of all
        groups of windows.
        """
        tables = self.covariances.mean() if disparity is None else self.covariances.of(disparity)
        groups = {(down.phase, across.phase): (down, across) for down, across in self.blocks.groups}
        return max(float(np.linalg.cond(self._shared(tables, *group))) for group in groups.values())

    @threadpool_limits.wrap(limits=1, user_api="blas")
    def mixture(self, pair: Floats, evidence: Floats | None = None) -> Estimate:
        """Mean over the disparities, each as probable as the samples make it.

        pair: (2, rows, cols), as in `linear`. evidence: (2, rows, cols), samples of the same scene that tell its
        disparity; None is ``pair``. For the taps of time of flight. Returns light field and disparity. Raises
        ParameterError for a wrong shape.
        """
        groups = self._windows(pair)
        told = groups if evidence is None else self._windows(evidence)
        plain = self._plain(told)
        blank = (self.blocks.y.spread() @ plain @ self.blocks.x.spread().T).astype(np.float32)
        facing = self._facing.scores(told)
        slants = self._slants_of(*self._disparity(facing, blank))
        # Kept for the next frame of the scene; those of another scene are not
        self._slants = {slant: self._slants.get(slant) or self._slanted(slant) for slant in slants}
        sets = [self._facing, *self._slants.values()]
        scores = [facing, *(planes.scores(told) for planes in sets[1:])]
        # More disparities make none of them all together more probable than before
        more = 2 * math.log(len(sets) * len(self.prior.fine) / len(self.prior.grid))
        every = np.concatenate([*scores, self._score(told)[None] - np.float32(more)])
        chance = probability(every, UNLIKELY)
        parts = np.split(chance[:-1] * (1 - blank), len(sets))
        # What shows no disparity, or more than one, takes the linear estimate
        weights = [planes.at_blocks(part) for planes, part in zip(sets, parts, strict=True)]
        out = self._linear(groups, told) * (1 - sum(weight.sum(0) for weight in weights))
        out += self._weighted(sets, weights, groups)
        return Estimate(out, *self._disparity(every, blank), float(plain.mean()))

    def _disparity(self, scores: Floats, blank: Floats) -> tuple[Floats, Floats]:
        """Mean disparity and its standard deviation.

        scores: of the disparities of one or more slants, then perhaps of any. blank: share of a pixel that shows none.
        """
        fine = self.prior.fine
        whole = len(scores) // len(fine) * len(fine)
        planes = probability(scores[:whole], UNLIKELY).reshape(-1, len(fine), *self.shape).sum(0)
        planes = planes * (1 - blank) + blank / len(fine)
        mean = np.tensordot(fine, planes, 1)
        any_of = np.zeros(self.shape) if whole == len(scores) else probability(scores, UNLIKELY)[-1]
        lost = np.where((any_of := any_of * (1 - blank) + blank) > LOST, any_of, 0)  # no disparity is likelier than any
        doubt = planes * (1 - lost) + lost / len(fine)
        spread = np.tensordot(fine**2, doubt, 1) - 2 * mean * np.tensordot(fine, doubt, 1) + mean**2
        return mean.astype(np.float32), np.sqrt(np.maximum(spread, 0)).astype(np.float32)

    def _plain(self, groups: Windows) -> npt.NDArray[np.bool_]:
        """Return where noise explains a window's difference from a uniform scene, (block rows, block cols)."""
        plain = np.zeros((len(self.blocks.y.blocks), len(self.blocks.x.blocks)), bool)
        totals = self.covariances.weights.sum((1, 2))
        for down, across, samples in groups:
            white = totals[self.blocks.diodes(down, across)[2]].astype(np.float32)
            fit = white @ samples / (white @ white)
            residual = np.square(samples - white[:, None] * fit).mean(0)
            part = plain[down.blocks, across.blocks]
            part[:] = (residual < self.prior.plain * self.prior.noise**2).reshape(part.shape)
        return plain

    def _score(self, groups: Windows) -> Floats:
        """Return -2 log p of any disparity, times trust, float32 (rows, cols)."""
        (residuals, certain), pool = self._any, self.prior.width
        errors = (residual.squares(samples) for (*_, samples), residual in zip(groups, residuals, strict=True))
        squares = pooled(self.blocks.map(errors), pool) / self._read
        errors_pooled = self.blocks.pooled_errors(pool)
        return np.asarray(self.prior.trust * badness(squares, certain, errors_pooled), np.float32)

    def _weighted(self, sets: list[Hypotheses], weights: list[Floats], groups: Windows) -> Floats:
        """Sum of the light fields by all disparities of the ``sets``, by their weights at the pixels."""
        out = np.zeros((self.views, self.views, *self.shape), np.float32)
        for down, across, samples in groups:
            total = np.zeros((self.blocks.y.block * self.blocks.x.block, self.views**2, samples.shape[1]), np.float32)
            for planes, weight in zip(sets, weights, strict=True):
                at = self.blocks.taken(weight, down, across)
                for number in np.flatnonzero(at.any((1, 2))):
                    some = np.flatnonzero(at[number].any(0))
                    field = planes.solver(int(number), (down, across))(samples[:, some])
                    total[..., some] += field.reshape(*total.shape[:2], -1) * at[number][:, None, some]
            field = raised(total.reshape(-1, samples.shape[1]), MIXTURE, self.views)
            self.blocks.place(out, field, down, across)
        return out

    def _turned(self, pair: Floats) -> Floats:
        """Samples of the camera: of a sensor sum and difference of each pair, of the noise of a diode."""
        if pair.shape != (shape := (self.blocks.camera.channels, *self.shape)):
            raise ParameterError(f"pair shape = {pair.shape}: must be {shape}")
        if not self._pairs:
            return pair.astype(np.float32)
        return np.stack([pair[0] + pair[1], pair[0] - pair[1]]).astype(np.float32) / np.float32(np.sqrt(2))

    def _shared(self, tables: Tables, down: Group, across: Group) -> npt.NDArray[np.float64]:
        """Covariance of the samples of a window, noise included."""
        (y, x), diode = self.blocks.aims(down, across), self.blocks.diodes(down, across)[2]
        places = y - y[:, None] + self.blocks.y.window - 1, x - x[:, None] + self.blocks.x.window - 1
        return self._noisy(tables.samples[*places, diode[:, None], diode])

    def _noisy(self, shared: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        shared[np.diag_indices(len(shared))] += self.prior.noise**2
        return shared

    def _field(self, tables: Tables, down: Group, across: Group) -> npt.NDArray[np.float64]:
        """Covariance of the views of a block with the samples of its window, (pixels * views**2, samples)."""
        (y, x), diode = self.blocks.aims(down, across), self.blocks.diodes(down, across)[2]
        high, wide = self.blocks.y, self.blocks.x
        places = np.indices((high.block, wide.block)).reshape(2, -1, 1)
        dy, dx = y - places[0] - down.offset, x - places[1] - across.offset
        out = tables.field[dy + high.window - 1, dx + wide.window - 1, :, diode]  # (pixels, samples, views)
        return out.transpose(0, 2, 1).reshape(-1, len(diode))


def sums_and_differences(sensor: SensorParameters, pupil: int) -> Projection:
    """Sum and difference of each pair of diodes, over the square root of 2, as a camera.

    sensor: the sensor. pupil: cells along the pupil's diameter. Returns Projection: of two channels: response 2 t is
    the sum of type t, which tells no disparity, 2 t + 1 its difference.
    """
    diodes = asp(sensor, pupil)
    a, b = diodes.weights[::2], diodes.weights[1::2]
    weights = (np.stack([a + b, a - b], 1) / np.sqrt(2)).reshape(-1, pupil, pupil)
    return replace(diodes, weights=weights, telling=np.arange(len(weights)) % 2 == 1)

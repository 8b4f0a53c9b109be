"""Sparse coding: patches of a light field as sums of few atoms of a learned dictionary [Jayasuriya2017, Sec. 3.3.2].

For every patch,  min 1/2 |(i - Phi D chi) / noise|^2 + penalty |chi / sizes|_1,  by ADMM [Boyd2011]: all patches of one
place in the tile share Phi D, whose factors are computed once, so that a step is one product of matrices. Overlapping
patches are averaged. What is fine in a picture is in the sums of the diodes, little of it in the differences, and the
dictionary leaves it out: sums count as noisier.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from joblib import Parallel, delayed
from numpy.lib.stride_tricks import sliding_window_view
from scipy.linalg import cho_factor, cho_solve

from talbot.models.parameters import ParameterError, SensorParameters, check_int, check_real
from talbot.models.pixel.weights import view_weights

Floats = npt.NDArray[np.floating]
DICTIONARY = Path(__file__).with_name("dictionary.npz")
CHUNK = 2048  # patches that are coded together: as much as stays in the cache, and a task for a core


@dataclass(frozen=True)
class Coding:
    """The parameters of the patches' code.

    stride: px from patch to patch, 1..the patch's size.
    iterations: of ADMM, 1..10000.
    penalty: of the codes' absolute values, each over its mean, against squares of samples over their noise, 0..1000.
    noise: standard deviation of a sample, of white = 1: 1e-5..10.
    floor_sum, floor_difference: standard deviation of what the dictionary leaves unexplained of the sum and of the
        difference of a pixel's diodes, over sqrt(2), 0..1: what is fine in a picture is in its sums alone.
    atoms: how many atoms are used, the most used first; None is all.
    jobs: processes of joblib, 1..1024.

    Source: [Jayasuriya2017], Sec. 3.3.2.
    """

    stride: int = 3
    iterations: int = 60
    penalty: float = 0.04
    noise: float = 0.006
    floor_sum: float = 0.05
    floor_difference: float = 0.005
    atoms: int | None = None
    jobs: int = 1

    def __post_init__(self) -> None:
        check_int("stride", self.stride, 1, 64)
        check_int("iterations", self.iterations, 1, 10000)
        check_real("penalty", self.penalty, 0, 1000)
        check_real("noise", self.noise, 1e-5, 10)
        check_real("floor_sum", self.floor_sum, 0, 1)
        check_real("floor_difference", self.floor_difference, 0, 1)
        check_int("jobs", self.jobs, 1, 1024)


class Lasso(NamedTuple):
    """Least squares with a penalty on absolute values, factored once for all right sides.

    inverse: (atoms, atoms), of A'A + rho I.
    rho: step of ADMM, > 0.
    """

    inverse: Floats
    rho: float

    @classmethod
    def of(cls, gram: Floats) -> "Lasso":
        """Factor.

        gram: (atoms, atoms), A'A. Returns Lasso: with the mean of the diagonal as step.
        """
        rho = float(np.trace(gram) / len(gram)) or 1.0
        inverse = cho_solve(cho_factor(gram + rho * np.eye(len(gram))), np.eye(len(gram)))
        return cls(np.asarray(inverse, np.float32), rho)

    def solve(self, right: Floats, penalty: Floats, iterations: int) -> Floats:
        """Codes of many right sides.

        right: (atoms, n), A'i. penalty: (atoms, 1), of every code, 0 or more. iterations: of ADMM, without
        over-relaxation. Returns (atoms, n), codes, with exact zeros. Source: [Boyd2011], Sec. 6.4.
        """
        limit = (penalty / self.rho).astype(np.float32)
        dual = np.zeros_like(right)
        codes = np.zeros_like(right)
        for _ in range(iterations):
            near = self.inverse @ (right + self.rho * (codes - dual))
            dual += near
            codes = dual - np.clip(dual, -limit, limit)  # shrinks towards 0
            dual -= codes
        return codes


class Dictionary(NamedTuple):
    """The atoms of the patches.

    atoms: (atoms, views, views, height, width), of norm 1, the first constant, then the most used first.
    sizes: (atoms,), mean of the absolute value of each one's code, > 0.
    """

    atoms: Floats
    sizes: Floats

    @classmethod
    @cache
    def shipped(cls) -> "Dictionary":
        """Load the one that is shipped.

        Returns Dictionary: of `DICTIONARY`.
        """
        with np.load(DICTIONARY) as file:
            atoms = file["codes"].astype(np.float32)
            atoms /= np.linalg.norm(atoms.reshape(len(atoms), -1), axis=1)[:, None, None, None, None]
            return cls(atoms, file["sizes"])


class SparseEstimator:
    """Light fields of one sensor by sparse coding.

    sensor: the sensor; its lens counts as telecentric.
    coding: how.
    dictionary: None is the one that is shipped.
    """

    def __init__(
        self, sensor: SensorParameters, coding: Coding = Coding(), dictionary: Dictionary | None = None
    ) -> None:
        self.sensor, self.coding = sensor, coding
        self.atoms, self.sizes = (part[: coding.atoms] for part in dictionary or Dictionary.shipped())
        self.views, self.patch = self.atoms.shape[1], self.atoms.shape[3:]
        if coding.stride > min(self.patch):
            raise ParameterError(f"stride = {coding.stride}: must be in 1..{min(self.patch)}, the size of a patch")
        if min(np.subtract(sensor.shape, self.patch)) < 0:
            raise ParameterError(f"rows, cols = {sensor.shape}: must be {self.patch} or more, the size of a patch")
        weights = view_weights(sensor.tile, replace(sensor.optics, views=self.views)).astype(np.float32)
        self._seen = np.einsum("tdvu,kvuyx->tdyxk", _turned(weights, 1), self.atoms, optimize=True)
        floors = coding.floor_sum, coding.floor_difference
        self._certain = np.array([(coding.noise**2 + floor**2) ** -0.5 for floor in floors], np.float32)
        self._factors: dict[tuple[int, int], tuple[Floats, Lasso]] = {}

    def prepare(self) -> None:
        """Factor Phi D for every place of a patch in the tile; `estimate` does it where it has not been done."""
        for down in self._groups(0):
            for across in self._groups(1):
                self._factor(int(down[0]), int(across[0]))

    def estimate(self, pair: Floats) -> Floats:
        """Light field from samples.

        pair: (2, rows, cols), both diodes of every pixel, 1 = the average diode in a flat white scene. Returns (views,
        views, rows, cols), l[v, u, y, x], 1 = white. Raises ParameterError for a wrong shape.
        """
        rows, cols = self.sensor.shape
        if pair.shape != (2, rows, cols):
            raise ParameterError(f"pair shape = {pair.shape}: must be {(2, rows, cols)}")
        turned = _turned(np.asarray(pair, np.float32), 0) * self._certain[:, None, None]
        windows = sliding_window_view(turned, self.patch, (1, 2))
        out = np.zeros((self.views, self.views, rows, cols), np.float32)
        count = np.zeros((rows, cols), np.float32)
        flat = self.atoms.reshape(len(self.atoms), -1)
        for down in self._groups(0):
            for across in self._groups(1):
                samples = windows[:, down[:, None], across].transpose(0, 3, 4, 1, 2)
                samples = samples.reshape(2 * self.patch[0] * self.patch[1], -1)
                codes = self._codes(samples, int(down[0]), int(across[0]))
                patches = (flat.T @ codes).reshape(self.views, self.views, *self.patch, len(down), len(across))
                for y, x in np.ndindex(*self.patch):
                    place = (down + y)[:, None], across + x
                    out[:, :, *place] += patches[:, :, y, x]
                    count[place] += 1
        return out / count

    def _codes(self, samples: Floats, top: int, left: int) -> Floats:
        """Codes of patches at one place in the tile, (atoms, n)."""
        coding, (seen, lasso) = self.coding, self._factor(top, left)
        penalty = coding.penalty / self.sizes[:, None]
        penalty[0] = 0  # the mean is free
        parts = [seen.T @ samples[:, first : first + CHUNK] for first in range(0, samples.shape[1], CHUNK)]
        solved = Parallel(n_jobs=coding.jobs)(delayed(lasso.solve)(part, penalty, coding.iterations) for part in parts)
        return np.concatenate([np.asarray(part) for part in solved], 1)

    def _factor(self, top: int, left: int) -> tuple[Floats, Lasso]:
        """Phi D, (samples, atoms), and its factors for patches that begin here in the tile."""
        tile = self.sensor.tile
        key = top % tile.rows, left % tile.cols
        if key not in self._factors:
            y, x = np.indices(self.patch)
            kinds = tile.type_map(tile.rows, tile.cols)[(y + key[0]) % tile.rows, (x + key[1]) % tile.cols]
            seen = self._seen[kinds, :, y, x].transpose(2, 0, 1, 3) * self._certain[:, None, None, None]
            seen = seen.reshape(-1, len(self.atoms))
            self._factors[key] = seen, Lasso.of((seen.T @ seen).astype(float))
        return self._factors[key]

    def _groups(self, axis: int) -> Iterator[npt.NDArray[np.int64]]:
        """First pixels of the patches along an axis, those together that begin alike in the tile."""
        period = (self.sensor.tile.rows, self.sensor.tile.cols)[axis]
        last = self.sensor.shape[axis] - self.patch[axis]
        places = np.unique([*range(0, last + 1, self.coding.stride), last])
        for phase in np.unique(places % period):
            yield places[places % period == phase]


def _turned(values: Floats, axis: int) -> Floats:
    """Sums and differences of both diodes, over sqrt(2): the noise of both is a diode's."""
    a, b = np.take(values, 0, axis), np.take(values, 1, axis)
    return np.stack([a + b, a - b], axis) / np.float32(np.sqrt(2))

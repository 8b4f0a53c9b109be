"""Energy of an event from frames' energies: least squares that is not negative, of relative residuals."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import nnls

from .events import DigitalEvents


@dataclass(frozen=True)
class Fit:
    """What was found. pj: of an event, by name. left_out: share by which each frame is off in the fit of all others."""

    pj: dict[str, float]
    left_out: tuple[float, ...]

    def predict(self, events: DigitalEvents) -> float:
        """Energy of a frame, pJ."""
        return sum(self.pj[name] * count for name, count in events._asdict().items())


def fit(events: Sequence[DigitalEvents], pj: Sequence[float]) -> Fit:
    """Fit the energies (pJ) of frames to what was in them; each counts by its relative residual."""
    counts, energies = np.array(events, float), np.array(pj, float)
    own = _solve(counts, energies)
    left_out = []
    for k in range(len(energies)):
        rest = np.arange(len(energies)) != k
        left_out.append(float(counts[k] @ _solve(counts[rest], energies[rest]) / energies[k] - 1))
    return Fit(dict(zip(DigitalEvents._fields, own.tolist(), strict=True)), tuple(left_out))


def _solve(counts: npt.NDArray[np.float64], energies: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    rows = counts / energies[:, None]
    scale = np.maximum(rows.max(0), np.finfo(float).tiny)  # an event that no frame has takes nothing
    return nnls(rows / scale, np.ones(len(energies)))[0] / scale

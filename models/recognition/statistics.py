"""Figures of a classification, and of a detection."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from talbot.models.parameters import ParameterError


class Spread(NamedTuple):
    """Mean of some values, and their standard deviation (None of one value)."""

    mean: float
    std: float | None

    @classmethod
    def of(cls, values: npt.ArrayLike) -> "Spread":
        """Return those of some values.

        values: (n,), 1 or more. Returns Spread: with the standard deviation of a sample, over n - 1.
        """
        array = np.asarray(values, float)
        return cls(float(array.mean()), float(array.std(ddof=1)) if array.size > 1 else None)


class Roc(NamedTuple):
    """Receiver operating characteristic: rates of false and of true alarms by falling threshold, and the area below.

    false, true: (n,), from 0 to 1.
    area: of a random pair, the probability that the event scores higher; 0.5 is chance.
    """

    false: npt.NDArray[np.float64]
    true: npt.NDArray[np.float64]
    area: float


def roc(scores: npt.ArrayLike, events: npt.ArrayLike) -> Roc:
    """Compute the characteristic of a detector.

    scores: (n,), large where it detects something. events: (n,), where there is something. Equal scores count
    half. Raises ParameterError where there are no events, or nothing else.
    """
    scores, events = np.asarray(scores, float), np.asarray(events, bool)
    if not events.any() or events.all():
        raise ParameterError(f"events = {int(events.sum())} of {events.size}: must have both kinds")
    order = np.argsort(-scores, kind="stable")
    last = np.append(np.flatnonzero(np.diff(scores[order])), scores.size - 1)  # of equal scores
    true = np.append(0, np.cumsum(events[order])[last]) / events.sum()
    false = np.append(0, np.cumsum(~events[order])[last]) / (~events).sum()
    return Roc(false, true, float(np.sum(np.diff(false) * (true[1:] + true[:-1]) / 2)))


def first_layer_flops(height: int, width: int, kernel: int, filters: int, channels: int = 1) -> int:
    """Count the multiply-accumulate operations of a first layer that the optics replaces.

    height, width: of its output in px. kernel: edge of a filter in px. filters: their number. channels: of the picture.
    Returns int: what [Jayasuriya2017], Table 6.2, calls FLOPS.
    """
    return height * width * kernel**2 * filters * channels

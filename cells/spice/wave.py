"""Crossings, transition times and charges of a transient."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Samples = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Wave:
    """A transient, as arrays of one value a point: s (rising), V of nodes, A of sources, into the cell."""

    time: Samples
    voltage: dict[str, Samples]
    current: dict[str, Samples]

    def cross(self, node: str, level: float, rising: bool, after: float = 0.0) -> float | None:
        """The last time after ``after`` s at which ``node`` crosses ``level`` volts upwards (or downwards), or None."""
        v = self.voltage[node] - level
        if not rising:
            v = -v
        hits = np.nonzero((v[:-1] < 0) & (v[1:] >= 0) & (self.time[1:] > after))[0]
        if not len(hits):
            return None
        i = hits[-1]
        return float(self.time[i] + (self.time[i + 1] - self.time[i]) * v[i] / (v[i] - v[i + 1]))

    def at(self, node: str, when: float) -> float:
        """Volts of ``node`` at ``when`` s, linear between points."""
        return float(np.interp(when, self.time, self.voltage[node]))

    def charge(self, source: str, start: float, stop: float) -> float:
        """Coulombs through ``source`` from ``start`` to ``stop`` s, by the trapezoidal rule."""
        inside = (self.time > start) & (self.time < stop)
        times = np.r_[start, self.time[inside], stop]
        return float(np.trapezoid(np.interp(times, self.time, self.current[source]), times))

"""What a transient shows: crossings, transition times, charges."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Wave:
    """time: (points,) s, rising. voltage: node -> (points,) V. current: source -> (points,) A, into the cell."""

    time: np.ndarray
    voltage: dict
    current: dict

    def cross(self, node, level, rising, after=0.0):
        """Time at which ``node`` last crosses ``level`` volts upwards (or downwards) after ``after`` s, or None."""
        v = self.voltage[node] - level
        if not rising:
            v = -v
        hits = np.nonzero((v[:-1] < 0) & (v[1:] >= 0) & (self.time[1:] > after))[0]
        if not len(hits):
            return None
        i = hits[-1]
        return float(self.time[i] + (self.time[i + 1] - self.time[i]) * v[i] / (v[i] - v[i + 1]))

    def at(self, node, when):
        """Volts of ``node`` at ``when`` s, linear between points."""
        return float(np.interp(when, self.time, self.voltage[node]))

    def charge(self, source, start, stop):
        """Coulombs through ``source`` from ``start`` to ``stop`` s, by the trapezoidal rule."""
        i, t = self.current[source], self.time
        inside = (t > start) & (t < stop)
        times = np.r_[start, t[inside], stop]
        return float(np.trapezoid(np.interp(times, t, i), times))

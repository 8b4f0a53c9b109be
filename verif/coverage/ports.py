"""The values of a component's ports over all recorded cycles, as arrays: the input of functional cover points."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.rtl.harness.ports import places, port_signals, split
from talbot.rtl.replay import Trace

Values = npt.NDArray[Any]  # int64, one per cycle; Python integers for ports of more than 63 bits
Mask = npt.NDArray[np.bool_]  # one per cycle


class Recorded:
    """Ports of a Trace by name: ``p.start``, or ``p.step__msg``, whose fields are ``p.step__kind``.

    ``p.fresh``: a simulator's first cycle, before its reset. ``p.arguments``: of the component.
    """

    def __init__(self, trace: Trace) -> None:
        self.arguments = trace.arguments
        rows = [line.split() for line in trace.lines]
        self.fresh: Mask = np.array([row[0] == "1" for row in rows])
        self._packed = [int(row[1], 16) for row in rows], [int(row[2], 16) for row in rows]
        self._places = {
            port.name: (group, low, port.width)
            for group, ports in enumerate(split(trace.ports))
            for port, low in places(ports).items()
        }
        component = trace.component()
        component.elaborate()
        start = len(repr(component)) + 1
        for signal in port_signals(component):
            kind = signal._dsl.Type
            if hasattr(kind, "__bitstruct_fields__"):
                self._add_fields(repr(signal)[start:].replace(".", "__"), kind)

    def _add_fields(self, port: str, kind: Any) -> None:
        """Add the fields of a bit struct, the first in the highest bits."""
        group, low, width = self._places[port]
        high = low + width
        stem = port.removesuffix("msg") if port.endswith("__msg") else f"{port}__"
        for name, field in kind.__bitstruct_fields__.items():
            high -= field.nbits
            self._places[stem + name] = group, high, field.nbits

    def __getattr__(self, name: str) -> Values:
        if name.startswith("_") or name not in self._places:
            raise AttributeError(f"no port {name}")
        group, low, width = self._places[name]
        mask = (1 << width) - 1
        values = np.array([value >> low & mask for value in self._packed[group]], object if width > 63 else np.int64)
        setattr(self, name, values)
        return values

    def was(self, values: Values, cycles: int = 1) -> Values:
        """Return ``values`` as they were ``cycles`` earlier; False or 0 before a simulator's first cycle."""
        out = np.zeros_like(values)
        out[cycles:] = values[:-cycles]
        begun = np.maximum.accumulate(np.where(self.fresh, np.arange(len(values)), 0))
        out[np.arange(len(values)) - begun < cycles] = 0
        return out

    def since(self, event: Mask) -> Values:
        """Return the cycles since ``event`` was last true: 0 in such a cycle, -1 if never in this simulator."""
        at = np.arange(len(event))
        begun = np.maximum.accumulate(np.where(self.fresh, at, 0))
        last = np.maximum.accumulate(np.where(event, at, -1))
        return np.where(last >= begun, at - last, -1)


Points = dict[str, Callable[[Recorded], Mask]]  # by name, true in the cycles that reach the point

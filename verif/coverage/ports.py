"""The values of a component's ports over all recorded cycles, as arrays: what functional cover points look at."""

import numpy as np

from rtl.ports import places, port_signals, split


class Recorded:
    """Ports of a Trace by name: ``p.start``, or ``p.step__msg``, whose fields are ``p.step__kind``.

    Values: int64, a cycle each; objects for more than 63 bits. ``p.fresh``: a simulator's first cycle, ahead of its
    reset. ``p.arguments``: of the component.
    """

    def __init__(self, trace):
        self.arguments = trace.arguments
        rows = [line.split() for line in trace.lines]
        self.fresh = np.array([row[0] == "1" for row in rows])
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

    def _add_fields(self, port, kind):
        """A struct's fields lie from the highest bits down."""
        group, low, width = self._places[port]
        high = low + width
        stem = port.removesuffix("msg") if port.endswith("__msg") else f"{port}__"
        for name, field in kind.__bitstruct_fields__.items():
            high -= field.nbits
            self._places[stem + name] = group, high, field.nbits

    def __getattr__(self, name):
        if name.startswith("_") or name not in self._places:
            raise AttributeError(f"no port {name}")
        group, low, width = self._places[name]
        mask = (1 << width) - 1
        values = np.array([value >> low & mask for value in self._packed[group]], object if width > 63 else np.int64)
        setattr(self, name, values)
        return values

    def was(self, values, cycles=1):
        """``values`` of some cycles before; False or 0 where a simulator had not begun."""
        out = np.zeros_like(values)
        out[cycles:] = values[:-cycles]
        begun = np.maximum.accumulate(np.where(self.fresh, np.arange(len(values)), 0))
        out[np.arange(len(values)) - begun < cycles] = 0
        return out

    def since(self, event):
        """Cycles since ``event`` was last true, 0 in such a cycle; -1 where it never was in its simulator."""
        at = np.arange(len(event))
        begun = np.maximum.accumulate(np.where(self.fresh, at, 0))
        last = np.maximum.accumulate(np.where(event, at, -1))
        return np.where(last >= begun, at - last, -1)

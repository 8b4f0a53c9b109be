"""Pins that are low in reset, before the first edge of the clock too."""

from pymtl3 import Component, InPort, OutPort, mk_bits, update


class Gate(Component):
    """`pins` is `levels`, and 0 while `low`. bits: pins."""

    def construct(s, bits):
        NONE = mk_bits(bits)(0)
        s.low = InPort()
        s.levels = InPort(bits)
        s.pins = OutPort(bits)

        @update
        def up_pins():
            s.pins @= NONE if s.low else s.levels

    def line_trace(s):
        return f"{s.pins}"

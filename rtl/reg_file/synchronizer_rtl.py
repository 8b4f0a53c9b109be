"""Two flip-flops between a pin that is asynchronous to the clock and the logic behind it."""

from pymtl3 import Component, InPort, OutPort, Wire, concat, update_ff


class Synchronizer(Component):
    """`out` is `pin` two cycles later. It has no reset: the reset pin itself passes one."""

    def construct(s):
        s.pin = InPort()
        s.out = OutPort()
        s.stages = Wire(2)

        s.out //= s.stages[1]

        @update_ff
        def up_stages():
            s.stages <<= concat(s.stages[0], s.pin)

    def line_trace(s):
        return f"{s.pin}{s.stages}"

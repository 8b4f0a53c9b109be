"""The resets of the chip: the pin, released by the clock, and `abort`."""

from collections.abc import Iterator
from contextlib import contextmanager

from pymtl3 import Component, InPort, OutPort, update

from talbot.rtl.reg_file import Synchronizer


class Resets(Component):
    """chip: the `reset` pin, at once, and until its fall has passed two flip-flops. engine: chip, or `abort`."""

    def construct(s):
        s.abort_ = InPort()
        s.chip = OutPort()
        s.engine = OutPort()
        s.released = Synchronizer()

        s.released.pin //= s.reset

        @update
        def up_resets():
            s.chip @= s.reset | s.released.out
            s.engine @= s.chip | s.abort_

    def line_trace(s):
        return f"{s.chip}{s.engine}"


@contextmanager
def children_reset_by(s: Component, reset: OutPort) -> Iterator[None]:
    """Within this context, children added to the component ``s`` are reset by ``reset`` instead of its reset."""
    own = s.__dict__["reset"]
    s.__dict__["reset"] = reset  # PyMTL connects a child's reset to its parent's when the child is constructed
    try:
        yield
    finally:
        s.__dict__["reset"] = own

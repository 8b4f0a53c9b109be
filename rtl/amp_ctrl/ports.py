"""AmpCtrl's ports, the same at every level (README.md)."""

from pymtl3 import InPort, OutPort

DURATIONS = ("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard")
SLOT = ("slot_resets", "slot_reads", "slot_opens")


def declare_ports(s) -> None:
    """Give the component ``s`` its ports."""
    s.start, s.four_tap, s.hold_free = InPort(), InPort(), InPort()
    for name in DURATIONS:
        setattr(s, name, InPort(16))
    s.n_cm = InPort(8)
    s.slot_resets, s.slot_reads, s.slot_opens = InPort(), InPort(), InPort()
    s.pixel_reset, s.shutter, s.ref_ctl, s.integrate = OutPort(), OutPort(), OutPort(), OutPort()
    s.expose, s.cm_reset, s.read, s.sample = OutPort(), OutPort(), OutPort(), OutPort()
    s.tap = OutPort(2)
    s.busy, s.done, s.cfg_err = OutPort(), OutPort(), OutPort()

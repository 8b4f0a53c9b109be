"""AmpCtrl at functional level: the golden waveform. It is cycle-exact, so there is no cycle level."""

from pymtl3 import Component, update_ff

from talbot.models.digital.amp_ctrl import AmpPins, Slot, row_waveform
from talbot.models.parameters import AmpTiming
from talbot.rtl.amp_ctrl.ports import DURATIONS, SLOT, declare_ports


class AmpCtrlFL(Component):
    """Functional level of AmpCtrl: the same ports, and the same values in every cycle."""

    def construct(s):
        declare_ports(s)
        s.row = None  # the waveform of the current row
        s.pins = AmpPins()
        s.error = 0

        @update_ff
        def up_pins():
            if s.reset:
                s.row, s.pins, s.error = None, AmpPins(), 0
            elif s.row is not None:
                s.pins = s.row.send(bool(s.hold_free))
                if s.pins.done:
                    s.row = None
            else:
                s.pins = AmpPins()
                if s.start:
                    s.begin()
            # one by one: PyMTL finds the registers of a block in its source
            s.pixel_reset <<= s.pins.pixel_reset
            s.shutter <<= s.pins.shutter
            s.ref_ctl <<= s.pins.ref_ctl
            s.integrate <<= s.pins.integrate
            s.expose <<= s.pins.expose
            s.cm_reset <<= s.pins.cm_reset
            s.read <<= s.pins.read
            s.sample <<= s.pins.sample
            s.tap <<= s.pins.tap
            s.busy <<= s.pins.busy
            s.done <<= s.pins.done
            s.cfg_err <<= s.error

    def begin(s):
        """Accept `start` in idle: capture the durations; a zero duration is refused."""
        durations = {name: int(getattr(s, name)) for name in DURATIONS}
        s.error = int(0 in durations.values())
        if not s.error:
            slot = Slot(*(bool(getattr(s, name)) for name in SLOT))
            s.row = row_waveform(AmpTiming(n_cm=int(s.n_cm), **durations), bool(s.four_tap), slot)
            s.pins = next(s.row)

    def line_trace(s):
        return f"{s.pins}"

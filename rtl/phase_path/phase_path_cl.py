"""PhasePath at cycle level: the RTL's cycles and stalls, with the divider's cycle level."""

from pymtl3 import Bits8, Component, InPort, update, update_ff
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.rtl.messages import SAMPLE, DivReq, ScanMsg
from talbot.rtl.quad_divider import QuadDividerCL


class PhasePathCL(Component):
    """Cycle level of PhasePath: the same ports, and the same handshakes in every cycle."""

    def construct(s, lanes=8, divider="radix4", n_frac=8, iterations=10):
        s.recv = RecvIfcRTL(ScanMsg)
        s.on = InPort()
        s.noise_floor = InPort(Bits8)
        s.send = SendIfcRTL(ScanMsg)

        s.divider = QuadDividerCL(divider, n_frac, iterations)
        s.divider.noise_floor //= s.noise_floor

        s.head = None  # (kind, data): the message in the input register
        s.taps = [[]]  # samples of a step, a list per tap; the last list grows
        s.in_flight = 0  # vectors in the divider
        s.half_sent = False  # the phase of the divider's response is sent

        def is_tap():
            return s.head is not None and bool(s.on) and s.head[0] == SAMPLE

        def is_fourth():
            return is_tap() and len(s.taps) == 4

        def passes():
            return s.head is not None and not is_tap() and (not s.on or s.in_flight == 0)

        @update
        def up_ask():
            s.divider.recv.val @= is_fourth()
            if is_fourth():
                i = len(s.taps[3])
                s.divider.recv.msg @= DivReq(s.taps[0][i] - s.taps[2][i], (s.head[1] & 0xFF) - s.taps[1][i])

        @update
        def up_send():
            s.send.val @= s.divider.send.val | int(passes())
            if s.divider.send.val:
                resp = s.divider.send.msg
                amplitude = int(resp.amp) if resp.amp_valid else 0
                s.send.msg @= ScanMsg(SAMPLE, amplitude if s.half_sent else int(resp.phase))
            elif passes():
                kind, data = s.head
                s.send.msg @= ScanMsg(kind, data & 0xFF if kind == SAMPLE else data)
            s.divider.send.rdy @= s.send.rdy & int(s.half_sent)

        @update
        def up_rdy():
            accepted = s.divider.recv.rdy if is_fourth() else is_tap() or (passes() and s.send.rdy)
            s.recv.rdy @= int(s.head is None or bool(accepted))

        @update_ff
        def behave():
            if s.reset:
                s.head, s.taps, s.in_flight, s.half_sent = None, [[]], 0, False
            else:
                s.in_flight += int(s.divider.recv.val & s.divider.recv.rdy)
                s.in_flight -= int(s.divider.send.val & s.divider.send.rdy)
                if s.divider.send.val & s.send.rdy:
                    s.half_sent = not s.half_sent
                if s.recv.rdy:
                    if is_tap():
                        keep(s.head[1])
                    s.head = (int(s.recv.msg.kind), int(s.recv.msg.data)) if s.recv.val else None

        def keep(data):
            s.taps[-1].append(data & 0xFF)
            if data >> 9:
                s.taps = [[]] if len(s.taps) == 4 else [*s.taps, []]

    def line_trace(s):
        return f"{s.recv} {s.head} {s.in_flight} {s.send}"

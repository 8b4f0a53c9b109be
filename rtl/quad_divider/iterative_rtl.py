"""The parts common to the iterative variants: a state machine, and its connection to a datapath and the streams."""

from pymtl3 import Component, InPort, OutPort, Wire, update, update_ff
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.rtl.messages import DivReq, div_resp


class IterativeControl(Component):
    """Idle, running or done: load the operands, step until the datapath's `last`, offer the result."""

    def construct(s):
        s.recv_val = InPort()
        s.recv_rdy = OutPort()
        s.send_val = OutPort()
        s.send_rdy = InPort()
        s.last = InPort()
        s.load = OutPort()
        s.step = OutPort()

        s.running = Wire()
        s.done = Wire()

        s.step //= s.running
        s.send_val //= s.done

        @update
        def up_idle():
            s.recv_rdy @= ~s.running & ~s.done
            s.load @= s.recv_rdy & s.recv_val

        @update_ff
        def up_state():
            if s.reset:
                s.running <<= 0
                s.done <<= 0
            else:
                s.running <<= s.load | (s.running & ~s.last)
                s.done <<= (s.running & s.last) | (s.done & ~s.send_rdy)


class IterativeDivider(Component):
    """Streams around a control and ``dpath``; the response has a ratio of ``n_frac`` bits."""

    def construct(s, dpath, n_frac):
        s.recv = RecvIfcRTL(DivReq)
        s.send = SendIfcRTL(div_resp(n_frac))
        s.noise_floor = InPort(8)

        s.ctrl = IterativeControl()
        s.dpath = dpath

        s.recv.val //= s.ctrl.recv_val
        s.recv.rdy //= s.ctrl.recv_rdy
        s.send.val //= s.ctrl.send_val
        s.send.rdy //= s.ctrl.send_rdy
        s.ctrl.load //= s.dpath.load
        s.ctrl.step //= s.dpath.step
        s.ctrl.last //= s.dpath.last
        s.dpath.recv_msg //= s.recv.msg
        s.dpath.noise_floor //= s.noise_floor
        s.send.msg //= s.dpath.send_msg

    def line_trace(s):
        return f"{s.recv}({'.R'[s.ctrl.running]}{'.D'[s.ctrl.done]}){s.send}"

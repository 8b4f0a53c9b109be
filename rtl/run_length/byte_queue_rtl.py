"""ByteQueue at RTL: two bytes between the encoder and the link, without a path from rdy to rdy."""

from pymtl3 import Bits2, Bits8, Component, InPort, OutPort, Wire, update, update_ff
from pymtl3.stdlib.stream.ifcs import SendIfcRTL


class ByteQueue(Component):
    def construct(s):
        # Interface
        s.put = InPort()  # only while `ready`
        s.octet = InPort(Bits8)
        s.ready = OutPort()
        s.last = OutPort()  # empty after this cycle
        s.send = SendIfcRTL(Bits8)

        # Components
        s.head = Wire(Bits8)
        s.second = Wire(Bits8)
        s.count = Wire(Bits2)
        s.take = Wire()

        # Connections
        s.send.msg //= s.head

        # Logic
        @update
        def handshake():
            s.send.val @= s.count != 0
            s.take @= s.send.val & s.send.rdy
            s.ready @= ~s.count[1]
            s.last @= (s.count == 0) | (s.count[0] & s.take)

        @update_ff
        def move():
            if s.reset:
                s.head <<= 0
                s.second <<= 0
                s.count <<= 0
            else:
                if s.put & ~s.take:
                    s.count <<= s.count + 1
                elif s.take & ~s.put:
                    s.count <<= s.count - 1
                if s.take & s.count[1]:
                    s.head <<= s.second
                elif s.put & ((s.count == 0) | s.take):
                    s.head <<= s.octet
                if s.put:
                    s.second <<= s.octet

    def line_trace(s):
        return f"q{s.count}"

"""The stream's two checks at RTL, a byte a cycle (models.digital.stream.crc)."""

from pymtl3 import Bits8, Bits16, Bits32, Component, InPort, OutPort, Wire, concat, update, update_ff, zext


class Crc16(Component):
    """CRC-16/IBM-3740 of the bytes put since the last restart."""

    def construct(s):
        s.restart = InPort()
        s.put = InPort()
        s.octet = InPort(Bits8)
        s.crc = OutPort(Bits16)

        s.step = Wire(Bits16)

        @update
        def next_crc():
            s.step @= s.crc
            if s.put:
                s.step @= s.crc ^ concat(s.octet, Bits8(0))
                for _ in range(8):
                    s.step @= (s.step << 1) ^ 0x1021 if s.step[15] else s.step << 1

        @update_ff
        def keep():
            if s.reset | s.restart:
                s.crc <<= 0xFFFF
            elif s.put:
                s.crc <<= s.step

    def line_trace(s):
        return f"{s.crc}"


class Crc32(Component):
    """CRC-32 of IEEE 802.3 of the bytes put since the last restart."""

    def construct(s):
        s.restart = InPort()
        s.put = InPort()
        s.octet = InPort(Bits8)
        s.crc = OutPort(Bits32)

        s.state = Wire(Bits32)
        s.step = Wire(Bits32)

        @update
        def next_crc():
            s.crc @= ~s.state
            s.step @= s.state
            if s.put:
                s.step @= s.state ^ zext(s.octet, 32)
                for _ in range(8):
                    s.step @= (s.step >> 1) ^ 0xEDB88320 if s.step[0] else s.step >> 1

        @update_ff
        def keep():
            if s.reset | s.restart:
                s.state <<= 0xFFFFFFFF
            elif s.put:
                s.state <<= s.step

    def line_trace(s):
        return f"{s.state}"

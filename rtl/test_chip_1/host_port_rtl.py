"""HostPort at RTL: bytes of the host become accesses to memory, the control register and the processor's channel."""

from pymtl3 import Bits2, Bits8, Bits28, Bits32, Component, InPort, OutPort, Wire, concat, update, update_ff, zext
from pymtl3.stdlib.stream.ifcs import RecvIfcRTL, SendIfcRTL

from talbot.rtl.messages import MemReq

HEADER, GATHER, ACCESS, ANSWER, RETURN = range(5)


class HostPort(Component):
    def construct(s):
        # Interface
        s.host2chip = RecvIfcRTL(Bits8)
        s.chip2host = SendIfcRTL(Bits8)
        s.mem_req = SendIfcRTL(MemReq)
        s.mem_resp = RecvIfcRTL(Bits32)
        s.to_proc = SendIfcRTL(Bits32)
        s.from_proc = RecvIfcRTL(Bits32)
        s.proc_waits = InPort()  # for a word of the host
        s.halted = InPort()
        s.runs = OutPort()  # the control register: the processor and the sorter are not in reset

        # Components
        s.state = Wire(3)
        s.index = Wire(2)  # of a byte
        s.address = Wire(16)  # bit 15 a write, bit 14 a register
        s.left = Wire(16)  # words to transfer
        s.word = Wire(32)
        s.of_memory = Wire()
        s.of_channel = Wire()
        s.takes = Wire()  # a byte of the host
        s.done = Wire()  # the access

        # Connections
        s.to_proc.msg //= s.word
        s.chip2host.msg //= s.word[0:8]

        # Logic
        @update
        def up_bytes():
            s.host2chip.rdy @= (s.state == HEADER) | (s.state == GATHER)
            s.chip2host.val @= s.state == RETURN
            s.takes @= s.host2chip.val & s.host2chip.rdy

        @update
        def up_access():
            s.of_memory @= ~s.address[14]
            s.of_channel @= s.address[14] & s.address[0]
            s.mem_req.val @= (s.state == ACCESS) & s.of_memory
            s.mem_req.msg @= MemReq(0, zext(concat(s.address[0:12], Bits2(0)), 32), s.word)
            if s.address[15]:
                s.mem_req.msg @= MemReq(15, zext(concat(s.address[0:12], Bits2(0)), 32), s.word)
            s.mem_resp.rdy @= s.state == ANSWER
            s.to_proc.val @= (s.state == ACCESS) & s.of_channel & s.address[15]
            s.from_proc.rdy @= (s.state == ACCESS) & s.of_channel & ~s.address[15]

        @update
        def up_done():
            s.done @= s.state == ACCESS
            if s.of_memory:
                s.done @= (s.state == ANSWER) & s.mem_resp.val
            elif s.of_channel & s.address[15]:
                s.done @= s.to_proc.val & s.to_proc.rdy
            elif s.of_channel:
                s.done @= s.from_proc.rdy & s.from_proc.val

        @update_ff
        def up_state():
            if s.reset:
                s.state <<= HEADER
                s.index <<= 0
                s.runs <<= 0
            else:
                if s.takes | (s.chip2host.val & s.chip2host.rdy):
                    s.index <<= s.index + 1
                if s.state == HEADER:
                    if s.takes & (s.index == 3) & (concat(s.host2chip.msg, s.left[8:16]) != 0):
                        s.state <<= GATHER if s.left[7] else ACCESS  # the write's bit on its way
                elif s.state == GATHER:
                    if s.takes & (s.index == 3):
                        s.state <<= ACCESS
                elif s.state == RETURN:
                    if s.chip2host.rdy & (s.index == 3):
                        s.state <<= ACCESS if s.left != 0 else HEADER
                elif s.done:
                    s.state <<= RETURN
                    if s.address[15]:
                        s.state <<= GATHER if s.left != 1 else HEADER
                    if s.address[14] & s.address[15] & ~s.address[0]:
                        s.runs <<= s.word[0]
                elif (s.state == ACCESS) & s.mem_req.val & s.mem_req.rdy:
                    s.state <<= ANSWER

        @update_ff
        def up_words():
            if s.reset:
                s.address <<= 0
                s.left <<= 0
                s.word <<= 0
            elif (s.state == HEADER) & s.takes:
                s.address <<= concat(s.left[0:8], s.address[8:16])
                s.left <<= concat(s.host2chip.msg, s.left[8:16])
            elif (s.state == GATHER) & s.takes:
                s.word <<= concat(s.host2chip.msg, s.word[8:32])
            elif s.chip2host.val & s.chip2host.rdy:
                s.word <<= s.word >> 8
            elif s.done:
                s.left <<= s.left - 1
                if s.of_memory:
                    s.address <<= s.address + 1
                if ~s.address[15]:
                    s.word <<= concat(Bits28(0), s.proc_waits, s.from_proc.val, s.halted, s.runs)
                    if s.of_memory:
                        s.word <<= s.mem_resp.msg
                    elif s.of_channel:
                        s.word <<= s.from_proc.msg

    def line_trace(s):
        return f"{s.host2chip} {s.state} {s.chip2host}"

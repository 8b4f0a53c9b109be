"""RunLength at cycle level: the RTL's cycles and stalls, bits from the golden coder."""

from collections import deque

from pymtl3 import Component, update_ff

from talbot.models.digital.stream.payload import code_sample, start
from talbot.models.digital.stream.trailer import row_mark, trailer
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE
from talbot.rtl.run_length.control_rtl import DRAIN, HEADER, IDLE, MARK, ROWS, TRAILER
from talbot.rtl.run_length.ports import declare_ports
from talbot.rtl.run_length.run_length_fl import header_of

QUEUE = 2  # bytes between the encoder and the link


class RunLengthCL(Component):
    """Cycle level of RunLength: the same ports, parameters, and values in every cycle."""

    def construct(s, *chip):
        declare_ports(s)
        s.clear()

        @update_ff
        def behave():
            taken, full, draining = bool(s.send.val & s.send.rdy), len(s.queue) == QUEUE, s.state == DRAIN
            byte = None if full else s.next_byte()
            if s.recv.val & s.recv.rdy:
                s.take(chip, int(s.recv.msg.kind), int(s.recv.msg.data))
            if taken:
                s.queue.popleft()
            if byte is not None:
                s.queue.append(byte)
                s.sync = True
            elif draining and not s.queue:
                s.state, s.sync = IDLE, False
            if s.reset:
                s.clear()
            room = 8 if len(s.queue) == QUEUE else 16
            s.recv.rdy <<= s.state == IDLE or s.state == ROWS and len(s.bits) < room
            s.send.val <<= bool(s.queue)
            s.send.msg <<= s.queue[0] if s.queue else 0
            s.frame_sync <<= s.sync

    def clear(s):
        s.state, s.queue, s.part, s.bits, s.sync = IDLE, deque(), deque(), "", False

    def next_byte(s):
        """Return the byte that enters the queue in this cycle, or None."""
        if s.state == HEADER or s.state == TRAILER:
            byte = s.part.popleft()
            if not s.part:
                s.state = DRAIN if s.state == TRAILER else ROWS
            return byte
        if len(s.bits) >= 8:
            byte, s.bits = int(s.bits[:8], 2), s.bits[8:]
            s.payload.append(byte)
            return byte
        if s.state != MARK:
            return None
        if not s.part:
            s.part.extend(row_mark(bytes(s.payload), s.row))
            s.body += bytes(s.payload) + bytes(s.part)
        byte = s.part.popleft()
        if not s.part:
            s.start_trailer() if s.counts else s.start_segment(s.following)
        return byte

    def take(s, chip, kind, data):
        """Accept a message."""
        if s.state == IDLE:
            if kind == FRAME:
                s.header = header_of(s, *chip)
                s.state, s.part, s.body = HEADER, deque(s.header.to_bytes()), b""
                s.row = s.counts = None
        elif kind == SAMPLE and s.row is not None:
            s.push(data)
        elif kind == ROW and s.row is None:
            s.start_segment(data)
        elif kind == ROW and len(s.payload) >= s.header.segment:
            s.following = data
            s.end_segment()
        elif kind == END:
            s.counts = int(s.made), int(s.left_out)
            s.start_trailer() if s.row is None else s.end_segment()

    def push(s, data):
        if s.header.edge:
            code = data - (data & 0x80) * 2
            bits, length, *s.coder = code_sample(code, s.header.coder[1], *s.coder)
        else:
            bits, length = data & 0xFF, 8
        s.bits += f"{bits:0{length}b}" if length else ""

    def start_segment(s, row):
        s.state, s.row, s.coder, s.payload = ROWS, row, start(s.header.coder[1]), []

    def end_segment(s):
        if s.bits or s.coder[2]:
            s.bits = s.bits.ljust(8, "0")
        s.state = MARK

    def start_trailer(s):
        s.state, s.part = TRAILER, deque(trailer(s.header.to_bytes(), s.body, *s.counts))

    def line_trace(s):
        return f"{s.state} {len(s.queue)}"

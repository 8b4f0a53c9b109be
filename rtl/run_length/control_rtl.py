"""RunLengthCtrl at RTL: the part of the frame that is sent, and the effect of the next message."""

from pymtl3 import Bits2, Bits3, Bits5, Bits8, Component, InPort, OutPort, Wire, update, update_ff

from talbot.models.parameters.stream_format import COUNT_BYTES, COUNTED_BYTES, FIELD_BYTES, HEADER_BYTES, TRAILER_BYTES
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE

IDLE, HEADER, ROWS, MARK, TRAILER, DRAIN = range(6)
HEADER_FIELDS, COUNTS, COUNTED = FIELD_BYTES, COUNT_BYTES, COUNTED_BYTES  # names in the Verilog
HEADER_LAST, TRAILER_LAST = HEADER_BYTES - 1, TRAILER_BYTES - 1


class RunLengthCtrl(Component):
    def construct(s):
        # Interface
        s.val = InPort()  # of the message
        s.kind = InPort(Bits2)
        s.rdy = OutPort()
        s.packer_ready = InPort()
        s.packer_val = InPort()  # a byte of the payload is complete, and is sent first
        s.queue_ready = InPort()
        s.queue_last = InPort()
        s.resync = InPort(Bits2)
        s.start = OutPort()  # a frame starts
        s.first_row = OutPort()  # the message's row is the first
        s.next_row = OutPort()  # the message's row comes after another
        s.push = OutPort()
        s.flush = OutPort()
        s.restart = OutPort()  # of the segment's coder and its CRC
        s.marked = OutPort()  # a segment's mark is sent
        s.put = OutPort()  # a byte goes into the queue
        s.put_crc16 = OutPort()
        s.put_crc32 = OutPort()
        s.state = OutPort(Bits3)
        s.index = OutPort(Bits5)  # of the byte within header, mark or trailer
        s.frame_sync = OutPort()

        # Components
        s.open = Wire()  # a row has started
        s.size = Wire(Bits8)  # bytes of the segment's payload in the queue; it stays at 192
        s.grown = Wire(Bits8)  # ... after this cycle
        s.ending = Wire()  # END is taken
        s.go = Wire()
        s.finish = Wire()  # the frame's END is taken
        s.step = Wire()  # a byte of header, mark or trailer goes into the queue
        s.last = Wire()  # ... its last one

        # Logic
        @update
        def next_message():
            s.rdy @= (s.state == IDLE) | ((s.state == ROWS) & s.packer_ready)
            s.go @= s.val & s.rdy
            s.start @= s.go & (s.state == IDLE) & (s.kind == FRAME)
            s.push @= s.go & (s.state == ROWS) & (s.kind == SAMPLE) & s.open
            s.first_row @= s.go & (s.state == ROWS) & (s.kind == ROW) & ~s.open
            s.next_row @= s.go & (s.state == ROWS) & (s.kind == ROW) & s.open
            s.finish @= s.go & (s.state == ROWS) & (s.kind == END)
            s.flush @= (s.next_row & (s.grown[6:8] >= s.resync)) | (s.finish & s.open)

        @update
        def next_byte():
            s.grown @= s.size
            if s.queue_ready & s.packer_val & (s.size[6:8] != 3):
                s.grown @= s.size + 1
            s.step @= s.queue_ready & ~s.packer_val & ((s.state == HEADER) | (s.state == MARK) | (s.state == TRAILER))
            s.put @= s.step | (s.queue_ready & s.packer_val)
            s.last @= s.step & (
                ((s.state == HEADER) & (s.index == HEADER_LAST))
                | ((s.state == MARK) & s.index[0])
                | (s.index == TRAILER_LAST) & (s.state == TRAILER)
            )
            s.marked @= s.last & (s.state == MARK)
            s.restart @= s.first_row | s.marked | (s.finish & ~s.open)
            s.put_crc16 @= s.put & (s.packer_val | (s.state == TRAILER) & (s.index < COUNTS))
            s.put_crc32 @= (
                s.put
                & ~((s.state == HEADER) & (s.index >= HEADER_FIELDS))
                & ~((s.state == TRAILER) & (s.index >= COUNTED))
            )

        @update_ff
        def advance():
            if s.reset:
                s.state <<= IDLE
                s.index <<= 0
                s.open <<= 0
                s.size <<= 0
                s.ending <<= 0
                s.frame_sync <<= 0
            else:
                s.size <<= Bits8(0) if s.restart else s.grown
                if s.last:
                    s.index <<= 0
                elif s.step:
                    s.index <<= s.index + 1
                if s.start:
                    s.state <<= HEADER
                elif s.last & (s.state == HEADER):
                    s.state <<= ROWS
                elif s.flush:
                    s.state <<= MARK
                elif s.finish | (s.marked & s.ending):
                    s.state <<= TRAILER
                elif s.marked:
                    s.state <<= ROWS
                elif s.last & (s.state == TRAILER):
                    s.state <<= DRAIN
                elif (s.state == DRAIN) & s.queue_last:
                    s.state <<= IDLE
                if s.first_row:
                    s.open <<= 1
                elif s.finish:
                    s.open <<= 0
                s.ending <<= s.finish | (s.ending & (s.state != IDLE))
                if s.step & (s.state == HEADER):
                    s.frame_sync <<= 1
                elif (s.state == DRAIN) & s.queue_last:
                    s.frame_sync <<= 0

    def line_trace(s):
        return f"{'ihrmtd'[int(s.state)]}{s.index}"

"""RunLength at RTL: messages of a scan in, the bytes of docs/stream.md out."""

from pymtl3 import Bits2, Bits6, Bits8, Bits10, Bits16, Bits32, Component, Wire, concat, connect, update, update_ff

from talbot.rtl.run_length.byte_queue_rtl import ByteQueue
from talbot.rtl.run_length.control_rtl import COUNTS, HEADER, HEADER_FIELDS, MARK, TRAILER, RunLengthCtrl
from talbot.rtl.run_length.crc_rtl import Crc16, Crc32
from talbot.rtl.run_length.header_rtl import HeaderBytes
from talbot.rtl.run_length.packer_rtl import PayloadPacker
from talbot.rtl.run_length.ports import HEADER_PORTS, TERNARY, declare_ports
from talbot.rtl.sizes import check_size

MARK_PLACE = COUNTS // 2  # upper bits of the index of the trailer's mark


class RunLength(Component):
    """The stream encoder (README.md). rows, cols, lanes, tile_rows, tile_cols: of the chip, in the header."""

    def construct(s, rows, cols, lanes, tile_rows, tile_cols):
        check_size(rows=rows, cols=cols, lanes=lanes, tile_rows=tile_rows, tile_cols=tile_cols)

        # Interface
        declare_ports(s)

        # Components
        s.control = RunLengthCtrl()
        s.header = HeaderBytes(rows, cols, lanes, tile_rows, tile_cols)
        s.packer = PayloadPacker()
        s.crc16 = Crc16()
        s.crc32 = Crc32()
        s.queue = ByteQueue()
        s.row = Wire(Bits10)  # the segment's first
        s.following = Wire(Bits10)  # the row after this segment's mark
        s.mark = Wire(Bits16)
        s.word = Wire(Bits32)  # a count or the CRC-32
        s.place = Wire(Bits2)  # of the byte in it, 0 on top
        s.octet = Wire(Bits8)

        # Connections
        for name in HEADER_PORTS:
            connect(getattr(s.header, name), getattr(s, name))
        s.header.index //= s.control.index
        s.control.val //= s.recv.val
        s.control.kind //= s.recv.msg.kind
        s.control.rdy //= s.recv.rdy
        s.control.packer_ready //= s.packer.ready
        s.control.packer_val //= s.packer.val
        s.control.resync //= s.resync
        s.control.queue_ready //= s.queue.ready
        s.control.queue_last //= s.queue.last
        s.control.frame_sync //= s.frame_sync
        s.control.state //= s.state
        s.packer.restart //= s.control.restart
        s.packer.push //= s.control.push
        s.packer.flush //= s.control.flush
        s.packer.coded //= lambda: s.mode[0:2] == 0
        s.packer.signs //= lambda: s.mode == TERNARY
        s.packer.threshold //= s.threshold
        s.packer.code //= s.recv.msg.data[0:8]
        s.packer.rdy //= s.queue.ready
        s.crc16.restart //= s.control.restart
        s.crc16.put //= s.control.put_crc16
        s.crc16.octet //= s.octet
        s.crc32.restart //= s.control.start
        s.crc32.put //= s.control.put_crc32
        s.crc32.octet //= s.octet
        s.queue.put //= s.control.put
        s.queue.octet //= s.octet
        s.queue.send.msg //= s.send.msg
        s.queue.send.val //= s.send.val
        s.queue.send.rdy //= s.send.rdy

        # Logic
        @update
        def select_word():
            s.word @= s.crc32.crc
            s.place @= s.control.index[0:2]
            if s.control.state == TRAILER:
                if s.control.index < COUNTS:
                    s.word @= s.left_out if s.control.index[2] else s.made
                else:
                    s.place @= s.control.index[0:2] ^ 2  # the mark is before the CRC-32

        @update
        def select():
            s.mark @= s.crc16.crc ^ (Bits16(0xFFFF) if s.control.state == TRAILER else concat(Bits6(0), s.row))
            if s.packer.val:
                s.octet @= s.packer.octet
            elif (s.control.state == HEADER) & (s.control.index < HEADER_FIELDS):
                s.octet @= s.header.octet
            elif (s.control.state == MARK) | ((s.control.state == TRAILER) & (s.control.index[1:5] == MARK_PLACE)):
                s.octet @= s.mark[0:8] if s.control.index[0] else s.mark[8:16]
            elif s.place == 0:
                s.octet @= s.word[24:32]
            elif s.place == 1:
                s.octet @= s.word[16:24]
            elif s.place == 2:
                s.octet @= s.word[8:16]
            else:
                s.octet @= s.word[0:8]

        @update_ff
        def remember():
            if s.reset:
                s.row <<= 0
                s.following <<= 0
            else:
                if s.control.first_row:
                    s.row <<= s.recv.msg.data
                elif s.control.marked:
                    s.row <<= s.following
                if s.control.next_row:
                    s.following <<= s.recv.msg.data

    def line_trace(s):
        return f"{s.control.line_trace()} {s.packer.line_trace()} {s.queue.line_trace()}"

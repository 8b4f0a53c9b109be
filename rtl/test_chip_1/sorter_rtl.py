"""Sorter at RTL: a merge sort of words in memory, by a read and a write of each word in each pass."""

from pymtl3 import Bits2, Component, Wire, concat, update, update_ff, zext

from talbot.rtl.messages import MemReq
from talbot.rtl.test_chip_1.ports import declare_sorter_ports

IDLE, RUNS, MERGE, DONE = range(4)


class Sorter(Component):
    """Runs of `width` words become runs of twice as many, from the words at `source` to those at `target`."""

    def construct(s):
        # Interface
        declare_sorter_ports(s)

        # Components
        s.state = Wire(2)
        s.length = Wire(12)
        s.source = Wire(12)  # addresses of words
        s.target = Wire(12)
        s.moved = Wire()  # the words are at the second place
        s.width = Wire(14)
        s.out = Wire(12)  # indices: of the next word to write, of the next of each run, and the runs' ends
        s.left = Wire(12)
        s.left_end = Wire(12)
        s.right = Wire(12)
        s.right_end = Wire(12)
        s.a = Wire(32)  # the first words of both runs
        s.b = Wire(32)
        s.a_val = Wire()
        s.b_val = Wire()
        s.pending = Wire()  # a request has no response yet
        s.reads = Wire()  # it is a read
        s.reads_b = Wire()

        s.half = Wire(14)
        s.whole = Wire(14)
        s.want_a = Wire()
        s.want_b = Wire()
        s.writes = Wire()
        s.takes_a = Wire()
        s.index = Wire(12)
        s.go = Wire()

        # Connections
        s.resp.msg //= s.length

        # Logic
        @update
        def up_streams():
            s.req.rdy @= s.state == IDLE
            s.resp.val @= s.state == DONE
            s.mem_resp.rdy @= s.pending
            s.go @= s.mem_req.val & s.mem_req.rdy

        @update
        def up_runs():
            s.half @= zext(s.out, 14) + s.width
            s.whole @= zext(s.out, 14) + (s.width << 1)

        @update
        def up_choice():
            s.want_a @= ~s.a_val & (s.left != s.left_end)
            s.want_b @= ~s.b_val & (s.right != s.right_end)
            s.writes @= ~s.want_a & ~s.want_b & (s.a_val | s.b_val)
            s.takes_a @= s.a_val & (~s.b_val | (concat(~s.a[31], s.a[0:31]) <= concat(~s.b[31], s.b[0:31])))

        @update
        def up_request():
            s.index @= s.target + s.out
            if s.want_a:
                s.index @= s.source + s.left
            elif s.want_b:
                s.index @= s.source + s.right
            s.mem_req.val @= (
                (s.state == MERGE) & (s.want_a | s.want_b | s.writes) & (~s.pending | (s.mem_resp.val & ~s.reads))
            )
            s.mem_req.msg @= MemReq(0, zext(concat(s.index, Bits2(0)), 32), 0)
            if s.writes:
                s.mem_req.msg @= MemReq(15, zext(concat(s.index, Bits2(0)), 32), s.a if s.takes_a else s.b)

        @update_ff
        def up_state():
            if s.reset:
                s.state <<= IDLE
                s.length <<= 0
                s.source <<= 0
                s.target <<= 0
                s.moved <<= 0
                s.width <<= 0
            elif s.state == IDLE:
                if s.req.val:
                    s.state <<= RUNS
                s.length <<= s.req.msg.length
                s.source <<= s.req.msg.address
                s.target <<= s.req.msg.address + s.req.msg.length
                s.moved <<= 0
                s.width <<= 1
            elif s.state == RUNS:
                if (s.out == 0) & (s.width >= zext(s.length, 14)) & ~s.moved:
                    s.state <<= DONE
                elif s.out == s.length:
                    s.source <<= s.target
                    s.target <<= s.source
                    s.moved <<= ~s.moved
                    s.width <<= s.width << 1
                else:
                    s.state <<= MERGE
            elif s.state == MERGE:
                if ~s.want_a & ~s.want_b & ~s.writes & ~s.pending:
                    s.state <<= RUNS
            elif s.resp.rdy:
                s.state <<= IDLE

        @update_ff
        def up_indices():
            if s.reset | (s.state == IDLE):
                s.out <<= 0
                s.left <<= 0
                s.left_end <<= 0
                s.right <<= 0
                s.right_end <<= 0
            elif s.state == RUNS:
                s.left <<= s.out
                s.left_end <<= s.half[0:12] if s.half < zext(s.length, 14) else s.length
                s.right <<= s.half[0:12] if s.half < zext(s.length, 14) else s.length
                s.right_end <<= s.whole[0:12] if s.whole < zext(s.length, 14) else s.length
                if s.out == s.length:
                    s.out <<= 0
            elif s.go:
                if s.want_a:
                    s.left <<= s.left + 1
                elif s.want_b:
                    s.right <<= s.right + 1
                else:
                    s.out <<= s.out + 1

        @update_ff
        def up_heads():
            if s.reset:
                s.a <<= 0
                s.b <<= 0
                s.a_val <<= 0
                s.b_val <<= 0
                s.pending <<= 0
                s.reads <<= 0
                s.reads_b <<= 0
            else:
                s.pending <<= s.go | (s.pending & ~s.mem_resp.val)
                if s.go:
                    s.reads <<= ~s.writes
                    s.reads_b <<= ~s.want_a
                    if s.writes & s.takes_a:
                        s.a_val <<= 0
                    elif s.writes:
                        s.b_val <<= 0
                if s.pending & s.mem_resp.val & s.reads:
                    if s.reads_b:
                        s.b <<= s.mem_resp.msg
                        s.b_val <<= 1
                    else:
                        s.a <<= s.mem_resp.msg
                        s.a_val <<= 1

    def line_trace(s):
        return f"{s.state} {s.out} {s.mem_req}"

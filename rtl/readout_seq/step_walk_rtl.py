"""The steps of one row: types, groups and sub-samples, ascending; what is masked costs no cycle."""

from pymtl3 import Bits4, Component, InPort, OutPort, Wire, mk_bits, update, update_ff, zext


class StepWalk(Component):
    """Loaded with a row's columns it stands at its first step; ``advance`` moves it on; ``last`` is its last.

    columns: bit k = in-tile column k is read. subs: sub-samples of a pixel, less one.
    """

    def construct(s, lanes, last_tile, last_cols):
        """lanes: a power of two. last_tile: index of the last tile column. last_cols: columns in it, 1..6."""
        shift = lanes.bit_length() - 1

        # Interface
        s.load = InPort()
        s.advance = InPort()
        s.columns = InPort(6)
        s.subs = InPort(2)
        s.col0 = InPort(8)
        s.col1 = InPort(8)
        s.decimation = InPort(2)
        s.k = OutPort(3)
        s.group = OutPort(8)
        s.sub = OutPort(2)
        s.en = OutPort(lanes)
        s.last = OutPort()

        # Components
        s.left = Wire(6)            # columns still to come, this one not counted
        s.stride = Wire(4)
        s.group_step = Wire(9)
        s.far = Wire(9)
        s.sub_ends, s.group_ends = Wire(), Wire()
        s.pending, s.rest = Wire(6), Wire(6)
        s.next_k = Wire(3)

        # Logic
        @update
        def up_stride():
            s.stride @= Bits4(1) << zext(s.decimation, 4)
            s.group_step @= zext(s.stride, 9) >> shift
            if (zext(s.stride, 9) >> shift) == 0:
                s.group_step @= 1
            s.far @= zext(s.group, 9) + s.group_step

        @update
        def up_ends():
            s.sub_ends @= s.sub == s.subs
            s.group_ends @= s.far > zext(s.col1 >> shift, 9)
            s.last @= s.sub_ends & s.group_ends & (s.left == 0)

        @update
        def up_column():
            s.pending @= s.left
            if s.load:
                s.pending @= s.columns
            s.next_k @= 0
            for i in range(6):
                if s.pending[5 - i]:
                    s.next_k @= 5 - i
            s.rest @= s.pending & (s.pending - 1)

        @update_ff
        def up_state():
            if s.reset:
                s.k <<= 0
                s.group <<= 0
                s.sub <<= 0
                s.left <<= 0
            elif s.load:
                s.k <<= s.next_k
                s.left <<= s.rest
                s.group <<= s.col0 >> shift
                s.sub <<= 0
            elif s.advance:
                if ~s.sub_ends:
                    s.sub <<= s.sub + 1
                else:
                    s.sub <<= 0
                    if ~s.group_ends:
                        s.group <<= s.far[0:8]
                    else:
                        s.group <<= s.col0 >> shift
                        s.k <<= s.next_k
                        s.left <<= s.rest

        s.tile = Wire(mk_bits(9 * lanes))
        s.off = Wire(mk_bits(9 * lanes))

        @update
        def up_enable():
            for i in range(lanes):
                s.tile[9 * i:9 * i + 9] @= (zext(s.group, 9) << shift) + i
                s.off[9 * i:9 * i + 9] @= (s.tile[9 * i:9 * i + 9] - zext(s.col0, 9)) & (zext(s.stride, 9) - 1)
                s.en[i] @= ((s.tile[9 * i:9 * i + 9] >= zext(s.col0, 9)) & (s.tile[9 * i:9 * i + 9] <= zext(s.col1, 9))
                            & (s.off[9 * i:9 * i + 9] == 0)
                            & ~((s.tile[9 * i:9 * i + 9] == last_tile) & (s.k >= last_cols)))

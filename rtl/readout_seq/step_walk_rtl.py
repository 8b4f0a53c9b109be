"""The steps of one row: columns of the tile, groups, sub-samples, ascending; no step is empty."""

from pymtl3 import Bits8, Component, InPort, OutPort, Wire, mk_bits, update, update_ff, zext

STRIDES = (1, 2, 4, 8)  # in tiles, by decimation


class StepWalk(Component):
    """The current step of a row. ``load``: the first step that reads ``columns``; ``advance``: the next one, if any.

    lanes: a power of two. last_col: index of the last tile across. cols_there: columns that exist in it.

    Stride and lanes are powers of two, so decimation enables the same lanes in every group, except that the first
    group loses those left of col0, and the last group those right of the last tile that is read.
    """

    def construct(s, lanes, last_col, cols_there):
        Lanes = mk_bits(lanes)
        shift = lanes.bit_length() - 1

        # Interface
        s.load = InPort()
        s.advance = InPort()
        s.columns = InPort(6)
        s.subs = InPort(2)  # sub-samples of a pixel less one
        s.col0 = InPort(8)
        s.col1 = InPort(8)
        s.decimation = InPort(2)
        s.k = OutPort(3)
        s.group = OutPort(8)
        s.sub = OutPort(2)
        s.en = OutPort(Lanes)
        s.last = OutPort()  # the row's last step

        # Components
        s.last_tile = Wire(8)  # last tile that is read in column k
        s.left = Wire(6)  # columns left
        s.sub_ends, s.group_ends = Wire(), Wire()
        s.regroup = Wire()  # the next step has another group
        s.turn = Wire()  # and another column
        s.pending = Wire(6)
        s.next_k = Wire(3)
        s.rest = Wire(6)
        s.bound = Wire(8)
        s.stride_mask = Wire(8)
        s.next_last_tile = Wire(8)
        s.next_group = Wire(8)

        # Logic: when
        @update
        def up_ends():
            s.sub_ends @= s.sub == s.subs
            s.group_ends @= s.group == (s.last_tile >> shift)
            s.last @= s.sub_ends & s.group_ends & (s.left == 0)
            s.regroup @= s.load | (s.advance & s.sub_ends & ~s.last)
            s.turn @= s.load | (s.advance & s.sub_ends & s.group_ends & ~s.last)

        # Logic: the next step; the conditions only save simulation time
        @update
        def up_column():
            s.pending @= 0
            s.next_k @= 5
            s.rest @= 0
            s.bound @= s.col1
            if s.turn:
                s.pending @= s.columns if s.load else s.left
                s.rest @= s.pending & (s.pending - 1)
                if s.pending[0]:
                    s.next_k @= 0
                elif s.pending[1]:
                    s.next_k @= 1
                elif s.pending[2]:
                    s.next_k @= 2
                elif s.pending[3]:
                    s.next_k @= 3
                elif s.pending[4]:
                    s.next_k @= 4
                if (s.col1 == last_col) & (s.next_k >= cols_there):
                    s.bound @= s.col1 - 1

        @update
        def up_group():
            s.stride_mask @= 0
            s.next_group @= 0
            s.next_last_tile @= 0
            if s.regroup:
                s.stride_mask @= (Bits8(1) << zext(s.decimation, 8)) - 1
                if s.turn:
                    s.next_group @= s.col0 >> shift
                    s.next_last_tile @= s.bound - ((s.bound - s.col0) & s.stride_mask)
                else:
                    s.next_group @= s.group + (s.stride_mask >> shift) + 1  # by stride / lanes, or 1
                    s.next_last_tile @= s.last_tile

        if lanes == 1:
            s.en //= 1
        else:
            add_lanes(s, lanes, shift, Lanes)

        @update_ff
        def up_step():
            if s.reset:
                s.k <<= 0
                s.group <<= 0
                s.sub <<= 0
                s.last_tile <<= 0
                s.left <<= 0
            else:
                if s.load | (s.advance & s.sub_ends):
                    s.sub <<= 0
                elif s.advance:
                    s.sub <<= s.sub + 1
                if s.regroup:
                    s.group <<= s.next_group
                    s.last_tile <<= s.next_last_tile
                if s.turn:
                    s.k <<= s.next_k
                    s.left <<= s.rest

    def line_trace(s):
        return f"k{s.k} g{s.group} s{s.sub} {s.en.bin()}"


def add_lanes(s, lanes: int, shift: int, Lanes: type) -> None:
    """Give StepWalk ``s``, of two or more lanes, the register of the enabled ones."""
    ALL = Lanes((1 << lanes) - 1)
    kept = [Lanes(sum(1 << lane for lane in range(0, lanes, n))) for n in STRIDES]
    kept_1, kept_2, kept_3 = kept[1:]
    few = min(3, shift)  # bits of a tile's index in its group that decimation uses

    s.offset = Wire(few)
    s.kept = Wire(Lanes)  # by decimation, with the first lane kept
    s.next_en = Wire(Lanes)

    @update
    def up_enable():
        s.kept @= 0
        s.offset @= 0
        s.next_en @= 0
        if s.regroup:
            s.kept @= ALL
            if s.decimation == 1:
                s.kept @= kept_1
            elif s.decimation == 2:
                s.kept @= kept_2
            elif s.decimation == 3:
                s.kept @= kept_3
            s.offset @= s.col0[0:few] & s.stride_mask[0:few]
            s.next_en @= s.kept << zext(s.offset, Lanes)
            if s.next_group == (s.col0 >> shift):
                s.next_en @= s.next_en & (ALL << zext(s.col0[0:shift], Lanes))
            if s.next_group == (s.next_last_tile >> shift):
                s.next_en @= s.next_en & (ALL >> zext(~s.next_last_tile[0:shift], Lanes))

    @update_ff
    def up_lanes():
        if s.reset:
            s.en <<= 0
        elif s.regroup:
            s.en <<= s.next_en

"""Which row comes next: combinational, so that masked rows cost no cycle."""

from pymtl3 import Bits2, Component, InPort, OutPort, Wire, update, zext


class RowWalk(Component):
    """From row (tile, r) of the array to the next one that is read.

    wanted: bit r = the mask reads something in row r of a tile. first: look from r on in ``tile``, r included,
    and do not leave the tile. valid: there is such a row.
    """

    def construct(s, last_tile, last_rows):
        """last_tile: index of the last tile row. last_rows: rows that exist in it, 1..4."""
        # Interface
        s.tile = InPort(8)
        s.r = InPort(2)
        s.first = InPort()
        s.row1 = InPort(8)
        s.stride = InPort(4)
        s.wanted = InPort(4)
        s.next_tile = OutPort(8)
        s.next_r = OutPort(2)
        s.valid = OutPort()

        # Components
        s.here, s.there = Wire(4), Wire(4)      # rows to read in this tile from r on, and in the next tile
        s.far = Wire(9)
        partial = (1 << last_rows) - 1

        # Logic
        @update
        def up_here():
            s.here @= s.wanted
            if s.tile == last_tile:
                s.here @= s.wanted & partial
            for i in range(4):
                if (Bits2(i) < s.r) | ((Bits2(i) == s.r) & ~s.first):
                    s.here[i] @= 0

        @update
        def up_there():
            s.far @= zext(s.tile, 9) + zext(s.stride, 9)
            s.there @= 0
            if ~s.first & (s.far <= zext(s.row1, 9)):
                s.there @= s.wanted
                if s.far == last_tile:
                    s.there @= s.wanted & partial

        @update
        def up_next():
            s.valid @= (s.here != 0) | (s.there != 0)
            s.next_tile @= s.tile
            s.next_r @= 0
            if s.here != 0:
                for i in range(4):
                    if s.here[3 - i]:
                        s.next_r @= 3 - i
            else:
                s.next_tile @= s.far[0:8]
                for i in range(4):
                    if s.there[3 - i]:
                        s.next_r @= 3 - i

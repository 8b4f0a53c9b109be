"""The rows of a frame, ascending: the next one is found in one cycle, however many are masked in between."""

from pymtl3 import Bits4, Bits9, Component, InPort, OutPort, Wire, update, update_ff, zext


class RowWalk(Component):
    """The current ``row``. ``look``: find the next row, ``found`` if there is one; ``move``: go to it.

    tile_rows: rows of a tile. last_tile: index of the last tile. rows_there: rows that exist in it.
    """

    def construct(s, tile_rows, last_tile, rows_there):
        PARTIAL = Bits4((1 << rows_there) - 1)
        BELOW = Bits4(0xE)

        # Interface
        s.columns = InPort(24)  # columns read of each row of a tile, six bits a row
        s.row0 = InPort(8)
        s.row1 = InPort(8)
        s.decimation = InPort(2)
        s.first = InPort()  # next is the first row of the window
        s.look = InPort()
        s.move = InPort()
        s.found = OutPort()
        s.row = OutPort(10)
        s.row_columns = OutPort(6)  # columns read of `row`

        # Components
        s.tile = Wire(8)
        s.in_tile = Wire(2)  # row = tile_rows * tile + in_tile
        s.wanted = Wire(4)  # rows of a tile with a column to read
        s.far = Wire(9)  # the next tile
        s.below = Wire(4)  # rows to read in this tile, below `row`
        s.beyond = Wire(4)  # and in the next tile
        s.choice = Wire(4)
        s.next_tile = Wire(8)
        s.next_in_tile = Wire(2)
        s.next_row = Wire(10)

        # Logic
        @update
        def up_candidates():
            s.wanted @= 0
            s.far @= 0
            s.below @= 0
            s.beyond @= 0
            if s.look:  # the conditions on `look` only spare simulators the work
                for i in range(4):
                    s.wanted[i] @= s.columns[6 * i : 6 * i + 6] != 0
                if s.first:
                    s.far @= zext(s.row0, 9)
                else:
                    s.far @= zext(s.tile, 9) + (Bits9(1) << zext(s.decimation, 9))
                    s.below @= s.wanted & (BELOW << zext(s.in_tile, 4))
                    if s.tile == last_tile:
                        s.below @= s.below & PARTIAL
                if s.far <= zext(s.row1, 9):
                    s.beyond @= s.wanted
                    if s.far == last_tile:
                        s.beyond @= s.wanted & PARTIAL

        @update
        def up_next():
            s.choice @= 0
            s.next_tile @= 0
            s.next_in_tile @= 3
            s.next_row @= 0
            if s.look:
                s.choice @= s.beyond
                s.next_tile @= s.far[0:8]
                if s.below != 0:
                    s.choice @= s.below
                    s.next_tile @= s.tile
                if s.choice[0]:
                    s.next_in_tile @= 0
                elif s.choice[1]:
                    s.next_in_tile @= 1
                elif s.choice[2]:
                    s.next_in_tile @= 2
                s.next_row @= zext(s.next_tile, 10) * tile_rows + zext(s.next_in_tile, 10)
            s.found @= s.choice != 0

        @update_ff
        def up_row():
            if s.reset:
                s.tile <<= 0
                s.in_tile <<= 0
                s.row <<= 0
            elif s.move:
                s.tile <<= s.next_tile
                s.in_tile <<= s.next_in_tile
                s.row <<= s.next_row

        @update
        def up_row_columns():
            s.row_columns @= s.columns[0:6]
            if s.in_tile == 1:
                s.row_columns @= s.columns[6:12]
            elif s.in_tile == 2:
                s.row_columns @= s.columns[12:18]
            elif s.in_tile == 3:
                s.row_columns @= s.columns[18:24]

    def line_trace(s):
        return f"{int(s.row):4d}"

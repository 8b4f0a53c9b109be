"""The trim of the pixels at the pins: position in the tile -> pixel type -> register."""

from pymtl3 import Bits3, Bits5, Bits10, Component, InPort, OutPort, Wire, clog2, mk_bits, trunc, update, zext

from talbot.rtl.sizes import check_tile


class Balance(Component):
    """The trim of a pixel. order: pixel type of each position, row by row; tile_rows, tile_cols: 1..4, 1..6.
    trim_bits, trim_stride: width of a trim register, and the distance from one to the next in ``trims``.

    trims: 24 registers, pixel type 0 in the lowest bits. balance: the one of the pixel at (row, k).
    """

    def construct(s, order, tile_rows, tile_cols, trim_bits, trim_stride):
        check_tile(order, tile_rows, tile_cols)
        n = max(len(order), 4)  # so that an index of the table is as wide as a position
        Kinds, Trims = mk_bits(5 * n), mk_bits(24 * trim_stride)
        KindSelect, TrimSelect = mk_bits(clog2(5 * n + 1)), mk_bits(clog2(24 * trim_stride + 1))
        ROWS, COLS, STRIDE = Bits10(tile_rows), Bits5(tile_cols), TrimSelect(trim_stride)
        KIND_BITS = KindSelect(5)

        s.row = InPort(Bits10)
        s.k = InPort(Bits3)
        s.trims = InPort(Trims)
        s.balance = OutPort(trim_bits)

        s.position = Wire(Bits5)
        s.kinds = Wire(Kinds)
        s.kind_select = Wire(KindSelect)
        s.kind = Wire(Bits5)
        s.trim_select = Wire(TrimSelect)

        s.kinds //= Kinds(sum(kind << 5 * position for position, kind in enumerate(order)))

        @update
        def up_balance():
            s.position @= trunc(s.row % ROWS, 5) * COLS + zext(s.k, 5)
            s.kind_select @= zext(s.position, KindSelect) * KIND_BITS
            s.kind @= s.kinds[s.kind_select : s.kind_select + 5]
            s.trim_select @= zext(s.kind, TrimSelect) * STRIDE
            s.balance @= s.trims[s.trim_select : s.trim_select + trim_bits]

    def line_trace(s):
        return f"{s.kind}:{s.balance}"

"""HeaderBytes at RTL: the header's fields, byte by byte (docs/stream.md, Header)."""

from pymtl3 import Bits1, Bits5, Bits8, Bits32, Component, InPort, OutPort, Wire, concat, update, zext

from talbot.models.parameters.stream_format import MAGIC, VERSION
from talbot.rtl.run_length.ports import TERNARY, declare_header_ports


class HeaderBytes(Component):
    """The byte of the header at an index. rows, cols, lanes, tile_rows, tile_cols: of the chip."""

    def construct(s, rows, cols, lanes, tile_rows, tile_cols):
        # Interface
        s.index = InPort(Bits5)
        declare_header_ports(s)
        s.octet = OutPort(Bits8)

        # Components: the constants, as wires
        s.magic = Wire(Bits32)
        s.size = Wire(Bits32)
        s.tile = Wire(Bits8)
        s.lanes = Wire(Bits8)

        # Connections
        s.magic //= int.from_bytes(MAGIC, "big")
        s.size //= rows << 16 | cols
        s.tile //= tile_rows << 4 | tile_cols
        s.lanes //= lanes

        # Logic
        @update
        def select():
            if s.index == 0:
                s.octet @= s.magic[24:32]
            elif s.index == 1:
                s.octet @= s.magic[16:24]
            elif s.index == 2:
                s.octet @= s.magic[8:16]
            elif s.index == 3:
                s.octet @= s.magic[0:8]
            elif s.index == 4:
                s.octet @= VERSION
            elif s.index == 5:
                s.octet @= concat(s.resync, s.decimation, s.mode == TERNARY, s.phase, s.mode[0:2])
            elif s.index == 6:
                s.octet @= concat(Bits1(0), s.threshold)
            elif s.index == 7:
                s.octet @= s.lanes
            elif s.index == 8:
                s.octet @= s.tile
            elif s.index == 9:
                s.octet @= s.size[24:32]
            elif s.index == 10:
                s.octet @= s.size[16:24]
            elif s.index == 11:
                s.octet @= s.size[8:16]
            elif s.index == 12:
                s.octet @= s.size[0:8]
            elif s.index == 13:
                s.octet @= s.row0
            elif s.index == 14:
                s.octet @= s.row1
            elif s.index == 15:
                s.octet @= s.col0
            elif s.index == 16:
                s.octet @= s.col1
            elif s.index == 17:
                s.octet @= s.mask[16:24]
            elif s.index == 18:
                s.octet @= s.mask[8:16]
            elif s.index == 19:
                s.octet @= s.mask[0:8]
            elif s.index == 20:
                s.octet @= s.frame_number[8:16]
            elif s.index == 21:
                s.octet @= s.frame_number[0:8]
            elif s.index == 22:
                s.octet @= zext(s.exposure[8:10], 8)
            elif s.index == 23:
                s.octet @= s.exposure[0:8]
            elif s.index == 24:
                s.octet @= s.n_cm
            elif s.index == 25:
                s.octet @= s.t_int[8:16]
            elif s.index == 26:
                s.octet @= s.t_int[0:8]
            else:
                s.octet @= s.calibration

    def line_trace(s):
        return f"{s.index}:{s.octet}"

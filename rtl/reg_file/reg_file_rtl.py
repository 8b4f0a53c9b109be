"""The register file: bytes over SPI to configuration, start strobe and status (models/parameters/registers)."""

from pymtl3 import (
    Bits1,
    Bits3,
    Bits6,
    Bits7,
    Bits8,
    Bits10,
    Bits64,
    Component,
    InPort,
    OutPort,
    Wire,
    concat,
    connect,
    mk_bits,
    update,
    update_ff,
)
from pymtl3.stdlib.stream.ifcs import SendIfcRTL

from talbot.models.parameters.registers import array_resets, register_map
from talbot.rtl.reg_file.config import chip_config, chip_state, chip_status
from talbot.rtl.reg_file.spi_slave_rtl import SpiSlave
from talbot.rtl.sizes import check_size

TOP = 0x60  # from here on, bytes are read from one table: the state and the identity


def packed(image: dict[int, int], first: int, last: int) -> int:
    """Bytes ``first``..``last`` of a dict address -> byte as one integer, little-endian."""
    return sum(image.get(a, 0) << 8 * (a - first) for a in range(first, last + 1))


class RegFile(Component):
    """The register file behind SPI (README.md). The parameters are in the identity, and the window resets to them."""

    def construct(s, rows, cols, lanes, tile_rows=4, tile_cols=6, divider="radix4"):
        check_size("RegFile", rows=rows, cols=cols, lanes=lanes, divider=divider)
        check_size(tile_rows=tile_rows, tile_cols=tile_cols)
        chip = register_map()
        own = array_resets(rows, cols, lanes, tile_rows, tile_cols, divider)
        resets = chip.image(chip.configuration, own)
        first, last = min(resets), max(resets)
        n_bytes = last - first + 1
        Image = mk_bits(8 * n_bytes)
        RESET = Image(packed(resets, first, last))
        WRITABLE = Image(packed(chip.writable(), first, last))
        FIRST, LAST = Bits7(first), Bits7(last)
        ID, VERSION = Bits8(chip["id"].reset), Bits8(chip["version"].reset)
        A_ID, A_VERSION = Bits7(chip["id"].byte), Bits7(chip["version"].byte)
        A_STATE = Bits7(chip.state[0].address)  # from here on, the state and the identity
        CONSTANTS = packed(chip.image(chip.identity, own), TOP, 127)
        A_CONTROL, A_STATUS, A_LOOP = (Bits7(chip[n].byte) for n in ("start", "busy", "loop_back"))
        A_CYCLES, A_MADE, A_LEFT_OUT = (Bits7(f.byte) for f in chip.counters)
        LAST_COUNTER = Bits7(chip.counters[-1].byte + 7)
        START_BIT, ABORT_BIT = chip["start"].shift, chip["abort"].shift
        sticky = [f for f in chip.fields if f.access == "w1c"]  # adjacent bits (a test checks it)
        low, high = sticky[0].shift, sticky[-1].shift + 1
        Sticky = mk_bits(high - low)
        KEPT_AT_START = Sticky(1 << chip["refused"].shift - low)
        BUSY = chip["busy"].shift

        s.sclk = InPort()
        s.csn = InPort()
        s.mosi = InPort()
        s.miso = OutPort()
        s.status = InPort(chip_status())
        s.state = InPort(chip_state())
        s.cycles, s.conversions_made, s.conversions_left_out = InPort(64), InPort(64), InPort(64)
        s.cfg = OutPort(chip_config())
        s.start = OutPort()
        s.abort_ = OutPort()
        s.loop = SendIfcRTL(Bits8)

        s.spi = SpiSlave()
        s.image = Wire(Image)  # the configuration's bytes, the lowest address in the lowest bits
        s.written = Wire(Image)  # ... with the byte that is written now
        s.writable = Wire(Image)
        s.snapshot = Wire(64)  # the counter whose first byte was read last
        s.sticky = Wire(Sticky)
        s.events = Wire(Sticky)  # what sets them
        s.have_command = Wire()
        s.writing = Wire()
        s.address = Wire(7)
        s.offset = Wire(7)  # of the address in the image, in bytes
        s.index = Wire(10)  # ... in bits
        s.counter_index = Wire(6)
        s.top = Wire(256)  # the bytes from TOP to 127
        s.top_index = Wire(8)
        s.write = Wire()
        s.locked = Wire()  # a frame runs, or a loop-back byte waits for the link
        s.starting = Wire()
        s.aborting = Wire()
        s.in_image = Wire()
        s.configuring = Wire()
        s.looping = Wire()
        s.refused = Wire()

        s.spi.sclk //= s.sclk
        s.spi.csn //= s.csn
        s.spi.mosi //= s.mosi
        s.miso //= s.spi.miso
        s.writable //= WRITABLE
        for f in chip.configuration:
            if f.name != "trim":
                bit = 8 * (f.address - first) + f.lsb
                connect(getattr(s.cfg, f.name), s.image[bit : bit + f.width])
        trims, past = chip.trims[0].address, chip.trims[-1].address + chip.trims[-1].size
        connect(s.cfg.trims, s.image[8 * (trims - first) : 8 * (past - first)])
        place = 0
        for f in chip.state:
            bit = 8 * (f.address - TOP) + f.lsb
            if bit > place:
                connect(s.top[place:bit], mk_bits(bit - place)(0))
            connect(s.top[bit : bit + f.width], getattr(s.state, f.name))
            place = bit + f.width
        connect(s.top[place:256], mk_bits(256 - place)(CONSTANTS >> place))
        events = {"refused": s.refused, "aborted": s.aborting}
        for f in sticky:
            connect(s.events[f.shift - low], events[f.name] if f.name in events else getattr(s.status, f.name))

        @update
        def up_decode():
            s.offset @= s.address - FIRST
            s.index @= concat(s.offset, Bits3(0))
            s.counter_index @= concat(s.address[0:3], Bits3(0))
            s.top_index @= concat(s.address[0:5], Bits3(0))
            s.in_image @= (s.address >= FIRST) & (s.address <= LAST)
            s.write @= s.spi.rx_val & s.have_command & s.writing
            s.locked @= s.status.busy | s.loop.val
            s.starting @= Bits1(0)
            s.aborting @= Bits1(0)
            s.configuring @= Bits1(0)
            s.looping @= Bits1(0)
            s.refused @= Bits1(0)
            if s.write:
                if s.address == A_CONTROL:
                    s.aborting @= s.spi.rx[ABORT_BIT]
                    s.starting @= s.spi.rx[START_BIT] & ~(s.spi.rx[ABORT_BIT] | s.locked | s.cfg.loop_enable)
                    s.refused @= s.spi.rx[START_BIT] & (s.spi.rx[ABORT_BIT] | s.locked | s.cfg.loop_enable)
                elif s.address == A_LOOP:
                    s.looping @= s.cfg.loop_enable & ~s.loop.val
                    s.refused @= ~s.cfg.loop_enable | s.loop.val
                elif s.in_image:
                    s.configuring @= ~s.locked
                    s.refused @= s.locked

        @update
        def up_read():
            s.spi.tx @= Bits8(0)
            if s.spi.tx_take & s.have_command & ~s.writing:
                if s.in_image:
                    s.spi.tx @= s.image[s.index : s.index + Bits10(8)]
                elif s.address == A_CYCLES:
                    s.spi.tx @= s.cycles[0:8]
                elif s.address == A_MADE:
                    s.spi.tx @= s.conversions_made[0:8]
                elif s.address == A_LEFT_OUT:
                    s.spi.tx @= s.conversions_left_out[0:8]
                elif (s.address > A_CYCLES) & (s.address <= LAST_COUNTER):
                    s.spi.tx @= s.snapshot[s.counter_index : s.counter_index + Bits6(8)]
                elif s.address >= A_STATE:
                    s.spi.tx @= s.top[s.top_index : s.top_index + Bits8(8)]
                elif s.address == A_STATUS:
                    s.spi.tx[BUSY] @= s.status.busy
                    s.spi.tx[low:high] @= s.sticky
                elif s.address == A_ID:
                    s.spi.tx @= ID
                elif s.address == A_VERSION:
                    s.spi.tx @= VERSION

        @update_ff
        def up_transfer():
            if s.reset | ~s.spi.selected:
                s.have_command <<= Bits1(0)
                s.writing <<= Bits1(0)
                s.address <<= Bits7(0)
            elif s.spi.rx_val:
                s.have_command <<= Bits1(1)
                if ~s.have_command:
                    s.writing <<= s.spi.rx[7]
                    s.address <<= s.spi.rx[0:7]
                elif s.address != Bits7(127):
                    s.address <<= s.address + Bits7(1)

        @update
        def up_written():
            s.written @= Image(0)  # looked at when a byte is written only
            if s.configuring:
                s.written @= s.image
                for i in range(n_bytes):
                    if s.offset == Bits7(i):
                        s.written[i * 8 : i * 8 + 8] @= s.spi.rx & s.writable[i * 8 : i * 8 + 8]

        @update_ff
        def up_image():
            if s.reset:
                s.image <<= RESET
            elif s.configuring:
                s.image <<= s.written

        @update_ff
        def up_snapshot():
            if s.reset:
                s.snapshot <<= Bits64(0)
            elif s.spi.tx_take & s.have_command & ~s.writing:
                if s.address == A_CYCLES:
                    s.snapshot <<= s.cycles
                elif s.address == A_MADE:
                    s.snapshot <<= s.conversions_made
                elif s.address == A_LEFT_OUT:
                    s.snapshot <<= s.conversions_left_out

        @update_ff
        def up_status():
            if s.reset:
                s.start <<= Bits1(0)
                s.abort_ <<= Bits1(0)
                s.sticky <<= Sticky(0)
            else:
                s.start <<= s.starting
                s.abort_ <<= s.aborting
                if s.starting:
                    s.sticky <<= s.sticky & KEPT_AT_START | s.events
                elif s.write & (s.address == A_STATUS):
                    s.sticky <<= s.sticky & ~s.spi.rx[low:high] | s.events
                elif s.events != 0:
                    s.sticky <<= s.sticky | s.events

        @update_ff
        def up_loop():
            if s.reset | s.aborting:
                s.loop.val <<= Bits1(0)
                s.loop.msg <<= Bits8(0)
            elif s.looping:
                s.loop.val <<= Bits1(1)
                s.loop.msg <<= s.spi.rx
            elif s.loop.rdy:
                s.loop.val <<= Bits1(0)

    def line_trace(s):
        return f"{s.spi.line_trace()} {s.address} {'w' if s.write else '.'}{s.spi.rx} start={s.start}"

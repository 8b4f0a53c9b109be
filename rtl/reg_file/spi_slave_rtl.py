"""SPI slave, mode 0, oversampled by the system clock: bits to bytes and back."""

from pymtl3 import Bits1, Bits3, Bits8, Component, InPort, OutPort, Wire, concat, update, update_ff

from talbot.rtl.reg_file.synchronizer_rtl import Synchronizer


class SpiSlave(Component):
    """Bits from and to the pins as bytes; MSB first.

    rx, rx_val: a received byte (one cycle). tx is captured at the falling edge that follows it, when tx_take is high.
    selected: csn is low, and has been high since reset. sclk is at most clk / 8.
    """

    def construct(s):
        s.sclk = InPort()
        s.csn = InPort()
        s.mosi = InPort()
        s.miso = OutPort()
        s.selected = OutPort()
        s.rx = OutPort(8)
        s.rx_val = OutPort()
        s.tx = InPort(8)
        s.tx_take = OutPort()

        s.sclk_sync = Synchronizer()
        s.csn_sync = Synchronizer()
        s.mosi_sync = Synchronizer()
        s.sclk_was = Wire()  # sclk of the cycle before
        s.was_free = Wire()  # csn has been high: the rest of a transfer that a reset cut is ignored
        s.rise = Wire()
        s.fall = Wire()
        s.count = Wire(3)
        s.shift_in = Wire(7)
        s.shift_out = Wire(8)

        s.sclk_sync.pin //= s.sclk
        s.csn_sync.pin //= s.csn
        s.mosi_sync.pin //= s.mosi
        s.miso //= s.shift_out[7]

        @update
        def up_edges():
            s.selected @= ~s.csn_sync.out & s.was_free
            s.rise @= Bits1(0)
            s.fall @= Bits1(0)
            s.rx_val @= Bits1(0)
            s.tx_take @= Bits1(0)
            if s.selected:  # nothing moves in most cycles of a frame, and nothing need be simulated
                s.rise @= s.sclk_sync.out & ~s.sclk_was
                s.fall @= ~s.sclk_sync.out & s.sclk_was
                s.rx_val @= s.rise & (s.count == Bits3(7))
                s.tx_take @= s.fall & (s.count == Bits3(0))
            s.rx @= concat(s.shift_in, s.mosi_sync.out)

        @update_ff
        def up_pins():
            if s.reset:
                s.sclk_was <<= Bits1(0)
                s.was_free <<= Bits1(0)
            else:
                s.sclk_was <<= s.sclk_sync.out
                s.was_free <<= s.was_free | s.csn_sync.out

        @update_ff
        def up_shift():
            if s.reset | ~s.selected:
                s.count <<= Bits3(0)
                s.shift_in <<= 0
                s.shift_out <<= Bits8(0)
            elif s.rise:
                s.count <<= s.count + Bits3(1)
                s.shift_in <<= concat(s.shift_in[0:6], s.mosi_sync.out)
            elif s.tx_take:
                s.shift_out <<= s.tx
            elif s.fall:
                s.shift_out <<= concat(s.shift_out[0:7], Bits1(0))

    def line_trace(s):
        return f"{s.csn}{s.sclk}{s.mosi}{s.miso} {s.count}"

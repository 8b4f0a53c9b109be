"""SPI slave, mode 0, oversampled by the system clock: bits to bytes and back."""

from pymtl3 import Bits1, Bits2, Bits3, Bits8, Component, InPort, OutPort, Wire, concat, update, update_ff


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

        # Two flip-flops against metastability; a third holds sclk of the cycle before.
        s.sclk_sync = Wire(3)
        s.csn_sync = Wire(2)
        s.mosi_sync = Wire(2)
        s.was_free = Wire()  # csn has been high: the rest of a transfer that a reset cut is ignored
        s.rise = Wire()
        s.fall = Wire()
        s.count = Wire(3)
        s.shift_in = Wire(7)
        s.shift_out = Wire(8)

        s.miso //= s.shift_out[7]

        @update
        def up_edges():
            s.selected @= ~s.csn_sync[1] & s.was_free
            s.rise @= Bits1(0)
            s.fall @= Bits1(0)
            s.rx_val @= Bits1(0)
            s.tx_take @= Bits1(0)
            if s.selected:  # nothing moves in most cycles of a frame, and nothing need be simulated
                s.rise @= s.sclk_sync[1] & ~s.sclk_sync[2]
                s.fall @= ~s.sclk_sync[1] & s.sclk_sync[2]
                s.rx_val @= s.rise & (s.count == Bits3(7))
                s.tx_take @= s.fall & (s.count == Bits3(0))
            s.rx @= concat(s.shift_in, s.mosi_sync[1])

        @update_ff
        def up_sync():
            if s.reset:
                s.sclk_sync <<= Bits3(0)
                s.csn_sync <<= Bits2(0)
                s.mosi_sync <<= Bits2(0)
                s.was_free <<= Bits1(0)
            else:
                s.sclk_sync <<= concat(s.sclk_sync[0:2], s.sclk)
                s.csn_sync <<= concat(s.csn_sync[0], s.csn)
                s.mosi_sync <<= concat(s.mosi_sync[0], s.mosi)
                s.was_free <<= s.was_free | s.csn_sync[1]

        @update_ff
        def up_shift():
            if s.reset | ~s.selected:
                s.count <<= Bits3(0)
                s.shift_in <<= 0
                s.shift_out <<= Bits8(0)
            elif s.rise:
                s.count <<= s.count + Bits3(1)
                s.shift_in <<= concat(s.shift_in[0:6], s.mosi_sync[1])
            elif s.tx_take:
                s.shift_out <<= s.tx
            elif s.fall:
                s.shift_out <<= concat(s.shift_out[0:7], Bits1(0))

    def line_trace(s):
        return f"{s.csn}{s.sclk}{s.mosi}{s.miso} {s.count}"

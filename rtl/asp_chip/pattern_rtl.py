"""The test pattern: a digital image instead of sample-and-hold and comparators (models/digital/pattern.py)."""

from pymtl3 import (
    Bits1,
    Bits2,
    Bits3,
    Bits6,
    Bits8,
    Component,
    InPort,
    OutPort,
    Wire,
    clog2,
    concat,
    connect,
    mk_bits,
    update,
    update_ff,
    zext,
)

from talbot.rtl.sizes import check_size


class Pattern(Component):
    """With `on`, `comparator` compares the pattern's value at the pixel that `hold` sampled; else it is `analog`.

    lanes: converters, a power of two.
    """

    def construct(s, lanes):
        check_size(lanes=lanes)
        Lanes = mk_bits(lanes)
        Codes = mk_bits(8 * max(lanes, 2))  # PyMTL cannot slice a whole signal in a loop
        MIDDLE = Bits6(0x20)
        GROUP_STEP = Bits8(5 * lanes)

        s.on = InPort()
        s.row = InPort(Bits8)  # modulo 256
        s.group = InPort(Bits8)
        s.k = InPort(Bits3)
        s.sub = InPort(Bits2)
        s.hold = InPort()
        s.dac = InPort(mk_bits(8 * lanes))
        s.analog = InPort(Lanes)
        s.comparator = OutPort(Lanes)

        s.base = Wire(Bits8)  # the ramp at the group's first lane
        s.ramp = Wire(Codes)
        s.lane_steps = Wire(Codes)  # the ramp's increase from lane to lane
        s.tile_bit = Wire(Lanes)  # bit 1 of each lane's tile column
        s.pattern = Wire(Codes)
        s.held = Wire(Codes)
        s.trials = Wire(Codes)

        s.trials[0 : 8 * lanes] //= s.dac
        if lanes == 1:
            s.trials[8:16] //= 0
        s.lane_steps //= Codes(sum((5 * lane & 0xFF) << 8 * lane for lane in range(lanes)))
        shift = clog2(lanes) if lanes > 1 else 0
        for lane in range(lanes):
            connect(s.tile_bit[lane], s.group[1 - shift] if shift < 2 else Bits1(lane >> 1 & 1))

        @update
        def up_pattern():
            s.base @= Bits8(0)
            s.ramp @= Codes(0)
            s.pattern @= Codes(0)
            if s.on & s.hold:  # nothing moves between two samples
                s.base @= (
                    s.row * Bits8(3) + s.group * GROUP_STEP + zext(s.k, 8) * Bits8(40) + zext(s.sub, 8) * Bits8(37)
                )
                for lane in range(lanes):
                    s.ramp[lane * 8 : lane * 8 + 8] @= s.base + s.lane_steps[lane * 8 : lane * 8 + 8]
                    if s.row[2] ^ s.tile_bit[lane]:
                        s.pattern[lane * 8 : lane * 8 + 8] @= concat(MIDDLE, s.ramp[lane * 8 : lane * 8 + 2])
                    else:
                        s.pattern[lane * 8 : lane * 8 + 8] @= s.ramp[lane * 8 : lane * 8 + 8]

        @update_ff
        def up_held():
            if s.reset:
                s.held <<= Codes(0)
            elif s.on & s.hold:
                s.held <<= s.pattern

        @update
        def up_compare():
            s.comparator @= s.analog
            if s.on:
                for lane in range(lanes):
                    s.comparator[lane] @= s.held[lane * 8 : lane * 8 + 8] >= s.trials[lane * 8 : lane * 8 + 8]

    def line_trace(s):
        return f"{s.held if s.on else s.analog}"

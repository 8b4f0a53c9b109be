"""The register file at functional level: models.digital.registers at the pins."""

from pymtl3 import Bits8, Component, InPort, OutPort, update_ff
from pymtl3.stdlib.stream.ifcs import SendIfcRTL

from talbot.models.digital.registers import ADDRESS_MAX, RegisterBank
from talbot.models.parameters.registers import array_resets, register_map
from talbot.rtl.reg_file.config import chip_config, chip_state, chip_status


class RegFileFL(Component):
    """Functional level of RegFile: the same bytes some cycles earlier, since the pins have no synchronizers."""

    def construct(s, rows, cols, lanes, tile_rows=4, tile_cols=6, divider="radix4"):
        Config = chip_config()
        s.sclk = InPort()
        s.csn = InPort()
        s.mosi = InPort()
        s.miso = OutPort()
        s.status = InPort(chip_status())
        s.state = InPort(chip_state())
        s.cycles, s.conversions_made, s.conversions_left_out = InPort(64), InPort(64), InPort(64)
        s.cfg = OutPort(Config)
        s.start, s.abort_ = OutPort(), OutPort()
        s.loop = SendIfcRTL(Bits8)

        resets = array_resets(rows, cols, lanes, tile_rows, tile_cols, divider)
        s.bank = RegisterBank(resets)
        s.was_high = s.command = None
        s.was_free = False  # csn has been high since reset
        s.bits, s.out = [], 0

        chip = register_map()
        counters = [f.name for f in chip.counters]
        names = [f.name for f in chip.configuration if f.name != "trim"]

        def configure():
            trims = sum(s.bank.value(f.key) << 8 * f.size * i for i, f in enumerate(chip.trims))
            s.configuration = Config(*(s.bank.value(name) for name in names), trims)

        configure()

        def falling():
            if s.bits or s.command is None or s.command & 0x80:
                s.out = s.out << 1 & 0xFF if s.bits else 0
            else:
                values = [int(getattr(s, name)) for name in counters]
                state = sum(int(getattr(s.state, f.name)) << f.lsb for f in chip.state)
                s.out = s.bank.read(s.command, int(s.status.busy), values, state)

        def rising():
            s.bits.append(int(s.mosi))
            if len(s.bits) == 8:
                byte, s.bits = int("".join(map(str, s.bits)), 2), []
                if s.command is None:
                    s.command = byte
                    return
                if s.command & 0x80:
                    s.bank.write(s.command & 0x7F, byte, bool(s.status.busy), bool(s.loop.val))
                    configure()
                if s.command & 0x7F != ADDRESS_MAX:
                    s.command += 1

        @update_ff
        def behave():
            high = bool(s.sclk)
            if s.reset:
                s.bank.__init__(resets)
                configure()
            s.was_free = not s.reset and (s.was_free or bool(s.csn))
            if s.csn or not s.was_free:
                s.bits, s.command, s.out = [], None, 0
            elif high and not s.was_high:
                rising()
            elif s.was_high and not high:
                falling()
            s.was_high = high
            for name in ("done", "cfg_err", "amp_err"):
                if getattr(s.status, name) and not s.reset:
                    s.bank.set(name)
            start, abort, loop = s.bank.take()
            s.start <<= start
            s.abort_ <<= abort
            if loop is not None:
                s.loop.val <<= 1
                s.loop.msg <<= loop
            elif s.reset or abort or s.loop.rdy:
                s.loop.val <<= 0
            s.cfg <<= s.configuration
            s.miso <<= s.out >> 7

    def line_trace(s):
        return f"{s.csn}{s.sclk}{s.mosi}{s.miso} start={s.start}"

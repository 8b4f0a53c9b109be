"""A driver written from docs/registers.md, without asp_chip.rdl: addresses, bits and reset values as a person reads."""

import zlib

import pytest

from talbot.rtl.harness.testbench import build
from talbot.rtl.reg_file import RegFile, RegFileFL
from talbot.rtl.reg_file.test.spi_host import SpiHost

WRITE = 0x80
CONTROL, STATUS, OPTIONS, LOOP_BACK = 0x02, 0x03, 0x04, 0x7F
FIRST, LAST = 0x04, 0x51  # of the configuration
# Field -> address of its lowest byte, lowest bit there, bits, value after reset
CONFIGURATION = {
    "overlap": (0x04, 0, 1, 1),
    "phase": (0x04, 1, 1, 0),
    "test_pattern": (0x04, 2, 1, 0),
    "loop_enable": (0x04, 3, 1, 0),
    "resync": (0x04, 4, 2, 2),
    "mode": (0x05, 0, 3, 0),
    "decimation": (0x05, 4, 2, 0),
    "threshold": (0x06, 0, 7, 10),
    "noise_floor": (0x07, 0, 8, 0),
    "mask": (0x08, 0, 24, 0xFFFFFF),
    "row0": (0x0C, 0, 8, 0),
    "row1": (0x0D, 0, 8, 2),  # 11 rows in tiles of 4: the last one is 2
    "col0": (0x0E, 0, 8, 0),
    "col1": (0x0F, 0, 8, 2),  # 13 columns in tiles of 5
    "frame_number": (0x10, 0, 16, 0),
    "n_cm": (0x12, 0, 8, 0),
    "calibration": (0x13, 0, 8, 0),
    "t_reset": (0x14, 0, 16, 32),
    "t_int": (0x16, 0, 16, 512),
    "t_cm": (0x18, 0, 16, 16),
    "t_settle": (0x1A, 0, 16, 16),
    "t_read": (0x1C, 0, 16, 16),
    "t_guard": (0x1E, 0, 16, 2),
    **{f"trim {t}": (0x20 + 2 * t, 0, 10, 0) for t in range(24)},
    "exposure": (0x50, 0, 10, 0),
}
ARRAY = 11, 13, 2, 4, 5, "cordic"  # rows, columns, lanes, tile, divider
CONSTANTS = {0x00: 0x54, 0x01: 6, 0x75: 2, 0x76: 11, 0x78: 13, 0x7A: 4, 0x7B: 5, 0x7C: 3}
STATE = {  # field -> (lowest bit, bits) of the 32 at 0x70
    "amp_state": (0, 3),
    "seq_state": (4, 3),
    "encoder_state": (8, 3),
    "hold_taken": (16, 1),
    "converting": (17, 1),
    "step_waits": (18, 1),
    "scan_waits": (19, 1),
    "link_waits": (20, 1),
    "loop_waits": (21, 1),
}
COUNTERS = {"cycles": 0x58, "conversions_made": 0x60, "conversions_left_out": 0x68}


class Driver:
    """What a host does on the pins: bytes from an address on, written or read."""

    def __init__(self, sim):
        self.sim, self.starts, self.aborts, self.loop = sim, 0, 0, []
        sim.loop.rdy @= 1
        sim.status @= type(sim.status)()
        sim.state @= type(sim.state)()
        sim.reset @= 1
        sim.sim_tick()
        sim.reset @= 0
        self.spi = SpiHost(sim, self.tick)

    def tick(self):
        if self.sim.loop.val:
            self.loop.append(int(self.sim.loop.msg))
        self.sim.sim_tick()
        self.starts += int(self.sim.start)
        self.aborts += int(self.sim.abort_)

    def write(self, address, *data):
        self.spi.transfer(bytes((WRITE | address, *data)))

    def read(self, address, count=1):
        return self.spi.transfer(bytes((address, *bytes(count))))[1:]

    def field(self, name):
        """Value of a field at the ports of the other blocks."""
        if name.startswith("trim "):
            return int(self.sim.cfg.trims) >> 16 * int(name.split()[1]) & 0x3FF
        return int(getattr(self.sim.cfg, name))


def image(values):
    """The bytes FIRST..LAST of ``values``, by field."""
    total = 0
    for name, (address, lowest, _, _) in CONFIGURATION.items():
        total |= values[name] << 8 * (address - FIRST) + lowest
    return total.to_bytes(LAST - FIRST + 1, "little")


def any_values(seed):
    """A value for each field that tells it from the others."""
    return {name: zlib.crc32(name.encode(), seed) & (1 << bits) - 1 for name, (*_, bits, _) in CONFIGURATION.items()}


class TestFL:
    component, verilog, sim = RegFileFL, False, None

    def driver(self):
        cls = type(self)
        if cls.__dict__.get("sim") is None:
            cls.sim = build(self.component(*ARRAY), self.verilog, "RegFile")
        return Driver(cls.sim)

    def test_values_after_reset(self):
        driver = self.driver()
        resets = {name: reset for name, (*_, reset) in CONFIGURATION.items()}
        assert {name: driver.field(name) for name in CONFIGURATION} == resets
        expected = bytearray(128)
        expected[FIRST : LAST + 1] = image(resets)
        for address, value in CONSTANTS.items():
            expected[address] = value
        assert driver.read(0, 128) == expected

    @pytest.mark.parametrize("seed", [1, 2, 3])
    def test_every_field_is_where_the_document_has_it(self, seed):
        driver, values = self.driver(), any_values(seed) | {"loop_enable": seed & 1}
        driver.write(FIRST, *image(values))
        assert {name: driver.field(name) for name in CONFIGURATION} == values
        assert driver.read(FIRST, LAST - FIRST + 1) == image(values)

    def test_control_and_loop_back(self):
        driver = self.driver()
        driver.write(CONTROL, 0b01)
        assert (driver.starts, driver.aborts) == (1, 0)
        driver.write(CONTROL, 0b10)
        assert (driver.starts, driver.aborts) == (1, 1)
        driver.write(OPTIONS, 0b1000)
        driver.write(LOOP_BACK, 0x5A, 0xC3)
        assert driver.loop == [0x5A, 0xC3]

    def test_status(self):
        driver = self.driver()
        bits = {"busy": 0x01, "done": 0x02, "cfg_err": 0x04, "amp_err": 0x08}
        for name, bit in bits.items():
            driver.sim.status @= type(driver.sim.status)(**{name: 1})
            driver.tick()
            assert driver.read(STATUS) == bytes([bit])
            driver.sim.status @= type(driver.sim.status)()
            driver.tick()
            assert driver.read(STATUS) == bytes([bit if name != "busy" else 0])
            driver.write(STATUS, bit)
            assert driver.read(STATUS) == b"\0"
        driver.write(LOOP_BACK, 1)  # without loop_enable
        assert driver.read(STATUS) == b"\x10"
        driver.write(STATUS, 0x10)
        driver.write(CONTROL, 0b10)
        assert driver.read(STATUS) == b"\x20"

    def test_state_and_counters(self):
        driver = self.driver()
        state = {name: 1 if bits == 1 else place + 3 for place, (name, (_, bits)) in enumerate(STATE.items())}
        for names in (["amp_state", "seq_state", "encoder_state"], *([name] for name in list(STATE)[3:])):
            driver.sim.state @= type(driver.sim.state)(**{name: state[name] for name in names})
            word = sum(state[name] << STATE[name][0] for name in names)
            assert driver.read(0x70, 4) == word.to_bytes(4, "little")
        for number, name in enumerate(COUNTERS):
            value = 0x0123456789ABCDEF << number & (1 << 64) - 1
            port = getattr(driver.sim, name)
            port @= value
            assert driver.read(COUNTERS[name], 8) == value.to_bytes(8, "little")
            port @= 0


class TestVerilog(TestFL):
    component, verilog = RegFile, True
